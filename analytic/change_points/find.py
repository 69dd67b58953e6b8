"""Change points: driver angles in which the two assemblies of a dyad meet, and motion goes on.

::

    root |  \\       /        The root of a dyad, whose sign is the branch, touches zero: the smooth
         |   \\     /         motion goes on to the other sign of it. To keep the sign would be to
         |    \\   /          turn back, with a jump of all rates.
       0 |------x------
           change point

The sign at a driver angle is therefore that of the branch, which is stated at the driver's angle at
time 0, times -1 for every change point between the two: a function of the driver's angle that may
need two turns to repeat, or four. A root that crosses zero is a limit position instead, and one
that comes near to zero is neither: it must touch zero to within rounding, `CLOSED`.

Source: C. Galloway's mechanism and the parallelogram, e.g. Norton, Design of Machinery, section
2.12 (the Grashof condition, special case).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.change_points.sign import AT_START, SIDE, ChangePoints, whole_turns_off
from analytic.dyads.chunk import driver_scale, told
from analytic.dyads.parts import CLOSED
from analytic.dyads.plane import Real
from analytic.dyads.steps import PeriodicStep, Step, stretched
from models.array import Array, Mask
from models.errors import CrankcheckError
from models.motion import Crossing
from models.scene import Scene
from models.scene.laws import ConstantSpeed

SCAN = 360
"""Angles of the first scan of a turn: a touch is seen as a valley between its neighbours."""
WIDTHS = (4e-3, 4e-4, 4e-5, 1e-6)
"""Half-widths [rad] over which a valley, taken as a V, is followed to its tip; the last finds it to
about 1e-10 rad where a root is taken of rounding."""
TIP = 1e-8
"""Half-width of one more scan [rad]: the tip of two pins that meet is found to rounding."""
CLOSER = 3
"""Scans of the place where a driver begins to move, each `SCAN` times as close as the last."""
LONGEST_REST = 1e9
"""Periods after which a law counts as one that never moves."""
UNSURE = 64.0
"""Ratio of a dyad's allowed gap in a change point of an earlier one to that of its own."""


def passages(scene: Scene, steps: Sequence[Step]) -> dict[str, ChangePoints]:
    """Find the dyads that go through change points, in solving order; none in most scenes.

    Raises
    ------
    CrankcheckError
        A dyad is as good as in a change point where one before it goes through its own.
    """
    start = _start(scene)
    passing: dict[str, ChangePoints] = {}
    period = math.tau
    theta = _grid(start, period)
    chunk = stretched(scene, steps, theta)
    for k, step in enumerate(steps):
        if isinstance(step, PeriodicStep):
            period = max(period, step.period(passing, period) or math.tau)
            theta = _grid(start, period)
            chunk = stretched(scene, steps, theta, passing)
            continue
        closure = chunk.closures.get(step.key)
        if closure is None or closure.root is None or np.ndim(closure.root) == 0:
            continue  # the last: it hangs on what stands still, and so stands still itself
        valleys = theta[_valleys(closure.root)]
        if not valleys.size:
            continue
        look = _ValleySearch(scene, steps[: k + 1], passing)
        angles = np.sort(start + np.remainder(look.touches(valleys) - start, period))
        angles = angles[np.diff(angles, prepend=-np.inf) > AT_START]  # two valleys, one tip
        if not angles.size:
            continue
        if angles.size % 2:  # as many again, with the other sign
            angles, period = np.concatenate([angles, angles + period]), 2.0 * period
        passing[step.key] = ChangePoints(
            scene, steps[: k + 1], dict(passing), start, period, angles
        )
        # Later groups have other positions where the sign is another.
        theta = _grid(start, period)
        chunk = stretched(scene, steps, theta, passing)
    return passing


def passed(passing: Mapping[str, ChangePoints], low: float, high: float) -> tuple[Crossing, ...]:
    """Return the change points that a driver passes from angle ``low`` to ``high``, each once."""
    crossings = []
    for key, passage in passing.items():
        first = np.ceil((low - AT_START - passage.angles) / passage.period)
        met = passage.angles[passage.angles + first * passage.period <= high + AT_START]
        places = sorted(whole_turns_off(float(angle)) for angle in met)
        crossings += [
            Crossing(key, place)
            for before, place in zip([-1.0, *places], places, strict=False)
            if place - before > AT_START
        ]
    return tuple(crossings)


