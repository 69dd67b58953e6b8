"""Which links turn fully against the ground and their neighbours, and how far others swing.

Over the branch that the mechanism is on. Where the driver turns fully whole turns are those counted
with certainty (`analytic.turns.count`); else a link goes to and fro with the driver, between its
extremes over the branch, each followed to rounding.

Source: R. L. Norton, Design of Machinery, sections 2.12 (rotatability) and 4.10 (limit positions).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic.circuits.arcs import Arc
from analytic.prepared import prepared
from models.array import Array
from models.errors import CrankcheckError
from models.joints import block_name, joined_at
from models.scene import GROUND, Scene

LOOKS = 2880
ZOOMS, FINER = 8, 33
STILL_RAD = 1e-9
"""A swing that is no more is none: the links keep their angle but for rounding."""


@dataclass(frozen=True)
class Rotation:
    """How link ``link`` turns against ``against`` over a cycle of ``period_rad`` of the driver.

    ``turns`` are the whole turns that it gains, counter-clockwise; without any it swings from
    ``low_rad`` to ``high_rad``, of which ``low_at_rad`` and ``high_at_rad`` are driver angles: its
    limit positions.
    """

    link: str
    against: str
    turns: int
    low_rad: float
    high_rad: float
    low_at_rad: float
    high_at_rad: float
    period_rad: float

    @property
    def swing_rad(self) -> float:
        return self.high_rad - self.low_rad

    @property
    def word(self) -> str:
        """turns, swings or keeps its angle."""
        if self.turns:
            return "turns"
        return "swings" if self.swing_rad > STILL_RAD else "keeps its angle"


def neighbours(scene: Scene) -> list[tuple[str, str]]:
    """The links by pairs with what they are pinned to or slide on, the ground first."""
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
    """How every link turns against the ground and against its neighbours, over a branch of its own:
    that which the scene is on.

    Raises
    ------
    CrankcheckError
        A link can not be followed, as its angle runs through infinity or a singular position.
    """
    follow = _Follower.of(scene, arc)
    return [follow.rotation(link, against) for link, against in neighbours(scene)]


@dataclass(frozen=True)
class _Follower:
    """Angles of links over a branch at driver angles ``theta``, continuous along it."""

    scene: Scene
    arc: Arc
    theta: Array
    angles: Mapping[str, Array]
    period: float

    @staticmethod
    def of(scene: Scene, arc: Arc) -> _Follower:
        period = prepared(scene).period if arc.low is None else math.tau
        theta = arc.angles(LOOKS + 1)
        if arc.low is None:
            theta = np.linspace(-math.pi, period - math.pi, LOOKS * round(period / math.tau) + 1)
        angles = {GROUND: np.zeros_like(theta)}
        for name, angle in _plain(scene, theta).items():
            angles[name] = np.unwrap(angle)
            if np.max(np.abs(np.diff(angles[name])), initial=0.0) > 0.5 * math.pi:
                raise CrankcheckError(
                    f"{scene.name}: {name} turns too fast to be followed, by more than a right "
                    "angle within an eighth of a degree of the driver: it passes a singular "
                    "position as good as; change a length"
                )
        return _Follower(scene, arc, theta, angles, period)

    def rotation(self, link: str, against: str) -> Rotation:
        relative = self.angles[link] - self.angles[against]
        turns = 0
        if self.arc.low is None:
            turns = round((relative[-1] - relative[0]) / math.tau)
            turns = self._certain(link, against, turns)
        low = self._extreme(link, against, relative, -1.0)
        high = self._extreme(link, against, relative, 1.0)
        shift = math.tau * math.floor((0.5 * (low[0] + high[0]) + math.pi) / math.tau)
        return Rotation(
            link, against, turns, low[0] - shift, high[0] - shift, low[1], high[1], self.period
        )

    def _certain(self, link: str, against: str, seen: int) -> int:
        """The turns as they are counted with certainty; those of links that keep an angle to the
        driver or to the ground are told by it alone."""
        gains = prepared(self.scene).turns.gains
        cycle = self.period / math.tau
        own = {GROUND: 0.0, **gains}
        if self.scene.driver.is_crank:
            own[self.scene.driver.link] = cycle
        if link not in own or against not in own:
            return seen
        return round(own[link] - own[against])

    def _extreme(
        self, link: str, against: str, relative: Array, sense: float
    ) -> tuple[float, float]:
        """The largest (``sense`` 1) or smallest angle [rad], and the driver's angle there."""
        best = int(np.argmax(sense * relative))
        value, at = float(relative[best]), float(self.theta[best])
        low = float(self.theta[max(best - 1, 0)])
        high = float(self.theta[min(best + 1, len(self.theta) - 1)])
        for _ in range(ZOOMS):
            looks = np.linspace(low, high, FINER)
            plain = _plain(self.scene, looks)
            angle = plain[link] - plain.get(against, np.zeros(FINER))
            angle = angle + math.tau * np.round((value - angle) / math.tau)
            k = int(np.argmax(sense * angle))
            if sense * (float(angle[k]) - value) >= 0.0:
                value, at = float(angle[k]), float(looks[k])
            low, high = float(looks[max(k - 1, 0)]), float(looks[min(k + 1, FINER - 1)])
        return value, math.remainder(at, math.tau)


def _plain(scene: Scene, theta: Array) -> dict[str, Array]:
    """The angles of all links but for whole turns, by the motion with its change points."""
    chunk = prepared(scene).stretched(theta)
    found = {}
    for name in scene.links:
        body = chunk.bodies[name]
        angle = np.arctan2(body.turn.y, body.turn.x) if body.theta is None else body.theta
        found[name] = np.array(np.broadcast_to(angle, theta.shape), dtype=np.float64)
    return found
