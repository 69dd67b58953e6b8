"""The model of a tree in OpenSim: bodies hung on one another by pins and sliders, and constraints
that close the loops, all in the plane of x and y.

A slot is two joints with a body without mass between them. A loop of sliders closes at a point, or
two, on a line. OpenSim's names take no spaces: bodies are numbered.
"""

from importlib import import_module
from typing import Any

from models.array import Array
from models.mjcf.tree import Freedom, Limb, LoopPin, Tree
from models.scene import GROUND, Point, Scene
from models.scene import joints as pairs
from models.scene.joints import Prism, Slot, turned

osim: Any = import_module("opensim")
osim.Logger.setLevelString("Off")
VERSION = str(osim.GetVersion()).partition("-")[0]


class TreeModel:
    """A model before it is opened; ``extra`` is a mass [kg] at the driver's pivot and an inertia
    [kg m^2] that it has beside its own."""

    def __init__(self, scene: Scene, tree: Tree, extra: tuple[float, float]) -> None:
        self._scene, self._extra = scene, extra
        self.model = osim.Model()
        self.model.setGravity(vector(*scene.gravity_m_s2))
        self.body: dict[str, Any] = {GROUND: self.model.getGround()}
        self.coordinates: list[Any] = []
        self.joints = [self._hang(limb) for limb in tree.limbs]
        """The joint of each limb to its parent, or to the body without mass between them."""
        self.pins = [self._close(pin) for pin in tree.closures]
        self.lines = [self._carry(slide) for slide in tree.slides]
        """The constraints of each slide that closes a loop: one, or two of a prism."""
        self.pushers: dict[str, tuple[Any, Any, Any]] = {}

    def _hang(self, limb: Limb) -> Any:
        own = self._body(limb.body)
        parent, offset, angle = self.body[limb.parent], limb.offset, limb.angle_rad
        for k, freedom in enumerate(limb.freedoms, start=1):
            last = k == len(limb.freedoms)
            child = own if last else self._add(f"{own.getName()}_held", 0.0, 0.0, (0.0, 0.0))
            joint = self._joint(freedom, parent, offset, angle, child)
            parent, offset, angle = child, (0.0, 0.0), 0.0
        return joint

    def _body(self, name: str) -> Any:
        mass, inertia = pairs.mass_of(self._scene, name)
        centre = pairs.centre_of(self._scene, name)
        if name == self._scene.driver.link and self._extra[1]:
            if self._extra[0]:
                centre = pairs.local_point(self._scene, name, self._scene.driver_pivot)
            mass, inertia = mass + self._extra[0], inertia + self._extra[1]
        self.body[name] = self._add(f"body{len(self.body)}", mass, inertia, centre)
        return self.body[name]

    def _add(self, name: str, mass: float, inertia: float, centre: Point) -> Any:
        matter = osim.Inertia(inertia, inertia, inertia, 0.0, 0.0, 0.0)
        body = osim.Body(name, mass, vector(*centre), matter)
        self.model.addBody(body)
        return body

    def _joint(self, own: Freedom, parent: Any, offset: Point, angle: float, child: Any) -> Any:
        """Join two bodies by a coordinate, the child's frame at a place and angle in the parent."""
        if own.kind == "hinge":
            kind, at, to, back = osim.PinJoint, own.anchor, turned(own.anchor, angle), 0.0
            angle -= own.ref
        else:
            kind, at, back = osim.SliderJoint, (0.0, 0.0), own.axis_rad
            angle += own.axis_rad
            to = turned((-own.ref, 0.0), angle)
        place = vector(offset[0] + to[0], offset[1] + to[1])
        name = f"joint{len(self.coordinates)}"
        turns = vector(0.0, 0.0, angle), vector(0.0, 0.0, back)
        joint = kind(name, parent, place, turns[0], child, vector(*at), turns[1])
        self.model.addJoint(joint)
        coordinate = joint.updCoordinate()
        coordinate.setName(f"q{len(self.coordinates)}")
        coordinate.setDefaultValue(own.ref)
        self.coordinates.append(coordinate)
        return joint

    def _close(self, pin: LoopPin) -> Any:
        ends: list[Any] = []
        for body in pin.bodies:
            ends += [self.body[body], vector(*pairs.local_point(self._scene, body, pin.point))]
        return self._constrain(osim.PointConstraint(*ends))

    def _carry(self, slide: Prism | Slot) -> list[Any]:
        slider, rider = slide.slider, pairs.riding_body(slide)
        line = vector(*turned((1.0, 0.0), slider.direction_rad)), vector(*slider.through_m)
        x, y = pairs.local_point(self._scene, rider, slider.point)
        places = [(x, y)]
        if isinstance(slide, Prism):
            u = turned((1.0, 0.0), slider.direction_rad - pairs.sliding_angle(slider))
            far = self._scene.longest_m
            places.append((x + far * u[0], y + far * u[1]))
        bodies = self.body[slider.on], self.body[rider]
        return [
            self._constrain(osim.PointOnLineConstraint(bodies[0], *line, bodies[1], vector(*place)))
            for place in places
        ]

    def _constrain(self, constraint: Any) -> Any:
        self.model.addConstraint(constraint)
        return constraint

    def add_pushers(self) -> None:
        """Add a force at the origin and a torque to each body, of no size yet."""
        for name, body in self.body.items():
            if name != GROUND:
                own = body.getName()
                x, y, torque = *(osim.PointActuator(own) for _ in "xy"), osim.TorqueActuator()
                for pusher, way in ((x, vector(1.0, 0.0)), (y, vector(0.0, 1.0))):
                    pusher.set_direction(way)
                    pusher.set_point(vector())
                    pusher.set_force_is_global(True)
                torque.set_bodyA(own)
                torque.set_bodyB("ground")
                torque.set_axis(vector(0.0, 0.0, 1.0))
                self.pushers[name] = x, y, torque
                for pusher in (x, y, torque):
                    self._actuate(pusher)

    def add_motor(self, row: int, gain: float, speed: Any) -> None:
        """Add a motor to a coordinate, which follows a speed over time: its torque at rest at that
        speed, and a damper."""
        name = self.coordinates[row].getName()
        damper, motor = osim.SpringGeneralizedForce(name), osim.CoordinateActuator(name)
        damper.setStiffness(0.0)
        damper.setViscosity(gain)
        self.model.addForce(damper)
        motor.setName("motor")
        motor.setOptimalForce(gain)
        self.model.addForce(motor)
        control = osim.PrescribedController()
        control.addActuator(motor)
        control.prescribeControlForActuator("motor", speed)
        self.model.addController(control)

    def _actuate(self, actuator: Any) -> None:
        actuator.setName(f"actuator{self.model.getForceSet().getSize()}")
        actuator.setOptimalForce(1.0)
        self.model.addForce(actuator)

    def prescribe(self, row: int, course: Any) -> None:
        """Prescribe a coordinate, as a function of time."""
        self.coordinates[row].setPrescribedFunction(course)
        self.coordinates[row].setDefaultIsPrescribed(True)

    def forces(self, state: Any) -> list[tuple[float, float, float]]:
        """Return the force [N] and moment [N m] of each joint on its limb, where the joint is in
        it, and then the force of each constraint on its second body."""
        found = []
        for joint in self.joints:
            wrench = joint.calcReactionOnChildExpressedInGround(state)
            moment, force = wrench.get(0), wrench.get(1)
            found.append((force.get(0), force.get(1), moment.get(2)))
        ties = [*self.pins, *(tie for ties in self.lines for tie in ties)]
        return found + [(*acting_on(tie, state), 0.0) for tie in ties]

    def opened(self) -> tuple[Any, list[int]]:
        """Return a state, and the place of each coordinate in it."""
        state = self.model.initSystem()
        for pushers in self.pushers.values():
            for pusher in pushers:
                pusher.overrideActuation(state, True)
        for k, coordinate in enumerate(self.coordinates):
            coordinate.setValue(state, float(k), False)
        return state, [state.getQ().to_numpy().tolist().index(k) for k in range(state.getNQ())]


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
    """Return a vector of OpenSim's."""
    return osim.Vec3(x, y, z)


