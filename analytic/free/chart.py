"""What the motion is integrated over: the driver's angle, or near its limits the coordinate there.

A mechanism whose driver has limits moves in one chart about either of them, and changes from one to
the other in between (`analytic.free.limit_position`); one whose driver turns fully has its angle
alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from analytic.change_points.smooth import Rates
from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS, EXACT_ANGLE, STEADY, AngleError, Real
from analytic.free.arc import Arc
from analytic.free.limit_position import LimitPosition
from analytic.prepared import prepared
from models.array import Array

HOP = 0.6
"""The share of a range that the chart of one of its limits is used over."""


@dataclass(frozen=True, eq=False)
class Chart:
    """A coordinate u along the motion: the driver's angle, or that about ``limit`` of ``arc``.

    ``ahead`` is what link angles are ahead of those of the arc's scene [rad] by the way that the
    motion came.
    """

    arc: Arc
    limit: LimitPosition | None
    ahead: Mapping[str, float] = field(default_factory=dict)

    @staticmethod
    def at(arc: Arc, driver_rad: float, ahead: Mapping[str, float]) -> Chart:
        """The chart that is best at a driver angle."""
        return Chart(arc, arc.nearest(driver_rad), ahead)

    @cached_property
    def other(self) -> tuple[Arc, Mapping[str, float]]:
        """The arc where u < 0, and what link angles are ahead there."""
        assert self.limit is not None
        arc, at = self.arc.beyond(self.limit), self.limit.driver_rad
        here, there = self.arc.link_angles(at), arc.link_angles(at)
        return arc, {
            name: self.ahead.get(name, 0.0)
            + math.tau * round((here[name] - there[name]) / math.tau)
            for name in here
        }

    def driver(self, u: Array) -> tuple[Array, Array, Array]:
        """The driver's angle with its first two derivatives by u."""
        if self.limit is None:
            return u, np.ones_like(u), np.zeros_like(u)
        side = self.limit.side
        phi = self.limit.driver_rad - side * u * u
        return phi, -2.0 * side * u, np.full_like(u, -2.0 * side)

    def state(self, driver_rad: float, omega: float) -> tuple[float, float]:
        """u and its rate in the arc itself, at a driver angle with a rate [rad/s].

        At the limit itself the driver has no rate, and u is taken as at rest.
        """
        if self.limit is None:
            return driver_rad, omega
        u = self.limit.coordinate(driver_rad)
        return u, -omega / (2.0 * self.limit.side * u) if u > 0.0 else 0.0

    def left(self, u: float) -> Arc | None:
        """The arc on which to take another chart, where u is far from the limit."""
        if self.limit is None:
            return None
        arc = self.arc if u >= 0.0 else self.other[0]
        return arc if u * u > HOP * arc.length_rad else None

    def next(self, u: float, v: float) -> tuple[Chart, float, float]:
        """The chart of the other limit, with u and its rate in it."""
        assert self.limit is not None
        arc, ahead = (self.arc, self.ahead) if u >= 0.0 else self.other
        phi, first, _ = self.driver(np.array([u]))
        chart = Chart.at(arc, float(phi[0]), ahead)
        return chart, *chart.state(float(phi[0]), float(first[0]) * v)

    def unit(self, u: Array) -> Chunk:
        """The mechanism at coordinates (T,), per unit of their rate. Raises ReachError."""
        return self.chunk(u, 1.0, STEADY)

    def chunk(self, u: Array, v: Real, a: Real, error: AngleError | None = None) -> Chunk:
        """The mechanism at coordinates u (T,) with rates, certified where it is given what these
        may be wrong by. Raises ReachError."""
        if self.limit is None:
            if error is not None:
                error = AngleError(error.theta + EPS * np.abs(u), error.omega, error.alpha)
            return prepared(self.arc.scene).chunk(u, v, a, error)
        rates = Rates(v, a, error or EXACT_ANGLE)
        return self.limit.chunk(u, rates, bound=error is not None)
