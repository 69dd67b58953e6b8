"""The equation of a machine over time: windows of collocation, from kink to kink.

Windows are as long as their polynomials allow. They end at every kink over time; where a load, a
stroke or friction changes formula with the position or speed of the machine, the window is solved
again until it ends there. At rest friction may hold the machine.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from analytic.free.coordinate_history import CoordinateHistory, Window
from analytic.free.kinks import BEYOND, SHORT_OF, WindowKinks, heeds_direction, is_kinked
from analytic.free.machine import Machine
from analytic.free.window import Acceleration, Gauss, Scale, WindowSolution, solve_window, sums
from analytic.multibody.generalised_forces import edges
from analytic.multibody.steps import Pace
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene

GROWTH, LEAST = 2.0, 0.15
"""Largest ratio of a window to the one before it, and smallest when it is tried again."""
SHORTEST = 1e-12
"""Shortest window over the whole time."""
AIMS = 30
"""Number of windows that are tried to end at a change of formula."""


@dataclass
class Integration:
    """State of an integration, at ``u``, ``v`` of its machine's chart.

    ``edges_s`` are the instants at which the forces are not smooth.
    """

    scene: Scene
    rule: Gauss
    until_s: float
    machine: Machine
    u: float
    v: float
    wound: dict[str, float]
    now_s: float = 0.0
    long_s: float = 0.0
    fastest: float = 0.0
    pace: Pace = field(default_factory=Pace)
    windows: list[Window] = field(default_factory=list)
    edges_s: list[float] = field(default_factory=list)

    def run(self) -> CoordinateHistory:
        """Integrate all windows. Raises CrankcheckError where it fails."""
        self.long_s = self.until_s / 100.0
        self.pace.note(self.now_s, abs(self.v))
        for border in edges(self.scene, self.until_s)[1:]:
            self._to(border)
            self.pace.end_at_edge()
            if border < self.until_s:
                self.edges_s.append(border)
        return CoordinateHistory(tuple(self.windows))

    def _to(self, border_s: float) -> None:
        """Integrate windows up to an instant; in between everything over time is smooth."""
        while self.now_s < border_s:
            if self.v == 0.0 and self._heeds_way:
                way = self._way(np.array([self.now_s]))[0]
                if way == 0.0:
                    self._rest(border_s)
                    continue
            else:
                way = math.copysign(1.0, self.v)
            self._step(border_s, way)
            self._hop()
            check_count(self.scene, self.until_s, self.pace)

    def _step(self, border_s: float, way: float) -> None:
        left = border_s - self.now_s
        long_s = min(self.long_s, left)
        if 0.5 * left < long_s < left:
            long_s = 0.5 * left  # two alike instead of a short one at the end
        solved, lasts_s, edge = self._solved(long_s, way)
        end_s = self.now_s + lasts_s
        if (over := end_s - border_s) >= -4.0 * math.ulp(border_s):
            # A change of formula at the instant, or only after it.
            lasts_s, end_s, edge = left, border_s, edge and over <= 4.0 * math.ulp(border_s)
        self._keep(solved, lasts_s, end_s, bends=edge)
        if edge:
            if end_s < border_s:
                self.edges_s.append(end_s)
            if self._heeds_way and abs(self.v) <= 1e-9 * self.fastest:
                self.v = 0.0

    def _keep(self, solved: WindowSolution, lasts_s: float, end_s: float, *, bends: bool) -> None:
        chart, series = self.machine.chart, solved.series
        window = Window(
            chart, self.now_s, end_s, solved.long_s, *series, *solved.changes(),
            wound=self.wound, bends=bends,
        )  # fmt: skip
        self.windows.append(window)
        self.now_s, (self.u, self.v) = end_s, solved.after(lasts_s)
        self.pace.note(self.now_s, abs(self.v))
        self.fastest = max(self.fastest, abs(self.v), abs(float(series[1][0])))
        if self.wound:
            ends = self.machine.lengths(np.array([self.u]), self.wound)
            self.wound = {name: float(q[0]) for name, q in ends.items()}

    def _solved(self, long_s: float, way: float) -> tuple[WindowSolution, float, bool]:
        """Return a window that is short enough, its duration [s], and True if it ends at a change
        of formula. The end is a little beyond the solved part, over which one formula counts.
        Raises CrankcheckError."""
        failed: CrankcheckError | None = None
        rough: WindowSolution | None = None
        aimed, start = 0, self._start(long_s, way)
        kinks = self._kinks()
        if kinks and (ahead := kinks.ahead(long_s, (self.u, self.v, start[0]))):
            aimed, long_s = 1, ahead * SHORT_OF
        # The rest up to an instant may be less: a kink comes within rounding of it.
        shortest = min(SHORTEST * self.until_s, 0.5 * long_s)
        while long_s > shortest or 0 < aimed < AIMS:
            try:
                solved = self._tried(long_s, start, rough)
                crossing = kinks.within(solved, beyond=aimed > 0) if kinks and solved else None
            except CrankcheckError as error:  # it leads out of reach: too long
                solved, failed = None, error
            if solved is None:
                long_s, aimed, rough = 0.25 * long_s, 0, None
                start = self._start(long_s, way)
                continue
            end = None if crossing is None else crossing.at_s
            landed = end is not None and long_s <= end <= BEYOND * long_s
            if end is not None and not (landed and solved.converged) and aimed < AIMS:
                aimed, long_s, rough = aimed + 1, end * SHORT_OF, solved
                continue
            excess = solved.excess(self._scale())
            share = 0.9 * max(excess, 1e-30) ** (-1.0 / self.rule.count)
            if solved.converged and excess <= 1.0 and (landed or end is None):
                self.long_s = max(self.long_s, long_s) if aimed else long_s * min(GROWTH, share)
                if kinks and crossing and landed:
                    return solved, kinks.landing(solved, crossing), True
                return solved, long_s, False
            long_s *= max(LEAST, min(share, 0.8)) if solved.converged else 0.5
            aimed, rough = 0, None
        self.pace.check_runaway(self.scene, self.now_s)
        phi, _, _ = self.machine.chart.driver(np.array([self.u]))
        raise failed or CrankcheckError(
            f"{self.scene.name}: its free motion is lost at {self.now_s:.6g} s, with "
            f"{self.scene.driver.link} at {math.degrees(float(phi[0])):.6g} deg: a load or the "
            "motion is not smooth there, or has no mass"
        )

    def _start(self, long_s: float, way: float) -> tuple[float, float]:
        """Return the acceleration at, or just after, a window's start, and its slope [1/s]."""
        before = self.windows[-1] if self.windows and not self._heeds_way else None
        if before is not None and before.bends and before.chart is self.machine.chart:
            # Tables bend there and do not jump: start as the window before ended.
            orders = np.arange(len(before.a))
            return float(before.a.sum()), float(orders * (orders + 1) @ before.a) / before.long_s
        after_s = 1e-3 * long_s
        time_s, v = np.array([self.now_s + after_s]), np.array([self.v or way * TINY])
        start = self._acceleration(time_s, np.array([self.u]), v)
        if not np.isfinite(start).all():  # a spring of no length has no direction
            start = self._acceleration(time_s, self.u + after_s * v, v)
        return float(start[0]), 0.0

    def _tried(
        self, long_s: float, start: tuple[float, float], rough: WindowSolution | None
    ) -> WindowSolution | None:
        """Solve a window, from a ``rough``, longer one, or the acceleration ``start`` and its
        slope."""
        if rough is not None and rough.long_s >= long_s:
            first = sums(rough.series[2][None], self.rule.places * (long_s / rough.long_s))
        else:
            first = start[0] + start[1] * long_s * self.rule.places
        if not np.isfinite(first).all():
            return None
        state = (self.now_s, self.u, self.v)
        return solve_window(self.rule, self._acceleration, state, long_s, first, self._scale())

    def _acceleration(self, time_s: Array, u: Array, v: Array) -> Array:
        with np.errstate(all="ignore"):
            return self.machine.acceleration(time_s, u, v, self.wound)

    def _scale(self) -> Scale:
        return Scale(
            max(1.0, abs(self.u)) if self.machine.chart.limit is None else 1.0, self.fastest
        )

    @cached_property
    def _heeds_way(self) -> bool:
        return heeds_direction(self.scene)

    @cached_property
    def _kinked(self) -> bool:
        return is_kinked(self.scene)

    def _kinks(self) -> WindowKinks | None:
        """Return the kinks of the next window; None where no formula has any."""
        if not self._kinked:
            return None
        smooth = bool(self.windows) and not self.windows[-1].bends
        return WindowKinks(self.machine, self.rule, smooth)

    def _way(self, time_s: Array) -> Array:
        """Return the direction out of rest, 0 where the machine is held, at times [s], (T,)."""
        return way_out(self._acceleration, self.u, time_s)

    def _rest(self, border_s: float) -> None:
        """Add a window at rest, until a force moves the machine, or to an instant."""
        end_s = rest_until(self._way, self.now_s, border_s)
        n = self.rule.count
        still = Window(
            self.machine.chart, self.now_s, end_s, end_s - self.now_s,
            np.array([self.u, 0.0]), np.zeros(1), np.zeros(1),
            np.diag([1.0, 0.0]), np.stack([np.ones(n), np.zeros(n)]), self.wound,
        )  # fmt: skip
        self.windows.append(still)
        self.now_s = end_s
        self.pace.note(self.now_s, 0.0)
        if end_s < border_s:
            self.edges_s.append(end_s)

    def _hop(self) -> None:
        """Take the chart of the other limit where the motion is nearer to it."""
        chart = self.machine.chart
        if chart.left(self.u) is not None:
            chart, self.u, self.v = chart.next(self.u, self.v)
            self.machine = Machine(self.scene, chart)


