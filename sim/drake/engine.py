"""Drake: a plant of joints in a tree, with loops closed by ball constraints."""

import math
import warnings
from importlib.metadata import version
from typing import Any

import numpy as np

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of its own deprecated parts
    from pydrake.common.value import Value  # type: ignore[import-not-found]
    from pydrake.math import RigidTransform, RotationMatrix  # type: ignore[import-not-found]
    from pydrake.multibody import plant as plants  # type: ignore[import-not-found]
    from pydrake.multibody import tree as trees
    from pydrake.multibody.math import SpatialForce  # type: ignore[import-not-found]

from models.array import Array
from models.errors import EngineError
from models.mjcf.tree import Limb, LoopPin
from models.motion import State
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from sim.drake import settings as own
from sim.engine import Drive, Facts, Settings
from sim.engine.acting import Pushes
from sim.engine.settings import shipped_engine
from sim.engine.ties import refuse_driver_angle, refuse_massless, refuse_pin_friction
from sim.engine.tree_session import TreeSession

VERSION = version("drake")
TRIFLE = 1e-30
"""Mass [kg] and inertia [kg m^2] of a prescribed crank without: Drake takes no 0."""
UP = np.array([0.0, 0.0, 1.0])


class DrakeSession(TreeSession):
    """A session with one plant."""

    name = "drake"
    shift = -0.5
    earlier: Array | None = None
    """Rates before the last step."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        own.checked(settings)
        refuse_driver_angle(scene, self.name)
        refuse_pin_friction(scene, self.name)
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.plant: Any = plants.MultibodyPlant(dt_s)
        self.plant.SetUseSampledOutputPorts(False)
        self.plant.mutable_gravity_field().set_gravity_vector([*scene.gravity_m_s2, 0.0])
        self.body: dict[str, Any] = {GROUND: self.plant.world_body()}
        self.joints: list[Any] = []
        for limb in self.tree.limbs:
            self._add(limb)
        for closure in self.tree.closures:
            self._close(closure)
        self.scale = pairs.inertia_scale(scene)
        if scene.driver.slider is not None:
            self.scale /= scene.longest_m**2
        if driven_by != "free":
            self._motor()
        self.plant.Finalize()
        self.context, self.aside = (self.plant.CreateDefaultContext() for _ in range(2))
        self.order = np.array([joint.position_start() for joint in self.joints])
        self.ref = np.array([freedom.ref for freedom in self.freedoms])
        speeds = np.empty(len(self.order))
        speeds[self.order] = [freedom.rate for freedom in self.freedoms]
        self.plant.SetVelocities(self.context, speeds)
        self.given = []
        for name in self.names:
            one = plants.ExternallyAppliedSpatialForce()
            one.body_index = self.body[name].index()
            self.given.append(one)
        self.begin()

    def _add(self, limb: Limb) -> None:
        scene, name = self.scene, limb.body
        if name != scene.driver.link or self.drive != "prescribed":
            refuse_massless(scene, self.name, name, turns=self._bare(limb))
        mass, inertia = (max(each, TRIFLE) for each in pairs.mass_of(scene, name))
        x, y = pairs.centre_of(scene, name)
        about = trees.RotationalInertia(inertia, inertia, inertia)
        matter = trees.SpatialInertia.MakeFromCentralInertia(mass, [x, y, 0.0], about)
        self.body[name] = self.plant.AddRigidBody(name, matter)
        bodies = [self.body[limb.parent]]
        bodies += [
            self.plant.AddRigidBody(f"{freedom.name} frame", trees.SpatialInertia.Zero())
            for freedom in limb.freedoms[:-1]
        ]
        bodies.append(self.body[name])
        place, angle = limb.offset, limb.angle_rad
        for k, freedom in enumerate(limb.freedoms):
            arm = pairs.turned(freedom.anchor, angle)
            at = RigidTransform(
                RotationMatrix.MakeZRotation(angle), space((place[0] + arm[0], place[1] + arm[1]))
            )
            first = self._frame(bodies[k], f"{freedom.name} base", at)
            other = self._frame(
                bodies[k + 1], f"{freedom.name} own", RigidTransform(space(freedom.anchor))
            )
            if freedom.kind == "hinge":
                joint = trees.RevoluteJoint(freedom.name, first, other, UP)
            else:
                joint = trees.PrismaticJoint(freedom.name, first, other, space(freedom.axis))
            self.joints.append(self.plant.AddJoint(joint))
            place, angle = (0.0, 0.0), 0.0

    def _bare(self, limb: Limb) -> bool:
        """Return whether nothing but its own inertia holds a body up in its hinge."""
        hinge, centre = limb.freedoms[-1], pairs.centre_of(self.scene, limb.body)
        carries = any(other.parent == limb.body for other in self.tree.limbs)
        return hinge.kind == "hinge" and not carries and hinge.anchor == centre

    def _close(self, closure: LoopPin) -> None:
        """Close a loop. A constraint of the world itself ends the process (Drake 1.51.1)."""
        ends = []
        for name in closure.bodies:
            body = self.body[name]
            if name == GROUND:
                body = self.plant.AddRigidBody(
                    f"ground {self.plant.num_bodies()}", trees.SpatialInertia.Zero()
                )
                self.plant.WeldFrames(self.plant.world_frame(), body.body_frame())
            ends += [body, space(pairs.local_point(self.scene, name, closure.point))]
        self.plant.AddBallConstraint(*ends)

    def _frame(self, body: Any, name: str, at: Any) -> Any:
        return self.plant.AddFrame(trees.FixedOffsetFrame(name, body.body_frame(), at))

    def _motor(self) -> None:
        joint = self.joints[self.driven]
        self.actuator = self.plant.AddJointActuator("motor", joint)
        if self.drive == "prescribed":
            self.inertia = float(self.settings["rotor_inertia"]) * self.scale
            self.actuator.set_default_rotor_inertia(self.inertia)
            self.actuator.set_default_gear_ratio(1.0)
        else:
            self.gain = float(self.settings["servo_gain"]) * self.scale * self._pace()
            joint.set_default_damping(self.gain)

    def once(self) -> None:
        if self.drive != "prescribed" and self.settings["bias_rates"] == "middle":
            self._mend_bias()
        self.context.SetDiscreteState(self.plant.EvalUniquePeriodicDiscreteUpdate(self.context))

    def _mend_bias(self) -> None:
        """Give Drake the difference of the terms with products of rates between the rates that it
        takes and those of half a step later."""
        rates = self.plant.GetVelocities(self.context)
        if self.earlier is None:
            update = self.plant.EvalUniquePeriodicDiscreteUpdate(self.context)
            later = update.value()[len(self.order) :]
            middle = 0.5 * (rates + later)
        else:
            middle = 1.5 * rates - 0.5 * self.earlier
        self.earlier = rates.copy()
        terms = []
        self.plant.SetPositions(self.aside, self.plant.GetPositions(self.context))
        for each in (rates, middle):
            self.plant.SetVelocities(self.aside, each)
            terms.append(self.plant.CalcBiasTerm(self.aside))
        port = self.plant.get_applied_generalized_force_input_port()
        port.FixValue(self.context, terms[0] - terms[1])

    def turn(self, place: float | None, speed: float) -> None:
        q, rate = self.look()
        if self.drive == "prescribed":
            now = self.sense * rate[self.driven]
            if place is not None:
                speed += (place - self.sense * q[self.driven]) / self.dt
            push = self.inertia * (speed - now) / self.dt
        else:
            push = self.gain * speed
        self.plant.get_actuation_input_port().FixValue(self.context, np.array([self.sense * push]))

    def push(self, pushes: Pushes) -> None:
        for name, one in zip(self.names, self.given, strict=True):
            fx, fy, moment = pushes.on_bodies[name]
            one.F_Bq_W = SpatialForce([0.0, 0.0, moment], [fx, fy, 0.0])
        port = self.plant.get_applied_spatial_force_input_port()
        port.FixValue(self.context, Value[list[plants.ExternallyAppliedSpatialForce]](self.given))

    def look(self) -> Array:
        state = self.plant.GetPositionsAndVelocities(self.context)
        q, v = state.reshape(2, -1)[:, self.order]
        return np.array([q + self.ref, v])

    def facts(self) -> Facts:
        matter, centre = {}, {}
        for name in self.names:
            own_matter = self.body[name].CalcSpatialInertiaInBodyFrame(self.context)
            at = own_matter.get_com()
            inertia = own_matter.Shift(at).CalcRotationalInertia().get_moments()[2]
            if own_matter.get_mass() > TRIFLE:
                held = float(inertia)
                matter[name] = own_matter.get_mass(), held if held > TRIFLE else math.inf
            centre[name] = float(at[0]), float(at[1])
        x, y, _ = self.plant.gravity_field().gravity_vector()
        return self.facts_of(VERSION, matter, centre, (float(x), float(y)), {})


def opened(*given: Any) -> DrakeSession:
    """Open a session. Raises EngineError where Drake would end the process."""
    try:
        return DrakeSession(*given)
    except SystemExit as fault:
        raise EngineError(f"{given[0].name}: Drake refuses its plant: {fault}") from fault


def space(place: Point) -> Array:
    """Return a place of the plane in space."""
    return np.array([*place, 0.0])


ENGINE = shipped_engine(own, VERSION, opened)
