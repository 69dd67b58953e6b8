"""Rotatability of links against the ground and their neighbours, and swing of the others.

Ranges are those of the mechanism's own branch, or of a whole circuit in free motion. Where the
driver turns fully, whole turns are counted with certainty (`analytic.change_points.turns`); else a
link goes to and fro with the driver, between its extremes over the branch, each followed to
rounding, or it turns as the circuit closes.

Source: R. L. Norton, Design of Machinery, sections 2.12 (rotatability) and 4.10 (limit positions,
toggle).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.lectures.circuits.arcs import Arc, SignedScene, Signs
from analytic.lectures.circuits.circuits import Circuits
from analytic.prepared import prepared
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError, StructureError
from models.scene import GROUND, Scene
from models.scene.joints import block_name, joined_at

LOOKS = 2880
ZOOMS, FINER = 8, 33
STILL_RAD = 1e-9
"""Largest swing of links that keep their angle up to rounding."""


@dataclass(frozen=True)
class Rotation:
    """Rotation of ``link`` against ``against`` over a cycle of ``period_rad`` of the driver.
    ``turns`` are the whole turns that it gains, counter-clockwise; without any it swings from
    ``low_rad`` to ``high_rad``, of which ``low_at_rad`` and ``high_at_rad`` are driver angles: its
    limit positions, on branches of the signs ``low_on`` and ``high_on`` if several are passed."""

    link: str
    against: str
    turns: int
    low_rad: float
    high_rad: float
    low_at_rad: float
    high_at_rad: float
    period_rad: float
    low_on: Signs | None = None
    high_on: Signs | None = None

    @property
    def swing_rad(self) -> float:
        return self.high_rad - self.low_rad

    @property
    def word(self) -> str:
        """Word for it: turns, swings or keeps its angle."""
        if self.turns:
            return "turns"
        return "swings" if self.swing_rad > STILL_RAD else "keeps its angle"


def neighbours(scene: Scene) -> list[tuple[str, str]]:
    """Return the pairs of links and their pinned or sliding neighbours, the ground first."""
    pairs = {(link, GROUND): None for link in scene.links}
    order = {name: k for k, name in enumerate(scene.links)}
    carried = {block_name(s): s.on for s in scene.sliders.values() if s.link is None}
    for names in joined_at(scene).values():
        bodies = [carried.get(name, name) for name in names]  # a block turns with its guide
        for k, one in enumerate(bodies):
            for other in bodies[k + 1 :]:
                if one in order and other in order and one != other:
                    first, second = sorted((one, other), key=order.__getitem__)
                    pairs[second, first] = None
    return list(pairs)


def rotations(scene: Scene, arc: Arc) -> list[Rotation]:
    """Return the rotation of every link against the ground and its neighbours, over the scene's
    branch ``arc``. Raises CrankcheckError where a link can not be followed, as its angle runs
    through infinity or a singular position."""
    follow = _Follower.of(scene, arc)
    return [follow.rotation(link, against) for link, against in neighbours(scene)]


def circuit_rotations(circuits: Circuits, arc: Arc) -> list[Rotation]:
    """Return the rotations as `rotations`, over the circuit of a branch: through the limit
    positions of the driver, as without a drive. Raises CrankcheckError."""
    signed, course = circuits.signed, circuits.loop(arc)
    if len(course) == 1:
        return rotations(signed.with_signs(arc.signs), arc)
    legs = [(signed.with_signs(each.signs), each.signs) for each, _ in course]
    theta = [each.angles(LOOKS + 1)[:: 1 if rises else -1] for each, rises in course]
    follow = _Follower.along(legs, arc, np.concatenate(theta), math.tau)
    return [follow.rotation(link, against) for link, against in neighbours(signed.scene)]


@dataclass(frozen=True)
class _Follower:
    """Angles of links at driver angles ``theta``, continuous along a branch, or along those of a
    circuit: ``legs`` with as many angles each, that are a scene, and the signs of a circuit's."""

    legs: Sequence[tuple[Scene, Signs | None]]
    arc: Arc
    theta: Array
    angles: Mapping[str, Array]
    period: float

    @property
    def scene(self) -> Scene:
        return self.legs[0][0]

    @staticmethod
    def of(scene: Scene, arc: Arc) -> _Follower:
        period = prepared(scene).period if arc.low is None else math.tau
        theta = arc.angles(LOOKS + 1)
        if arc.low is None:
            theta = np.linspace(-math.pi, period - math.pi, LOOKS * round(period / math.tau) + 1)
        return _Follower.along([(scene, None)], arc, theta, period)

    @staticmethod
    def along(
        legs: Sequence[tuple[Scene, Signs | None]], arc: Arc, theta: Array, period: float
    ) -> _Follower:
        scene, angles = legs[0][0], {GROUND: np.zeros_like(theta)}
        parts = zip(legs, np.split(theta, len(legs)), strict=True)
        plain = [plain_angles(own, some) for (own, _), some in parts]
        for name in scene.links:
            angles[name] = np.unwrap(np.concatenate([each[name] for each in plain]))
            if np.max(np.abs(np.diff(angles[name])), initial=0.0) > 0.5 * math.pi:
                raise CrankcheckError(
                    f"{scene.name}: {name} turns too fast to be followed, by more than a right "
                    "angle within an eighth of a degree of the driver: it practically passes a "
                    "singular position; change a length"
                )
        return _Follower(legs, arc, theta, angles, period)

    def rotation(self, link: str, against: str) -> Rotation:
        relative = self.angles[link] - self.angles[against]
        turns = self._turns(link, against)
        low, low_at, low_on = self._extreme(link, against, relative, -1.0)
        high, high_at, high_on = self._extreme(link, against, relative, 1.0)
        shift = math.tau * math.floor((0.5 * (low + high) + math.pi) / math.tau)
        return Rotation(
            link, against, turns, low - shift, high - shift, low_at, high_at, self.period,
            low_on, high_on,
        )  # fmt: skip

    def _turns(self, link: str, against: str) -> int:
        """Return the turns counted with certainty, or else the followed ones; links that keep an
        angle to the driver or to the ground follow these. A branch with ends has none."""
        relative = self.angles[link] - self.angles[against]
        followed = round(float(relative[-1] - relative[0]) / math.tau)
        if self.arc.low is not None:
            return followed if len(self.legs) > 1 else 0
        own = {GROUND: 0.0, **prepared(self.scene).turns.gains}
        if self.scene.driver.is_crank:
            own[self.scene.driver.link] = self.period / math.tau
        if link in own and against in own:
            return round(own[link] - own[against])
        return followed

    def _extreme(
        self, link: str, against: str, relative: Array, sense: float
    ) -> tuple[float, float, Signs | None]:
        """Return the largest (``sense`` 1) or smallest angle [rad], its driver angle, and the signs
        of a circuit's branch."""
        best, count = int(np.argmax(sense * relative)), len(self.theta) // len(self.legs)
        (scene, signs), first = self.legs[best // count], best // count * count
        value, at = float(relative[best]), float(self.theta[best])
        low = float(self.theta[max(best - 1, first)])
        high = float(self.theta[min(best + 1, first + count - 1)])
        for _ in range(ZOOMS):
            looks = np.linspace(low, high, FINER)
            plain = plain_angles(scene, looks)
            angle = plain[link] - plain.get(against, np.zeros(FINER))
            angle = angle + math.tau * np.round((value - angle) / math.tau)
            k = int(np.argmax(sense * angle))
            if sense * (float(angle[k]) - value) >= 0.0:
                value, at = float(angle[k]), float(looks[k])
            low, high = float(looks[max(k - 1, 0)]), float(looks[min(k + 1, FINER - 1)])
        return value, math.remainder(at, math.tau), signs


def plain_angles(scene: Scene, theta: Array) -> dict[str, Array]:
    """Return the angles of all links up to whole turns, by the motion with its change points."""
    chunk = prepared(scene).stretched(theta)
    found = {}
    for name in scene.links:
        body = chunk.bodies[name]
        angle = np.arctan2(body.turn.y, body.turn.x) if body.theta is None else body.theta
        found[name] = np.array(np.broadcast_to(angle, theta.shape), dtype=np.float64)
    return found


IN_LINE = 1e-5
"""Sine of an angle between links that are in line: a limit is found to a root of rounding."""


@dataclass(frozen=True)
class DeadPoint:
    """Dead point of an ``input`` link: the driver's angle [rad] and the links in line."""

    input: str
    driver_rad: float
    where: str


def dead_points(circuits: Circuits, rotations: Sequence[Rotation]) -> list[DeadPoint]:
    """Return the dead points of the driver, at the ends of the scene's branch (of all those of its
    circuit if it is free), and of the links pinned to the ground, at the ends of their swing.

    Where the driver stops, the two assemblies of a dyad meet: two links in line (RRR), a rod square
    to its slider's line (RRP), or a guide square to the line to its pin (RPR). A link pinned to the
    ground could not drive the mechanism where it turns back: the dead points of that input.
    """
    scene = circuits.signed.scene
    ends = {
        (round(end.angle_rad, 6), end.dyad): end
        for arc, _ in reversed(circuits.course)
        for end in (arc.low, arc.high)
        if end is not None
    }
    found = [
        DeadPoint(scene.driver.link, end.angle_rad, at_limit(scene, end.dyad))
        for end in sorted(ends.values(), key=lambda end: end.angle_rad)
    ]
    limits = {point.driver_rad for point in found}
    for one in rotations:
        if one.against != GROUND or one.word != "swings" or one.link == scene.driver.link:
            continue
        if scene.links[one.link].points.keys() & scene.ground.keys():
            found += [
                DeadPoint(one.link, at, _in_line(circuits.signed, at, signs))
                for at, signs in ((one.low_at_rad, one.low_on), (one.high_at_rad, one.high_on))
                if signs is not None  # not at a mere end of a branch
                or all(abs(math.remainder(at - limit, math.tau)) > IN_LINE for limit in limits)
            ]
    return found


def at_limit(scene: Scene, key: str) -> str:
    """Return the text of the links in line where two assemblies of a group meet."""
    structure = analyse(scene)
    for triad in structure.triads:
        if triad.branch_key == key:
            legs = ", ".join(leg.body for leg in triad.legs)
            return f"the lines of {legs} through one point, or parallel"
    group = next(g for g in structure.groups if g.branch_key == key)
    if group.kind == "RRR":
        return f"{group.first} and {group.second} in line"
    if group.kind == "RRP":
        return f"{group.first} square to the line of {group.outer2}"
    if group.kind == "RPR":
        return f"line of {group.inner} square to the line from its pin to the guide's"
    raise StructureError(f"{scene.name}: {group.kind} has no limit position")


def _in_line(signed: SignedScene, theta: float, signs: Signs | None) -> str:
    """Return the text of links in line at a shared pin: by lines from each to the next pin."""
    scene = signed.scene if signs is None else signed.with_signs(signs)
    chunk = prepared(scene).stretched(np.array([theta]))
    found = []
    for group in analyse(scene).groups:
        for end in (group.outer1, group.outer2):
            before = [link for link in scene.pins.get(end, ()) if link in scene.links]
            for one in before:
                for other in {group.first, group.second} & set(before) - {one}:
                    ends = (scene.driver_pivot if one == scene.driver.link else "", group.inner)
                    if not ends[0] or ends[1] not in scene.links[other].points:
                        continue
                    pin = chunk.point(one, end).p
                    first = chunk.point(one, ends[0]).p - pin
                    second = chunk.point(other, ends[1]).p - pin
                    across = first.x * second.y - first.y * second.x
                    size = np.hypot(first.x, first.y) * np.hypot(second.x, second.y)
                    if np.all(np.abs(across) < IN_LINE * size):
                        found.append(f"{one} and {other} in line")
    return ", ".join(dict.fromkeys(found)) or "no two links from the driver's pin on in line"
