"""Kinks of the forces on a machine: over time, and over its position and speed.

Between two kinks every load follows one formula. Kinks over time are known beforehand; all others
show as a change of the piece's number, where a load, a stroke or friction changes formula
(`Kinked`). The pull of a spring does so where its two points pass one another: it reverses.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.polynomial import legendre

from analytic.dyads.chunk import Chunk
from analytic.forces.force_elements import spring_lengths
from analytic.free.coordinate_history import MOST
from analytic.free.machine import Machine
from analytic.free.window import Gauss, WindowSolution, gauss
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.loads import LineSpring, Spring


def heeds_direction(scene: Scene) -> bool:
    """True if a force depends on the direction of motion: friction, or a load on one stroke."""
    return bool(scene.friction) or any(load.stroke != "both" for load in scene.loads.values())


def is_kinked(scene: Scene) -> bool:
    """True if a force has kinks over the position or speed of the machine."""
    loads = scene.loads.values()
    return (
        heeds_direction(scene)
        or any(load.over != "time" and load.characteristic.kinks for load in loads)
        or any(_turns_over(spring) for spring in scene.springs.values())
    )


@dataclass(frozen=True)
class Kinked:
    """Argument ``x`` (T,) of a formula of the scene, with its kinks; a ``sign`` alone has one, at
    0, and is a piece of its own in it."""

    x: Array
    kinks: Array
    period: float | None = None
    sign: bool = False

    @property
    def pieces(self) -> Array:
        """Number of the piece at each sample."""
        if self.sign:
            return np.sign(self.x)
        kinks, period, x = self.kinks, self.period, self.x
        if period is None:
            return np.searchsorted(kinks, x, side="right").astype(np.float64)
        turns = np.floor((x - kinks[0]) / period)
        within = np.searchsorted(kinks, x - turns * period, side="right")
        closes = kinks[-1] - kinks[0] > period * (1.0 - 1e-9)  # the last row is the next first one
        return np.asarray(turns * len(kinks) + np.minimum(within, len(kinks) - closes))

    def border(self, k: int) -> float:
        """Return the kink passed on the way from the sample before ``k``: the nearest to that."""
        before, after, kinks = float(self.x[k - 1]), float(self.x[k]), self.kinks
        if self.period is not None:
            turn = math.floor((before - kinks[0]) / self.period)
            kinks = np.concatenate([kinks + (turn + n) * self.period for n in (-1, 0, 1)])
        low, high = min(before, after), max(before, after)
        passed = kinks[(low <= kinks) & (kinks <= high)]
        if not passed.size:
            return 0.5 * (before + after)
        return float(passed.min() if after > before else passed.max())


def kinked(machine: Machine, u: Array, v: Array) -> list[Kinked]:
    """Return all formulas of the scene that have kinks, at coordinates and rates (T,)."""
    zero = np.zeros(1)

    @cache  # loads over the angle need only the driver
    def unit() -> Chunk:
        return machine.chart.unit(u)

    def whole(x: object) -> Array:
        return np.broadcast_to(np.asarray(x, dtype=np.float64), u.shape)

    rows = [Kinked(v, zero, sign=True)] if heeds_direction(machine.scene) else []
    if machine.scene.friction:
        rows += [Kinked(whole(rate), zero, sign=True) for _, rate in machine.rubbing(unit())]
    for load in machine.scene.loads.values():
        if load.stroke != "both" and load.slider is not None:
            rows.append(Kinked(whole(unit().sliders[load.slider].speed * v), zero, sign=True))
        if load.over == "time" or not load.characteristic.kinks:
            continue
        if load.over == "angle":
            x = machine.chart.driver(u)[0]
        elif load.over == "omega":
            x = unit().bodies[load.body].omega * v
        else:
            assert load.slider is not None
            sliding = unit().sliders[load.slider]
            x = sliding.s if load.over == "displacement" else sliding.speed * v
        kinks = np.array(load.characteristic.kinks)
        rows.append(Kinked(whole(x), kinks, load.characteristic.repeats_after))
    if any(_turns_over(spring) for spring in machine.scene.springs.values()):
        rows += _turning_over(machine.scene, unit(), u)
    return rows


def _turns_over(spring: Spring) -> bool:
    """True if the spring pulls even at zero length."""
    return isinstance(spring, LineSpring) and spring.rate * spring.free != 0.0


def _turning_over(scene: Scene, unit: Chunk, u: Array) -> Iterator[Kinked]:
    """Yield springs whose two points may coincide between the samples: the way between these, times
    its own derivative, goes through 0 there, as it does where they are nearest."""
    with np.errstate(all="ignore"):  # of no length it has no rate
        stretched = [*spring_lengths(scene, unit)]
    for spring, length, rate in stretched:
        reach = np.nanmax(np.abs(rate), initial=0.0) * np.abs(np.diff(u)).max(initial=0.0)
        if _turns_over(spring) and not length.min() > reach:
            yield Kinked(np.nan_to_num(length * rate), np.zeros(1), sign=True)


LEAST_AHEAD = 0.02
"""Share of a window from which on a change of formula is foretold before it is solved."""
PRECISELY = 4e-14
"""Precision of a change of formula over the window: rounding of the formula's argument, some
hundred times that of the time."""
SHORT_OF, BEYOND = 1.0 - 2e-4, MOST
"""Factors of its time: windows are solved to a little before a change, and used up to it."""


@dataclass(frozen=True)
class WindowKinks:
    """Changes of formula in a window; ``smooth`` says that it does not start in one."""

    machine: Machine
    rule: Gauss
    smooth: bool

    def ahead(self, long_s: float, start: tuple[float, float, float]) -> float | None:
        """Return the first change of formula in a window that starts with u, u' and u'', as far as
        these show it [s after the start]."""
        u, v, a = start
        if not math.isfinite(a):
            return None
        looks = long_s * looked_at(self.rule.count, 1.0, smooth=self.smooth)[0]
        try:
            rows = kinked(self.machine, u + looks * (v + 0.5 * a * looks), v + a * looks)
        except CrankcheckError:  # out of its reach, where the motion itself does not come
            return None
        change = first_crossing(rows, looks)
        return change.at_s if change and change.at_s > LEAST_AHEAD * long_s else None

    def within(self, solved: WindowSolution, *, beyond: bool) -> FormulaChange | None:
        """Return the first change of formula in a window, or a little beyond it."""
        end = BEYOND if beyond else 1.0
        shares, polynomials = looked_at(self.rule.count, end, smooth=self.smooth)
        u, v, _ = solved.series
        rows = kinked(self.machine, polynomials[:, : u.size] @ u, polynomials[:, : v.size] @ v)
        return first_crossing(rows, shares * solved.long_s)

    def landing(self, solved: WindowSolution, change: FormulaChange) -> float:
        """Return the time after the start of a window at which a formula has just changed [s]."""

        def formulas(after_s: Array) -> list[Kinked]:
            return kinked(self.machine, *solved.at(after_s))

        shares, _ = looked_at(self.rule.count, 1.0, smooth=self.smooth)
        first, least_s = float(shares[0]) * solved.long_s, PRECISELY * solved.long_s
        return precisely(formulas, change, first, least_s)


@lru_cache(maxsize=32)
def looked_at(count: int, end: float, *, smooth: bool) -> tuple[Array, Array]:
    """Return the shares of a window at which formulas are evaluated, (T,): its nodes, ``end``, and
    the start of a ``smooth`` one; and Legendre's polynomials there, (T, count + 2)."""
    shares = np.append(gauss(count).places, end)
    if smooth:
        shares = np.append(0.0, shares)
    return shares, np.asarray(legendre.legvander(2.0 * shares - 1.0, count + 1), dtype=np.float64)