LOOKS, LOOKED = 257, 7
"""Number of instants at which an end of rest is searched, and of refinements."""
TINY = 1e-150
"""Rate that only gives the direction of the beginning motion."""


def way_out(acceleration: Acceleration, at: float, time_s: Array) -> Array:
    """Return the direction in which a machine leaves its rest, 0 where held, at times [s], (T,).

    A load on one stroke may let it leave both ways: then the push without that load decides, as at
    rest no stroke has begun.
    """
    u, v = np.full_like(time_s, at), np.full_like(time_s, TINY)
    ahead = acceleration(time_s, u, v)
    back = acceleration(time_s, u, -v)
    way = np.where(ahead > 0.0, 1.0, np.where(back < 0.0, -1.0, 0.0))
    either = (ahead > 0.0) & (back < 0.0)
    if either.any():
        still = acceleration(time_s, u, np.zeros_like(v))
        way[either & (still < 0.0)] = -1.0
    return way


def rest_until(way: Callable[[Array], Array], low: float, high: float) -> float:
    """Return the end of the rest since ``low``, ``high`` at the latest [s]."""
    for _ in range(LOOKED):
        looks = np.linspace(low, high, LOOKS)
        moved = np.flatnonzero(way(looks[1:]) != 0.0)
        if not moved.size:
            break
        k = int(moved[0])
        low, high = float(looks[k]), float(looks[k + 1])
    return high


MOST_WINDOWS = 50_000
"""Most windows: a crank of a tenth of a metre takes half of them, and minutes, for 1000 seconds."""
FIRST_WINDOWS, FAR = 300, 4.0
"""Number of windows after which the total is foretold, and the excess at which it is refused."""


def check_count(scene: Scene, until_s: float, pace: Pace) -> None:
    """Refuse a time that takes too many windows. Raises CrankcheckError."""
    made, now_s = pace.made, pace.times_s[-1]
    lasted_s = pace.lasted_s(FIRST_WINDOWS)
    if (until_s - now_s) * FIRST_WINDOWS > FAR * MOST_WINDOWS * lasted_s:
        pace.check_runaway(scene, now_s)
    ahead = made * until_s / now_s
    if made >= MOST_WINDOWS or (made >= FIRST_WINDOWS and ahead > FAR * MOST_WINDOWS):
        raise CrankcheckError(
            f"{scene.name}: free for {until_s:g} s, of which {now_s:.3g} s took "
            f"{made} windows of the integration; at most {MOST_WINDOWS} are made: give a time "
            f"of {now_s * MOST_WINDOWS / made:.2g} s or less"
        )
