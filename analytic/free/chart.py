"""The coordinate of the integration: the driver's angle, or near its limits the coordinate there.

A mechanism whose driver has limits moves in one chart about either of them, and changes between
them (`analytic.free.limit_position`); a driver that turns fully has its angle alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from analytic.change_points.sign import Rates
from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS, EXACT_ANGLE, STEADY, AngleError, Real
from analytic.free.limit_position import LimitPosition
from analytic.kinematics import solve_driven
from analytic.prepared import Prepared, prepared, ranges
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.driver import Released

BEYOND = (1e-9, 1e-6, 1e-4, 1e-2)
"""Distances beyond a limit at which the open dyad is looked for [rad]."""


@dataclass(frozen=True, eq=False)
class LimitedScene:
    """Scene in one assembly; ``limits`` of its driver's range, the lower one first, or none."""

    scene: Scene
    limits: tuple[LimitPosition, LimitPosition] | None

    @staticmethod
    def of(scene: Scene, driver_rad: float) -> LimitedScene:
        """Return the arc that holds a driver angle. Raises CrankcheckError where the mechanism
        cannot be assembled there, or its way ends at infinity."""
        ready = prepared(scene)
        span = _range_about(ready.reach, driver_rad)
        if span is None:
            ready.chunk(np.array([driver_rad]), 0.0, 0.0, None)  # says where it is open
            raise CrankcheckError(f"{scene.name}: no range of its driver holds {driver_rad:g} rad")
        low, high = span
        if ready.reach == [(-math.pi, math.pi)] or (
            ready.looked_turns == 1 and high - low >= math.tau
        ):
            return LimitedScene(scene, None)
        return LimitedScene(scene, (_limit(scene, span, -1), _limit(scene, span, 1)))

    @property
    def length_rad(self) -> float:
        """Length of the driver's range."""
        assert self.limits is not None
        low, high = self.limits
        return high.driver_rad - low.driver_rad

    def nearest(self, driver_rad: float) -> LimitPosition | None:
        """Return the limit that is nearest to a driver angle."""
        if self.limits is None:
            return None
        return min(self.limits, key=lambda limit: abs(limit.driver_rad - driver_rad))

    def beyond(self, limit: LimitPosition) -> LimitedScene:
        """Return the arc of the other assembly, into which the motion passes at one of the limits.
        Raises CrankcheckError where change points make it unclear."""
        scene = self.scene
        if ready := prepared(scene).passages:
            raise CrankcheckError(
                f"{scene.name}: {scene.driver.link} passes a limit, at "
                f"{math.degrees(limit.driver_rad):.6g} deg, in a mechanism that has change points "
                f"too (of {', '.join(ready)}); only one of them is followed: change a length"
            )
        branch = {**scene.branch, limit.dyad: -scene.branch.get(limit.dyad, 1)}
        law = scene.driver.law
        assert isinstance(law, Released)

        def started(start_rad: float) -> Scene:
            driver = replace(scene.driver, law=replace(law, start_rad=start_rad))
            return replace(scene, branch=branch, driver=driver)

        span = _range_about(ranges(prepared(started(limit.driver_rad)).stretched), limit.driver_rad)
        assert span is not None
        return LimitedScene.of(started(0.5 * sum(span)), 0.5 * sum(span))

    def link_angles(self, driver_rad: float) -> Mapping[str, float]:
        """Return the angles of all links at a driver angle, whole turns as `analytic.kinematics`
        counts them for this scene."""
        still = np.zeros(1)
        found = solve_driven(
            self.scene, np.array([driver_rad]), still, still, points=(), sliders=(), bound=False
        )
        return {name: float(link.theta[0]) for name, link in found.links.items()}


def _range_about(spans: list[tuple[float, float]], driver_rad: float) -> tuple[float, float] | None:
    """Return the range that holds an angle, but for rounding, moved by whole turns to it."""
    room = 1e-9
    for low, high in spans:
        turns = math.tau * math.ceil((driver_rad - high - room) / math.tau)
        if low + turns - room <= driver_rad:
            return low + turns, high + turns
    return None


def _limit(scene: Scene, span: tuple[float, float], side: int) -> LimitPosition:
    """Return the limit at one end of a range. Raises CrankcheckError where no dyad is stretched or
    folded there."""
    ready, driver_rad = prepared(scene), span[1] if side > 0 else span[0]
    beyond = driver_rad + side * np.array(BEYOND)
    shortages = ready.stretched(beyond).shortage
    at_limit = ready.stretched(np.array([driver_rad]))
    open_ = [key for key, value in shortages.items() if _is_open(value)]
    for key in open_[:1]:  # what hangs on it is open with it
        closure = at_limit.closures.get(key)
        if closure is not None and closure.root is not None:
            exact = _zero_of_root(ready, key, driver_rad, -side * 1e-3 * (span[1] - span[0]))
            return LimitPosition(scene, exact, side, key, span[1] - span[0])
    raise CrankcheckError(
        f"{scene.name}: the range of {scene.driver.link} ends at {math.degrees(driver_rad):.6g} "
        "deg, where no dyad is stretched or folded: its free motion is not followed there"
    )