Formulas = Callable[[Array], list[Kinked]]
"""Formulas with kinks at times after the start of a window [s], (T,)."""
NEIGHBOURS = 3
"""Number of samples on either side for the prediction of a crossing."""
AROUND = np.concatenate(
    [-(10.0 ** np.arange(-3.0, -17.5, -0.5)), [0.0], 10.0 ** np.arange(-17.0, -2.5, 0.5)]
)
"""Samples about a crossing, over the window's time."""
ROUNDS = 8
"""Most refinements, each of which about doubles the digits."""


@dataclass(frozen=True)
class FormulaChange:
    """First change of formula: between ``low_s`` and ``high_s``, and foretold at ``at_s`` [s]."""

    low_s: float
    high_s: float
    at_s: float


def first_crossing(rows: list[Kinked], looks: Array) -> FormulaChange | None:
    """Return the first change among formulas at samples [s], (T,); None where none changes."""
    if not rows:
        return None
    pieces = np.array([row.pieces for row in rows])
    changed = pieces != pieces[:, :1]
    if not changed.any():
        return None
    k = int(np.argmax(changed.any(axis=0)))
    low, high = float(looks[k - 1]), float(looks[k])
    at = min(_foretold(row, looks, k) for row, own in zip(rows, changed, strict=True) if own[k])
    return FormulaChange(low, high, min(max(at, low), high))


def precisely(formulas: Formulas, crossing: FormulaChange, first: float, least_s: float) -> float:
    """Return the time [s] just after the change from the formulas at ``first``, to ``least_s``."""
    long_s = crossing.high_s
    for _ in range(ROUNDS):
        low, high = crossing.low_s, crossing.high_s
        if high - low <= least_s or np.nextafter(low, high) >= high:
            break
        near = crossing.at_s + long_s * AROUND
        near = near[(low < near) & (near < high)]
        looks = np.concatenate([[first], [low] if low > first else [], near, [high]])
        closer = first_crossing(formulas(looks), looks)
        if closer is None:  # within rounding of it
            break
        crossing = closer
    return crossing.high_s


def _foretold(row: Kinked, looks: Array, k: int) -> float:
    """Predict the time of a formula's kink from the samples about it: by the time as a polynomial
    of the argument, where that is monotonic, else by a straight line."""
    off = row.x - row.border(k)
    some = slice(max(k - NEIGHBOURS, 0), k + NEIGHBOURS)
    x, t = off[some], looks[some]
    steps = np.diff(x)
    if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        x, t = off[k - 1 : k + 1], looks[k - 1 : k + 1]
        if x[0] == x[1]:
            return float(t[1])
    values = t.copy()
    for n in range(1, len(x)):  # Neville's scheme at 0
        values = (x[n:] * values[:-1] - x[:-n] * values[1:]) / (x[n:] - x[:-n])
    return float(values[0])
