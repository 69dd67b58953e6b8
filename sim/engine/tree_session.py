"""Sessions of engines with joint coordinates.

An engine reports the forces of loops seldom, and those of joints with the rates of another instant:
they come from the changes of its rates. Friction is the engine's own, in joints of the tree.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.mjcf.forces import planned, rubbing_freedom
from models.mjcf.tree import Limb, Tree, driven_freedom
from models.motion import State
from models.scene import GROUND, Scene
from models.scene import joints as pairs
from models.scene.joints import FIXED, Frame
from sim.engine import BodyPose, Drive, Poses, Settings, measure, tree_poses
from sim.engine.acting import EngineBodies
from sim.engine.momentum_balance import MomentumGain
from sim.engine.stepped import SteppedSession, StepSeries
from sim.engine.ties import RubbingJoint, rubbing_joints


@dataclass(frozen=True)
class Rub(RubbingJoint):
    """Friction in a joint of the tree: the ``row`` of its coordinate, whose rate has the ``sense``
    of the second body's against the first."""

    row: int
    sense: float


def rubs(scene: Scene, limbs: Sequence[Limb], *, sliders: bool = True) -> list[Rub]:
    """Return the frictions of constant size, of pins alone without ``sliders``; their joints are in
    the tree (`models.mjcf.forces.planned`)."""
    found = []
    freedoms = [(limb, freedom) for limb in limbs for freedom in limb.freedoms]
    for one in rubbing_joints(scene, sliders=sliders):
        row, body = next(
            (row, limb.body)
            for row, (limb, freedom) in enumerate(freedoms)
            if rubbing_freedom(scene, limb, one.joint) is freedom
        )
        own = one.joint in scene.sliders or body == one.second  # a slider's own coordinate
        found.append(Rub(**vars(one), row=row, sense=1.0 if own else -1.0))
    return found


class TreeSession(SteppedSession):
    """A session of an engine whose bodies hang on one another by joint coordinates, with loops
    closed at pins (`models.mjcf.tree`). The frames of its bodies are those of the links."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, driven_by: Drive
    ) -> None:
        super().__init__(scene, state, settings, dt_s, driven_by)
        self.tree = self.grown()
        self.freedoms = [own for limb in self.tree.limbs for own in limb.freedoms]
        """The joint coordinates, in the order of the limbs and of each one's joints."""
        self.driven, self.sense = 0, 1.0
        """Row of the driven coordinate, and its sense against the driver's own."""
        if driven_by != "free":
            driven, self.sense = driven_freedom(scene, self.tree.limbs)
            self.driven = next(k for k, own in enumerate(self.freedoms) if own.name == driven)
        self.rubbing: list[Rub] = rubs(scene, self.tree.limbs, sliders=self.rubs)
        centre = dict.fromkeys((GROUND, *self.names), (0.0, 0.0))
        self.bodies = EngineBodies(scene, state, centre=centre)

    def grown(self) -> Tree:
        """Return the tree, with the rates of its coordinates at the engine's own instant."""
        return planned(self.scene, self.state, delay_s=self.shift * self.dt)

    def rate_in(self, rub: RubbingJoint, numbers: Array) -> float:
        assert isinstance(rub, Rub)
        return rub.sense * float(numbers[1, rub.row])

    def rub(self, rub: RubbingJoint, steps: StepSeries) -> None:
        if rub.joint not in self.scene.sliders:
            super().rub(rub, steps)
            return
        slider, paths = self.scene.sliders[rub.joint], self._paths(steps)
        along = measure.directions(paths[rub.first].pose.theta + slider.direction_rad)
        force = steps.rubbed[rub.joint][:, None] * along
        local = pairs.local_point(self.scene, rub.second, slider.point)
        place = measure.PointPath(paths[rub.second], local).position
        for body, sense in ((rub.first, -1.0), (rub.second, 1.0)):
            moment = measure.moment(place - paths[body].pose.origin, force)
            steps.given[body] += sense * np.column_stack([force, moment])
        if rub.joint in steps.on_blocks:
            steps.on_blocks[rub.joint][:, :2] += force

    def gains(self, steps: StepSeries) -> Mapping[str, MomentumGain]:
        paths = self._paths(steps)
        return {limb.body: self._gain(limb.body, paths, steps.given) for limb in self.tree.limbs}

    def _paths(self, steps: StepSeries) -> Mapping[str, measure.BodyPath]:
        """Return the bodies at the start of each step, where its forces act: there the rates are
        the means of those about it, and the places step with the new ones."""
        q, rate = steps.after[:, 0], steps.after[:, 1]
        push = (rate - steps.before[:, 1]) / self.dt
        start = q - self.dt * rate, rate - 0.5 * self.dt * push, push
        poses = tree_poses.body_poses(self.tree.limbs, *start)
        return measure.body_paths(Poses(np.zeros(len(q)), poses))

    def _gain(
        self, name: str, paths: Mapping[str, measure.BodyPath], given: Mapping[str, Array]
    ) -> MomentumGain:
        """Return the action of joints and drive on a body, less what it was given at its origin."""
        (mass, inertia), centre = pairs.mass_of(self.scene, name), pairs.centre_of(self.scene, name)
        pose, push = paths[name].pose, given[name]
        arm = measure.arms(pose.theta, centre)
        turning = pose.alpha[:, None] * measure.across(arm) - pose.omega[:, None] ** 2 * arm
        pull = pose.origin_acceleration + turning - np.array(self.scene.gravity_m_s2)
        moment = inertia * pose.alpha - push[:, 2] + measure.moment(arm, push[:, :2])
        force = mass * pull - push[:, :2]
        return MomentumGain(centre, pose.origin + arm, pose.theta, force, moment)

    @abstractmethod
    def look(self) -> Array:
        """Return the joint coordinates, their rates and, where known, accelerations, of `freedoms`,
        as these count them, (2, n) or (3, n)."""

    def numbers(self) -> Array:
        return self.look()

    def frames(self, ahead_s: float) -> Mapping[str, Frame]:
        q, rate, *push = self.look()
        gained = ahead_s * np.nan_to_num(push[0] if push else np.zeros_like(q))
        then = (q + ahead_s * (rate + 0.5 * gained))[None], (rate + gained)[None]
        found = tree_poses.body_poses(self.tree.limbs, *then, np.zeros((1, len(q))))
        return {GROUND: FIXED} | {name: _frame(pose) for name, pose in found.items()}

    def poses(self, rows: Array, time_s: Array) -> Poses:
        lag, known = self.shift * self.dt, rows.shape[1] > 2
        q, rate = rows[:, 0], rows[:, 1]
        push = rows[:, 2] if known else np.full_like(q, np.nan)
        found = Poses(time_s, tree_poses.body_poses(self.tree.limbs, q, rate, push, lag), lag)
        return found if known else found.changed(unpushed)


def _frame(pose: BodyPose) -> Frame:
    """Return the only sample of a pose."""
    (x, y), (u, v) = pose.origin[0].tolist(), pose.velocity[0].tolist()
    return Frame((x, y), float(pose.theta[0]), (u, v), float(pose.omega[0]))


def unpushed(pose: BodyPose) -> BodyPose:
    """Return the pose without accelerations; a body that only slides would keep its alpha of 0."""
    return replace(
        pose,
        origin_acceleration=np.full_like(pose.origin, np.nan),
        alpha=np.full_like(pose.theta, np.nan),
    )
