"""Arcs: the driver angles over which a mechanism closes with given branches of all its dyads.

Dyads are taken in solving order. Over an arc of the earlier ones, a dyad closes on parts of the
arc, whose ends are its own limit positions or those of the arc. Samples of an arc are spread by the
cosine of a parameter, and so lie close beside its ends, where later groups move like a root.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS
from analytic.dyads.steps import stretched
from analytic.prepared import Prepared, bisect, prepared, shortage, with_valleys
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import StructureError
from models.scene import Scene

LOOKS = 1440
"""Number of samples of an arc."""
HALVINGS = 60
NARROW = 0.02
"""Width of a part over that of its arc, below which it has few samples, and is scanned anew."""
ROUNDING = 64 * EPS
"""Allowed gap of a closed dyad, over the longest link: at a change point."""
GAP = 1e-6
"""Width of a driver range [rad], open or closed, that counts as none: a change point, or a place
where it just closes, to a root of rounding."""
MOST = 8
"""Most dyads with two assemblies: 256 sets of signs, beyond which it takes a minute."""

Signs = tuple[int, ...]


@dataclass(frozen=True)
class ArcEnd:
    """Limit position of the driver: its angle [rad] and the dyad whose two assemblies meet."""

    angle_rad: float
    dyad: str


@dataclass(frozen=True)
class Arc:
    """Branch: driver angles from ``low`` to ``high``, with the ``signs`` of the dyads. A driver
    that turns fully has no ends."""

    signs: Signs
    low: ArcEnd | None = None
    high: ArcEnd | None = None

    @property
    def range_rad(self) -> tuple[float, float]:
        """Driver's angles [rad]; a turn from -pi on where it turns fully."""
        if self.low is None or self.high is None:
            return -math.pi, math.pi
        return self.low.angle_rad, self.high.angle_rad

    def holds(self, theta: float, slack: float = 0.0) -> bool:
        """True if a driver angle [rad] is on it, whole turns apart."""
        low, high = self.range_rad
        off = math.remainder(theta - 0.5 * (low + high), math.tau)
        return self.low is None or abs(off) <= 0.5 * (high - low) + slack

    def angles(self, count: int) -> Array:
        """Return so many driver angles from end to end [rad], close beside limited ends."""
        low, high = self.range_rad
        if self.low is None:
            return np.linspace(low, high, count)
        spread = -np.cos(np.linspace(0.0, math.pi, count))
        return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * spread)


@dataclass(frozen=True)
class SignedScene:
    """Scene of dyads, driven at a crank, whose branches are chosen by signs in the order of
    ``dyads``."""

    scene: Scene
    dyads: tuple[str, ...]

    @staticmethod
    def of(scene: Scene) -> SignedScene:
        """Take a scene. Raises StructureError for another driver, and for other groups."""
        if not scene.driver.is_crank:
            raise StructureError(
                f"{scene.name}: circuits need a driver that is a link pinned to the ground, and "
                f"{scene.driver.joint} drives"
            )
        structure = analyse(scene)
        if structure.triads or structure.redundant:
            odd = [*(t.central for t in structure.triads), *(b.link for b in structure.redundant)]
            raise StructureError(
                f"{scene.name}: circuits are found for class II mechanisms, and {', '.join(odd)} "
                "is of no dyad (a triad's central link, or a redundant one)"
            )
        dyads = tuple(g.branch_key for g in structure.groups if g.assemblies == 2)
        if len(dyads) > MOST:
            raise StructureError(
                f"{scene.name}: found {len(dyads)} dyads with two assemblies each; circuits are "
                f"found for up to {MOST}"
            )
        return SignedScene(scene, dyads)

    @property
    def signs(self) -> Signs:
        """Signs of the scene's own branches."""
        return tuple(self.scene.branch.get(key, 1) for key in self.dyads)

    @property
    def start_rad(self) -> float:
        """Driver's angle at time 0."""
        return prepared(self.scene).start

    def with_signs(self, signs: Signs) -> Scene:
        """Return the scene on other branches."""
        if signs == self.signs:
            return self.scene
        return replace(self.scene, branch=dict(zip(self.dyads, signs, strict=True)))

    def chunk(self, signs: Signs, theta: Array) -> Chunk:
        """Return the mechanism with these signs at driver angles [rad], open dyads stretched."""
        padded = signs + (1,) * (len(self.dyads) - len(signs))
        return stretched(self.with_signs(padded), tuple(prepared(self.scene).steps), theta)

    def shortage(self, signs: Signs, theta: Array) -> Array:
        """Return the shortage of the last dyad with a given sign [m], <= 0 closes."""
        short = self.chunk(signs, theta).shortage.get(self.dyads[len(signs) - 1], -np.inf)
        less = ROUNDING * self.scene.longest_m
        return np.array(np.broadcast_to(np.nan_to_num(short, nan=np.inf), theta.shape)) - less