def line(slope: float, start: float) -> Any:
    """Return a linear function of time."""
    return osim.LinearFunction(slope, start)


def spline(times: Array, values: Array) -> Any:
    """Return a spline of degree 5 through some values."""
    course = osim.GCVSpline()
    course.setDegree(5)
    for time_s, value in zip(times.tolist(), values.tolist(), strict=True):
        course.addPoint(time_s, value)
    return course


def acting_on(constraint: Any, state: Any) -> tuple[float, float]:
    """Return the force of a constraint on its second body [N], in the frame of the body that
    carries both. Simbody has constraints on the side of inertia: its forces have the other sign."""
    on_bodies, on_coordinates = osim.VectorOfSpatialVec(), osim.Vector()
    constraint.calcConstraintForces(state, on_bodies, on_coordinates)
    force = on_bodies.get(1).get(1)
    return -force.get(0), -force.get(1)


def integrator(model: Any, method: str, fixed_s: float | None, accuracy: float, shut: float) -> Any:
    """Return what steps a model: with fixed steps [s], or controlled ones."""
    manager = osim.Manager(model)
    manager.setWriteToStorage(False)
    manager.setPerformAnalyses(False)
    manager.setIntegratorMethod(getattr(osim.Manager, f"IntegratorMethod_{method}"))
    manager.setIntegratorAccuracy(accuracy)
    manager.setIntegratorConstraintTolerance(shut)
    if fixed_s is not None:
        manager.setIntegratorFixedStepSize(fixed_s)
    return manager
