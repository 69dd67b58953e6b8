"""The true mechanism in the positions of a run, whatever time it has them at.

Away from a limit of the driver its logged angle says where the mechanism is, but for the assembly,
which the other bodies tell. Near a limit the angle says little: there the body that moves most is
what the coordinate is taken from.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from analytic.change_points.smooth import Index
from analytic.dyads.plane import STEADY
from analytic.free.chart import Chart
from analytic.free.coordinate_history import CoordinateHistory
from analytic.free.limit_position import REACH
from analytic.free.motion_along import reordered
from analytic.kinematics import solve_driven
from analytic.prepared import prepared
from analytic.result import MotionArrays, Selection
from models.array import Array
from models.motion import Motion
from models.scene import Scene

NEAR = 0.3
"""The coordinate about a limit [rad^0.5] within which the driver's angle is not asked."""
ROUNDS = 8
"""Of Gauss' and Newton's method for the coordinate."""


def places_beside(scene: Scene, history: CoordinateHistory, logged: Motion) -> Motion:
    """The positions of the reference, without rates and bounds, beside a run (T,)."""
    theta = logged.links[scene.driver.link].theta
    still = np.zeros_like(theta)
    if history.windows[0].chart.limit is None:
        return solve_driven(scene, theta, still, still, logged.time_s, bound=False)
    charts = _charts(history)
    chosen, coordinate = np.zeros(len(theta), dtype=np.intp), np.zeros_like(theta)
    least = np.full(len(theta), np.inf)
    for k, chart in enumerate(charts):
        for side in (1.0, -1.0):
            u, off = _fitted(scene, chart, side, theta, logged)
            better = off < least
            least[better], chosen[better], coordinate[better] = off[better], k, u[better]
    return _positions(scene, charts, chosen, coordinate, logged)


def _charts(history: CoordinateHistory) -> list[Chart]:
    """The charts of a motion, each once, however often it comes back to it."""
    charts: dict[tuple[float, tuple[tuple[str, int], ...]], Chart] = {}
    for chart, _, _ in history.legs():
        assert chart.limit is not None
        branch = tuple(sorted(chart.arc.scene.branch.items()))
        charts.setdefault((chart.limit.driver_rad, branch), chart)
    return list(charts.values())


def _fitted(
    scene: Scene, chart: Chart, side: float, theta: Array, logged: Motion
) -> tuple[Array, Array]:
    """The coordinates on one side of a limit that are next to a run, and how far the points are
    from there [m], (T,); infinity where the driver is out of the range."""
    limit = chart.limit
    assert limit is not None
    most = np.sqrt(REACH * limit.length_rad)
    before = np.nan_to_num(limit.side * (limit.driver_rad - theta), nan=np.inf)
    inside = before <= most**2
    u = side * np.sqrt(np.clip(before, 0.0, most**2))
    near = np.flatnonzero(np.abs(u) < NEAR)
    for _ in range(ROUNDS if near.size else 0):
        way, slope = _off(scene, chart, u[near], logged, near)
        step = (way * slope).sum(axis=(0, 1)) / (slope * slope).sum(axis=(0, 1))
        u[near] = np.clip(u[near] - np.nan_to_num(step), -most, most)
    way, _ = _off(scene, chart, u, logged, np.arange(len(u)))
    off = np.nan_to_num(np.abs(way).max(axis=(0, 1)), nan=np.inf)
    return u, np.where(inside, off, np.inf)


def _off(scene: Scene, chart: Chart, u: Array, logged: Motion, index: Index) -> tuple[Array, Array]:
    """How far the points of the mechanism are from those of a run [m], and their rates by u,
    (2, points, T) each."""
    unit = chart.unit(u)
    way, slope = [], []
    for name, body in Selection.of(scene, (), None, ()).points.items():
        if name in logged.points:
            at, place = unit.point(body, name), logged.points[name].position[index]
            way.append([at.p.x - place[:, 0], at.p.y - place[:, 1]])
            slope.append([at.v.x + 0.0 * u, at.v.y + 0.0 * u])
    return np.array(way).swapaxes(0, 1), np.array(slope).swapaxes(0, 1)


def _positions(
    scene: Scene, charts: list[Chart], chosen: Index, u: Array, logged: Motion
) -> Motion:
    """The mechanism at coordinates of charts, link angles with the whole turns of the run."""
    order = np.argsort(chosen, kind="stable")
    wanted = Selection.of(scene, None, None, None)
    result = MotionArrays(wanted, logged.time_s[order], prepared(scene).steps, bound=False)
    for k, chart in enumerate(charts):
        begin, end = np.searchsorted(chosen[order], [k, k + 1])
        if begin < end:
            span = slice(int(begin), int(end))
            chunk = chart.chunk(u[order[span]], 0.0, STEADY)
            result.write(span, chunk, _LoggedTurns(logged, order[span]))
    return reordered(result.motion(), np.argsort(order))


@dataclass(frozen=True)
class _LoggedTurns:
    """Counts whole turns as a run did, at its samples ``index``."""

    logged: Motion
    index: Index

    def count(self, name: str, angle: Array) -> None:
        """Add the whole turns by which the run is ahead."""
        angle += math.tau * np.round((self.logged.links[name].theta[self.index] - angle) / math.tau)