def arcs(signed: SignedScene) -> list[Arc]:
    """Return all branches of a mechanism, ordered by their signs, + before -, and the driver."""
    found = [Arc(())]
    for _ in signed.dyads:
        parts = [list(_closing(signed, arc)) for arc in found]
        found = [
            replace(part, signs=(*part.signs, sign))
            for closing in parts
            for part in closing
            for sign in (1, -1)
        ]
    return sorted(found, key=lambda arc: (tuple(-s for s in arc.signs), arc.range_rad))


def _closing(signed: SignedScene, arc: Arc) -> Iterator[Arc]:
    """Yield the parts of an arc over which the next dyad closes, for either sign of it."""
    signs = (*arc.signs, 1)
    key = signed.dyads[len(arc.signs)]
    shortage_at = partial(signed.shortage, signs)
    theta = with_valleys(shortage_at, arc.angles(LOOKS + 1))
    closes = shortage_at(theta) <= 0.0
    if closes.all():
        yield arc
        return
    edges = np.flatnonzero(closes[1:] != closes[:-1])
    was = closes[edges]
    borders = bisect(shortage_at, theta[edges], theta[edges + 1], was)
    ends = [ArcEnd(float(at), key) for at in borders]
    opens = [end for end, closed in zip(ends, was, strict=True) if not closed]
    shuts = [end for end, closed in zip(ends, was, strict=True) if closed]
    if arc.low is None:  # round the turn: the part that holds its seam is one
        if closes[0] and shuts:
            first = shuts.pop(0)
            shuts.append(_later(first))
    else:
        opens = [arc.low, *opens] if closes[0] else opens
        shuts = [*shuts, *([arc.high] if closes[-1] and arc.high else [])]
    for part in _merged(arc, opens, shuts):
        narrow = _width(part) < NARROW * _width(arc)
        yield from _closing(signed, part) if narrow else [part]


def _width(arc: Arc) -> float:
    low, high = arc.range_rad
    return high - low


def _merged(arc: Arc, opens: list[ArcEnd], shuts: list[ArcEnd]) -> Iterator[Arc]:
    """Yield the parts of an arc between their ends, without gaps by rounding."""
    parts: list[tuple[ArcEnd, ArcEnd]] = []
    for one, other in zip(opens, shuts, strict=True):
        if parts and one.angle_rad - parts[-1][1].angle_rad < GAP:
            parts[-1] = parts[-1][0], other
        else:
            parts.append((one, other))
    turn = arc.low is None
    if turn and parts and parts[0][0].angle_rad + math.tau - parts[-1][1].angle_rad < GAP:
        if len(parts) == 1:
            yield arc
            return
        parts = [*parts[1:-1], (parts[-1][0], _later(parts[0][1]))]
    for one, other in parts:
        if other.angle_rad - one.angle_rad > GAP:
            yield Arc(arc.signs, one, other)


def _later(end: ArcEnd) -> ArcEnd:
    """Return an end a turn of the driver later."""
    return ArcEnd(end.angle_rad + math.tau, end.dyad)


def own_arc(scene: Scene) -> Arc:
    """Return the driver's range about its start [rad]; for a slider, places over the driver's
    scale. Raises ReachError where the scene can not be assembled at its start.

    It is the range of the driver both ways from its start; ends are found by samples, and refined.
    An open part narrower than a sample's width is passed over.
    """
    ready = prepared(scene)
    ready.chunk(np.array([ready.start]), 0.0, 0.0, None)
    low, high = (_end(ready, way) for way in (-1.0, 1.0))
    if low is None or high is None:
        return Arc(())
    return Arc((), low, high)


def _end(ready: Prepared, way: float) -> ArcEnd | None:
    """Return the first driver angle from the start on, one way, beyond which it is open; None if
    there is none within a period."""
    most = max(ready.period, ready.looked_turns * math.tau)
    theta = ready.start + way * np.linspace(0.0, most, LOOKS * round(most / math.tau) + 1)
    opens = np.flatnonzero(shortage(ready.stretched, theta) > 0.0)
    if not opens.size:
        return None
    near, far = float(theta[max(opens[0] - 1, 0)]), float(theta[opens[0]])
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if shortage(ready.stretched, np.array([middle]))[0] <= 0.0:
            near = middle
        else:
            far = middle
    beyond = ready.stretched(np.array([far])).shortage
    key = max(beyond, key=lambda name: float(np.max(np.nan_to_num(beyond[name], nan=np.inf))))
    return ArcEnd(near, key)
