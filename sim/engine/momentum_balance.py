"""Reactions and driving torque from the change of each body's momentum in a step.

An engine that steps with impulses reports few of them, if any. The bodies show all: over a step,
the momentum of each body changes by the impulses of its joints beside the known ones. All bodies
together are one linear system for each sample::

    sum of the forces of its joints on a body      = their action as a force
    sum of their moments, and the drive's torque   = their action as a moment

It is square where the joints leave the mechanism one freedom, which the drive takes. A pin of k
bodies counts as the k - 1 hinges that the engine has made of it, and a point on a line as a force
across it: a slider's block without mass is no body here. Gears are couples on their bodies, in the
ratio of their relation: the forces of teeth that an engine may have count to those of the pins. A
cam is the force along its follower's way: one beside the line of a slider counts to its moment.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from models.array import Array
from models.motion import Forces, SliderForces
from models.scene import GROUND, Point, Scene, Slider
from models.scene import joints as pairs
from models.scene.pairs import CamPair
from sim.engine.measure import across, arms, directions, moment
from sim.engine.ties import Hinge, slide_of

OnBlocks = Mapping[str, Array]
"""Actions on slider blocks without mass beside their two joints, by slider: (T, 3), a force [N] and
a torque [N m]."""
UNDETERMINED = (
    "redundant links share the load by their stiffness and fit: the momentum of rigid bodies "
    "leaves the reactions open, and determines the driving torque alone"
)


def by_name(rows: Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Return the numbers of steps as one array for each name of the last; NaN for those without."""
    names = rows[-1] if rows else ()
    return {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}


@dataclass(frozen=True)
class MomentumGain:
    """Action of joints and drive on a body: ``force`` [N] (T, 2), and ``moment`` [N m] (T,) about
    ``centre`` of its frame [m], which is at ``place`` (T, 2) while its angle is ``theta``."""

    centre: Point
    place: Array
    theta: Array
    force: Array
    moment: Array

    def arm(self, local: Point) -> Array:
        """Return the arm from ``place`` to a point of the body's frame [m], (T, 2)."""
        return arms(self.theta, pairs.less(local, self.centre))


@dataclass(frozen=True)
class JointPushes:
    """Joint forces of the mechanism: the force of each hinge on its other body (T, 2) [N], of each
    line on the sliding body, along ``across`` (T, 2), to its left (T,), the moment of each guide on
    a body that it keeps from turning (T,) [N m] about the slider's point, and the torque of the
    drive. ``spare`` is the number of them that momentum leaves open: if any, the torque alone is
    determined."""

    hinges: Mapping[Hinge, Array]
    across: Mapping[str, Array]
    normals: Mapping[str, Array]
    moments: Mapping[str, Array]
    torque: Array
    spare: int


def joint_pushes(
    scene: Scene, hinges: Sequence[Hinge], gains: Mapping[str, MomentumGain], *, driven: bool
) -> JointPushes:
    """Return the forces of the joints by the ``gains`` of the moving bodies, with these hinges of
    the pins, and the torque of the drive, 0 without one. They are NaN at samples at which the
    joints are singular."""
    slides = pairs.joints(scene).slides
    prisms = [slide.slider.name for slide in slides if isinstance(slide, pairs.Prism)]
    system = _System(gains)
    for hinge in hinges:
        system.hold(scene, hinge)
    lines = {slide.slider.name: system.carry(scene, slide) for slide in slides}
    for slide in slides:
        if isinstance(slide, pairs.Prism):
            system.couple({slide.body: 1.0, slide.slider.on: -1.0})
    for gear in scene.gears.values():
        system.couple(gear.relation)
    for cam in scene.cams.values():
        system.lift(scene, cam)
    if driven:
        system.drive(scene)
    found = system.solution()
    ends = np.cumsum(
        [2 * len(hinges), len(slides), len(prisms), len(scene.gears) + len(scene.cams)]
    )
    on_hinges, normals, moments, _, torque = np.split(found, ends, axis=1)
    return JointPushes(
        {hinge: on_hinges[:, 2 * k : 2 * k + 2] for k, hinge in enumerate(hinges)},
        lines,
        {slide.slider.name: normals[:, k] for k, slide in enumerate(slides)},
        {name: moments[:, k] for k, name in enumerate(prisms)},
        torque[:, 0] if driven else np.zeros(len(found)),
        spare=max(found.shape[1] - 3 * len(gains), 0),
    )