@dataclass(frozen=True)
class _ValleySearch:
    """Search of one dyad, the last of ``steps``, beside the angles where its root has a valley."""

    scene: Scene
    steps: Sequence[Step]
    found: Mapping[str, ChangePoints]

    def touches(self, theta: Array) -> Array:
        """Return the angles in which the root touches zero, among those near which it might."""
        theta = self._tip(theta, math.tau / SCAN)
        sides = self._closure(theta + np.array([[-1.0], [1.0]]) * WIDTHS[0])[1]
        theta = theta[(sides < 0.0).all(axis=0)]  # limit positions are most of what is left here
        if not theta.size:
            return theta
        for width in WIDTHS:
            theta = self._tip(theta, width)
        keep = self._is_touched(theta) | self._is_touched(self._tip(theta, TIP))
        keep &= self._is_crossed(theta)
        return np.asarray(theta[keep])

    def _closure(self, theta: Array) -> tuple[Array, Array, Array]:
        """Return root, shortage (infinite behind an open dyad) and rounding at driver angles."""
        chunk = stretched(self.scene, self.steps, theta.ravel(), self.found)
        closure = chunk.closures[self.steps[-1].key]
        assert closure.short_m is not None
        short = np.array(np.broadcast_to(closure.short_m, theta.size))
        for step in self.steps[:-1]:
            before = chunk.shortage.get(step.key)
            short = short if before is None else np.where(before > 0.0, np.inf, short)
        rows: tuple[Real, ...] = closure.root, short, closure.rounding_m
        root, short, rounding = (np.broadcast_to(r, theta.size).reshape(theta.shape) for r in rows)
        return root, short, rounding

    def _tip(self, theta: Array, width: float) -> Array:
        """Return the place where the two sides of a V would meet."""
        left, right = self._closure(theta + np.array([[-width], [width]]))[0]
        with np.errstate(invalid="ignore"):
            shift = np.nan_to_num(width * (left - right) / (left + right))
        return np.asarray(theta + shift)

    def _is_touched(self, theta: Array) -> Mask:
        """Return the mask where the root is zero but for rounding.

        Raises
        ------
        CrankcheckError
            The dyads before this one are not known well enough.
        """
        _, short, rounding = self._closure(theta)
        short = np.abs(short + 0.5 * rounding)
        # Where two pins meet, their places may be smaller than the terms of their difference.
        rounding = np.maximum(rounding, CLOSED * self.scene.longest_m)
        near = np.zeros(theta.shape, dtype=bool)
        for passage in self.found.values():
            near |= passage.is_near(theta)
        touched: Mask = short <= rounding
        unsure = near & ~touched & (short <= UNSURE * rounding)
        if unsure.any():
            raise CrankcheckError(
                f"{self.scene.name}: at {self.scene.driver.joint} "
                f"{told(self.scene, whole_turns_off(float(theta[unsure][0])))} the dyad of "
                f"{self.steps[-1].key} is singular to within the rounding of the change point of a "
                "dyad before it, so its motion is not determined there, nor its branch beyond: "
                "change a length"
            )
        return touched

    def _is_crossed(self, theta: Array) -> Mask:
        """Return the mask where both sides close, and the root grows there like the angle."""
        sides = np.array([[-2.0], [-1.0], [1.0], [2.0]]) * SIDE
        root, short, _ = self._closure(theta + sides)
        with np.errstate(invalid="ignore", divide="ignore"):
            growth = (root[0] + root[3]) / (root[1] + root[2])
        return np.asarray((short < 0.0).all(axis=0) & (growth > 1.4) & (growth < 2.9))


def _start(scene: Scene) -> float:
    """Return the driver's angle just after the time at which the branch is stated.

    A law may rest for longer than its period: the scanned time is doubled until it moves, and
    scanned ever closer there, as it may turn back between two samples.
    """
    law, scale = scene.driver.law, driver_scale(scene)
    low, high = 0.0, law.period_s
    first = float(law.at(np.zeros(1))[0][0]) / scale
    if isinstance(law, ConstantSpeed):
        return first + math.copysign(AT_START, law.speed_rad_s)
    way, closer = 1.0, 0
    while closer < CLOSER and high < LONGEST_REST * law.period_s:
        time_s = np.linspace(low, high, SCAN + 1)
        off = law.at(time_s)[0] / scale - first
        moved = np.flatnonzero(np.abs(off) > AT_START)
        if moved.size:
            k = int(moved[0])
            way = float(np.sign(off[k]))
            low, high, closer = float(time_s[max(k - 1, 0)]), float(time_s[k]), closer + 1
        else:
            low, high = high, 2.0 * high
    return first + way * AT_START


def _grid(start: float, period: float) -> Array:
    """Return angles over a period, the first at a place that nobody would choose."""
    count = SCAN * round(period / math.tau)
    return np.asarray(start + (np.arange(count) + 0.382) * (math.tau / SCAN))


def _valleys(root: Array) -> Mask:
    """Return the mask where a periodic root is so small beside others that it may touch zero.

    A V with its tip between two samples is at the nearer one at most a third of its value at the
    farther neighbour.
    """
    around = np.concatenate([root[-1:], root, root[:1]])
    before, after = around[:-2], around[2:]
    far = np.maximum(before, after)
    return np.asarray((root <= before) & (root <= after) & (root < 0.5 * far))
