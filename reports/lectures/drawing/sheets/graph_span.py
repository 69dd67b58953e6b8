"""Spans of graphs: a period of the driver, in time or in its angle.

With a driver of constant speed, graphs over its angle are the graphs over time with another scale
along: rates are rates. Otherwise they are the derivatives by the driver's angle, which the problem
book calls analogues.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from analytic.kinematics import solve_driven
from models.array import Array
from models.errors import CrankcheckError, few, suggestion
from models.motion import Motion, Order
from models.scene import Scene
from models.scene.driver import driver_shown
from models.scene.laws import ConstantSpeed, Oscillating
from reports.compare.compare import Truth
from reports.logs.kinds import KINDS, Kind, LoggedKind

AXES = ("x", "y")


@dataclass(frozen=True)
class GraphedQuantity:
    """A quantity of a ``body`` with both of its rates: their kinds in a motion, their symbols, and
    the unit without any s."""

    name: str
    body: str
    kinds: tuple[Kind, Kind, Kind]
    symbols: tuple[str, str, str]
    unit: str


def quantity_of(motion: Motion, name: str) -> GraphedQuantity:
    """The quantity named ``name``: a link, a slider, or a coordinate of a point (C.x). Raises
    CrankcheckError for a name that the motion has not."""
    point, _, axis = name.partition(".")
    if name in motion.links:
        kinds = _kinds("link", "angle", "angular velocity", "angular acceleration")
        return GraphedQuantity(name, name, kinds, ("phi", "omega", "epsilon"), "rad")
    if name in motion.sliders:
        kinds = _kinds("slider", "displacement", "speed", "acceleration")
        return GraphedQuantity(name, name, kinds, ("s", "v", "a"), "m")
    if point in motion.points and axis in AXES:
        kinds = _kinds("point", axis, f"v{axis}", f"a{axis}")
        return GraphedQuantity(name, point, kinds, ("s", "v", "a"), "m")
    known = [*motion.links, *motion.sliders, *(f"{p}.{a}" for p in motion.points for a in AXES)]
    raise CrankcheckError(f"--of {name}: {suggestion(name, known, 'there are')}")


def _kinds(of: LoggedKind, value: str, rate: str, second: str) -> tuple[Kind, Kind, Kind]:
    return KINDS[of, value], KINDS[of, rate], KINDS[of, second]


Over = Literal["time", "angle"]
OVERS: tuple[Over, ...] = get_args(Over)
DENSE = 721
TRIFLE = 1e-3
"""Least size of a rate, as a share of the mean rate: errors are over sizes above 0."""
ON_END = 1e-6
"""Distance of a row from an end of the period below which it is on it, in periods."""
STILL = 1e-9
"""Motion [rad, longest links] below which a quantity is at rest."""


@dataclass(frozen=True)
class GraphSpan:
    """A quantity from ``start`` to ``end`` of the abscissa x: time [s], or, for analogues, the
    driver's angle [rad]. ``motion_at`` solves at places; one unit of x is ``shown`` units of the
    labels (s or deg)."""

    scene: Scene
    quantity: GraphedQuantity
    start: float
    end: float
    over: Over
    shown: float
    motion_at: Callable[[Array], Motion]
    truth: Truth | None

    @property
    def analogues(self) -> bool:
        """True if rates are by the driver's angle; only graphs over time have a ``truth``."""
        return self.truth is None

    @property
    def symbols(self) -> tuple[str, str, str]:
        symbols = self.quantity.symbols
        return (symbols[0], f"{symbols[0]}'", f"{symbols[0]}''") if self.analogues else symbols

    @property
    def units(self) -> tuple[str, str, str]:
        unit, per = self.quantity.unit, "rad" if self.analogues else "s"
        return unit, f"{unit}/{per}", f"{unit}/{per}²"

    @property
    def dense(self) -> Array:
        """Places close enough for a curve."""
        return np.linspace(self.start, self.end, DENSE)

    def divisions(self, parts: int) -> Array:
        """The ends of equal parts (n + 1,)."""
        return np.linspace(self.start, self.end, parts + 1)

    def exact(self, order: Order, x: Array) -> Array:
        """The quantity (0) or one of its rates at places, in closed form."""
        return self.quantity.kinds[order].of(self.motion_at(x), self.quantity.body)

    def sizes(self) -> tuple[float, float, float]:
        """The scales of errors: the range of the quantity, the largest of its rates."""
        motion, body = self.motion_at(self.dense), self.quantity.body
        value, rate, second = (kind.of(motion, body) for kind in self.quantity.kinds)
        least = TRIFLE / (self.end - self.start)
        size = float(np.ptp(value))
        size_of_rate = max(float(np.abs(rate).max()), least * size)
        return size, size_of_rate, max(float(np.abs(second).max()), least * size_of_rate)

    def driver_at(self, x: Array) -> Array:
        """The position of the driver at places [deg or m]."""
        if self.analogues:
            return np.degrees(x)
        place = self.scene.driver.law.at(x)[0]
        return place if self.scene.driver.slider is not None else np.degrees(place)

    @property
    def words(self) -> str:
        """The length of the span, in words."""
        return f"the angle of {self.scene.driver.joint}" if self.analogues else "a period"

    @property
    def taken(self) -> str:
        """The period of a log that is drawn, in words."""
        turns = self.start / (self.end - self.start)
        if abs(turns - round(turns)) <= ON_END:
            return f"in period {round(turns) + 1} of the driver, the first whole one in it"
        return "from its first row on, as it has no whole period of the driver"

    def within(self, first: float, last: float) -> GraphSpan:
        """The first period of the driver within the rows of a log, from ``first`` to ``last`` [s],
        or the period from the first row on."""
        if first <= self.start:
            return self
        lasts = self.end - self.start
        start = math.ceil(first / lasts - ON_END) * lasts
        start = start if start + lasts <= last + ON_END * lasts else first
        return replace(self, start=start, end=start + self.end - self.start)