class _System:
    """Equations of the bodies: three rows each, and a column for each unknown."""

    def __init__(self, gains: Mapping[str, MomentumGain]) -> None:
        self._gains = gains
        self._row = {body: 3 * k for k, body in enumerate(gains)}
        self._samples = len(next(iter(gains.values())).theta)
        self._columns: list[Array] = []

    def hold(self, scene: Scene, hinge: Hinge) -> None:
        """Add a hinge: a force of any direction, on each body at its own copy of the point."""
        for axis in np.eye(2):
            column = self._column()
            for body, sense in ((hinge.other, 1.0), (hinge.first, -1.0)):
                if body != GROUND:
                    arm = self._gains[body].arm(pairs.local_point(scene, body, hinge.point))
                    self._push(column, body, arm, np.tile(sense * axis, (self._samples, 1)))

    def carry(self, scene: Scene, slide: pairs.Prism | pairs.Slot) -> Array:
        """Add a line: a force across it, the same on both bodies. Return its direction."""
        direction = across(self._along(slide.slider))
        self._push_on(scene, slide.slider, pairs.riding_body(slide), direction)
        return direction

    def couple(self, shares: Mapping[str, float]) -> None:
        """Add torques on bodies in these ratios."""
        self._column()
        self._turn(shares)

    def lift(self, scene: Scene, cam: CamPair) -> None:
        """Add a cam: a force along the way of its follower, or a moment, and the couple on the cam
        that has its power."""
        if cam.slider:
            self._push_along(scene, cam.slider)
        else:
            self.couple({cam.follower: 1.0, cam.carrier: -1.0})
        lift = cam.law_at({name: gain.theta for name, gain in self._gains.items()})
        ratio = cam.way * cam.sense * lift.first
        self._turn({cam.cam: -ratio, cam.carrier: ratio})

    def drive(self, scene: Scene) -> None:
        """Add the driver: a torque between its bodies, or a force along its slider's line."""
        driver = scene.driver
        if driver.slider is None:
            self.couple({driver.link: 1.0, driver.base: -1.0})
        else:
            self._push_along(scene, driver.slider)

    def solution(self) -> Array:
        """Solve for the unknowns (T, unknowns): NaN where the joints are singular; of least size
        where there are more unknowns than equations."""
        rows = [np.column_stack([gain.force, gain.moment]) for gain in self._gains.values()]
        right = np.concatenate(rows, axis=1)[:, :, None]
        matrix = np.stack(self._columns, axis=2)
        lost = ~np.isfinite(matrix).all(axis=(1, 2))
        matrix[lost] = 0.0
        if matrix.shape[1] != matrix.shape[2]:
            found = np.asarray((np.linalg.pinv(matrix) @ right)[:, :, 0])
        else:
            lost |= np.linalg.slogdet(matrix)[0] == 0.0
            matrix[lost] = np.eye(matrix.shape[1])
            found = np.asarray(np.linalg.solve(matrix, right)[:, :, 0])
        found[lost] = np.nan
        return found

    def _along(self, slider: Slider) -> Array:
        """Return the direction of a line, (T, 2)."""
        guide = self._gains.get(slider.on)
        theta = np.zeros(self._samples) if guide is None else guide.theta
        return directions(slider.direction_rad + theta)

    def _push_along(self, scene: Scene, slider: str) -> None:
        """Add an unknown along the line of a slider."""
        slide = slide_of(scene, slider)
        self._push_on(scene, slide.slider, pairs.riding_body(slide), self._along(slide.slider))

    def _push_on(self, scene: Scene, slider: Slider, rider: str, direction: Array) -> None:
        """Add an unknown that pushes the sliding body at its point, and the guide back."""
        own, guide, column = self._gains[rider], self._gains.get(slider.on), self._column()
        arm = own.arm(pairs.local_point(scene, rider, slider.point))
        self._push(column, rider, arm, direction)
        if guide is not None:
            self._push(column, slider.on, own.place + arm - guide.place, -direction)

    def _column(self) -> Array:
        self._columns.append(np.zeros((self._samples, 3 * len(self._row))))
        return self._columns[-1]

    def _turn(self, torques: Mapping[str, Array | float]) -> None:
        """Add torques on bodies to the last unknown."""
        for name, torque in torques.items():
            if name != GROUND:
                self._columns[-1][:, self._row[name] + 2] += torque

    def _push(self, column: Array, body: str, arm: Array, direction: Array) -> None:
        row = self._row[body]
        column[:, row : row + 2] += direction
        column[:, row + 2] += moment(arm, direction)


class PinForces(dict[str, dict[str, Array]]):
    """Forces in the pins of a scene, by pin and body, (T, 2) [N]; 0 at first."""

    def __init__(self, scene: Scene, samples: int) -> None:
        super().__init__(
            (point, {body: np.zeros((samples, 2)) for body in names})
            for point, names in pairs.joined_at(scene).items()
        )

    def add(self, point: str, giver: str, taker: str, force: Array) -> None:
        """Add the force of one body on another at their pin."""
        self[point][taker] += force
        self[point][giver] -= force


def forces_by_body(
    scene: Scene,
    pushes: JointPushes,
    on_blocks: OnBlocks,
    friction: Mapping[str, Array],
    time_s: Array,
) -> Forces:
    """Return the forces of ``pushes``, at ``time_s``; for redundant links the torque alone.

    A block without mass transfers its forces: its pin balances its guide and other actions on it,
    and its guide takes its torque.
    """
    if pushes.spare:
        return Forces(time_s, {}, {}, pushes.torque, undetermined=UNDETERMINED, friction=friction)
    samples = len(time_s)
    pins = PinForces(scene, samples)
    for hinge, force in pushes.hinges.items():
        pins.add(hinge.point, hinge.first, hinge.other, force)
    moments = dict(pushes.moments)
    for slot in pairs.joints(scene).slots:
        name, point = slot.slider.name, slot.slider.point
        own = on_blocks.get(name, np.zeros((samples, 3)))
        passed = pushes.normals[name][:, None] * pushes.across[name] + own[:, 0:2]
        pins.add(point, pairs.block_name(slot.slider), pairs.riding_body(slot), passed)
        moments[name] = -own[:, 2]
        if point in friction and point not in scene.sliders:  # whose second body is the block
            moments[name] = moments[name] - friction[point]
    sliders = {name: SliderForces(pushes.normals[name], moments[name]) for name in scene.sliders}
    return Forces(time_s, pins, sliders, pushes.torque, friction=friction)