def _zero_of_root(ready: Prepared, key: str, driver_rad: float, inwards_rad: float) -> float:
    """Return the driver angle at which the square of a dyad's root is 0, to rounding: a range ends
    where the dyad is open by more than that."""

    def square(theta: float) -> float:
        values = np.asarray(ready.stretched(np.array([theta])).closures[key].square)
        return float(values.ravel()[0])

    slope = (square(driver_rad + inwards_rad) - square(driver_rad)) / inwards_rad
    for _ in range(5):
        driver_rad -= square(driver_rad) / slope
    return driver_rad


def _is_open(short: Array) -> bool:
    """True if a dyad is open at once beyond a limit."""
    values = np.broadcast_to(np.asarray(short), (len(BEYOND),))
    return bool(np.all(np.nan_to_num(values[1:], nan=1.0) > 0.0))


HOP = 0.6
"""Share of a range over which the chart of one of its limits is used."""


@dataclass(frozen=True, eq=False)
class Chart:
    """Coordinate u along the motion: the driver's angle, or that about ``limit`` of ``arc``.

    ``ahead`` is the lead of link angles over the arc's scene [rad] from the motion so far.
    """

    arc: LimitedScene
    limit: LimitPosition | None
    ahead: Mapping[str, float] = field(default_factory=dict)

    @staticmethod
    def at(arc: LimitedScene, driver_rad: float, ahead: Mapping[str, float]) -> Chart:
        """Return the best chart at a driver angle."""
        return Chart(arc, arc.nearest(driver_rad), ahead)

    @cached_property
    def other(self) -> tuple[LimitedScene, Mapping[str, float]]:
        """The arc where u < 0, and the lead of link angles there."""
        assert self.limit is not None
        arc, at = self.arc.beyond(self.limit), self.limit.driver_rad
        here, there = self.arc.link_angles(at), arc.link_angles(at)
        return arc, {
            name: self.ahead.get(name, 0.0)
            + math.tau * round((here[name] - there[name]) / math.tau)
            for name in here
        }

    def driver(self, u: Array) -> tuple[Array, Array, Array]:
        """Return the driver's angle with its first two derivatives by u."""
        if self.limit is None:
            return u, np.ones_like(u), np.zeros_like(u)
        side = self.limit.side
        phi = self.limit.driver_rad - side * u * u
        return phi, -2.0 * side * u, np.full_like(u, -2.0 * side)

    def state(self, driver_rad: float, omega: float) -> tuple[float, float]:
        """Return u and its rate in the arc itself, at a driver angle with a rate [rad/s].

        At the limit itself the driver has no rate, and u is taken as at rest.
        """
        if self.limit is None:
            return driver_rad, omega
        u = self.limit.coordinate(driver_rad)
        return u, -omega / (2.0 * self.limit.side * u) if u > 0.0 else 0.0

    def left(self, u: float) -> LimitedScene | None:
        """Return the arc on which to take another chart, where u is far from the limit."""
        if self.limit is None:
            return None
        arc = self.arc if u >= 0.0 else self.other[0]
        return arc if u * u > HOP * arc.length_rad else None

    def next(self, u: float, v: float) -> tuple[Chart, float, float]:
        """Return the chart of the other limit, with u and its rate in it."""
        assert self.limit is not None
        arc, ahead = (self.arc, self.ahead) if u >= 0.0 else self.other
        phi, first, _ = self.driver(np.array([u]))
        chart = Chart.at(arc, float(phi[0]), ahead)
        return chart, *chart.state(float(phi[0]), float(first[0]) * v)

    def unit(self, u: Array) -> Chunk:
        """Return the mechanism at coordinates (T,), per unit of their rate. Raises ReachError."""
        return self.chunk(u, 1.0, STEADY)

    def chunk(self, u: Array, v: Real, a: Real, error: AngleError | None = None) -> Chunk:
        """Return the mechanism at coordinates u (T,) with rates, certified where their ``error`` is
        given. Raises ReachError."""
        if self.limit is None:
            if error is not None:
                error = AngleError(error.theta + EPS * np.abs(u), error.omega, error.alpha)
            return prepared(self.arc.scene).chunk(u, v, a, error)
        rates = Rates(v, a, error or EXACT_ANGLE)
        return self.limit.chunk(u, rates, bound=error is not None)