class FreeSpan(GraphSpan):
    """The span of free motion: its first seconds."""

    taken = "from its release on"

    def driver_at(self, x: Array) -> Array:
        return driver_shown(self.scene, self.motion_at(x))

    @property
    def words(self) -> str:
        return f"{self.end - self.start:g} s"

    def within(self, first: float, last: float) -> GraphSpan:
        return self


def over_period(scene: Scene, name: str, over: Over, duration_s: float | None) -> GraphSpan:
    """The quantity ``name`` of a scene over a period, or in free motion over a duration.

    Raises CrankcheckError for a quantity that the scene has not or that is at rest, and for a
    duration or a period that does not apply.
    """
    of = (_let_go if scene.is_free else _driven)(scene, name, over, duration_s)
    unit = scene.longest_m if of.quantity.unit == "m" else 1.0
    if of.sizes()[0] <= STILL * unit:
        raise CrankcheckError(f"--of {name}: it stands still in {scene.name}, and has no graph")
    return of


def _driven(scene: Scene, name: str, over: Over, duration_s: float | None) -> GraphSpan:
    if duration_s is not None:
        raise CrankcheckError(
            f"--duration: {scene.name} is driven, and drawn over its period of "
            f"{scene.driver.law.period_s:.6g} s; leave it out"
        )
    law = scene.driver.law
    if over == "angle" and scene.driver.slider is not None:
        raise CrankcheckError(
            f"--over angle: the driver of {scene.name} is {scene.driver.joint}, which has no "
            "angle; use --over time"
        )
    truth = Truth(scene, bound=False)
    quantity = quantity_of(truth.at(np.zeros(1)), name)
    if over == "angle" and not isinstance(law, ConstantSpeed):
        return _by_angle(scene, quantity)
    shown = math.degrees(law.peak_speed_rad_s) if over == "angle" else 1.0
    return GraphSpan(scene, quantity, 0.0, law.period_s, over, shown, truth.at, truth)


def _by_angle(scene: Scene, quantity: GraphedQuantity) -> GraphSpan:
    """The span of the driver's angle: a turn of it, or its swing."""
    law = scene.driver.law
    if isinstance(law, Oscillating):
        swing = abs(law.amplitude_rad)
        start, end = law.centre_rad - swing, law.centre_rad + swing
    else:
        start = float(law.at(np.zeros(1))[0][0])
        end = start + math.tau

    def motion_at(angle: Array) -> Motion:
        return solve_driven(scene, angle, np.ones(1), np.zeros(1), bound=False)

    return GraphSpan(scene, quantity, start, end, "angle", math.degrees(1.0), motion_at, None)


def refuse_released_elastic(scene: Scene, drawings: str, cure: str) -> None:
    """Refuse elastic links in free motion for ``drawings``. Raises CrankcheckError."""
    if scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: {few(scene.elastic, 4)} is elastic and in free motion, and {drawings} "
            f"are those of rigid links; {cure}"
        )


def _let_go(scene: Scene, name: str, over: Over, duration_s: float | None) -> GraphSpan:
    writes = "`crankcheck solve` writes that motion with -o FILE.csv"
    refuse_released_elastic(scene, "graphs", f"{writes}, or take [elastic] out of the scene")
    if duration_s is None:
        raise CrankcheckError(
            f"{scene.name}: free motion has no period to draw; give --duration SECONDS"
        )
    if over == "angle":
        raise CrankcheckError(
            f"--over angle: {scene.name} is in free motion, and its driver may turn back; use "
            "--over time"
        )
    if not (math.isfinite(duration_s) and duration_s > 0.0):
        raise CrankcheckError(f"--duration {duration_s:g}: give seconds above 0")
    # The integrator is not loaded for a driven scene.
    from reports.compare.free_truth import free_truth_until

    truth = free_truth_until(scene, duration_s, 0.0)
    quantity = quantity_of(truth.at(np.zeros(1)), name)
    return FreeSpan(scene, quantity, 0.0, duration_s, over, 1.0, truth.at, truth)
