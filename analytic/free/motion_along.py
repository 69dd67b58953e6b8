"""Places of all bodies along an integrated motion, by the closed forms, with bounds.

Away from a limit of the driver its logged angle determines the position, but for the assembly,
which the other bodies show. Near a limit the angle says little: there the coordinate is fitted to
the body that moves most.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.change_points.find import passed
from analytic.change_points.sign import Index
from analytic.change_points.turns import Counter
from analytic.dyads.plane import STEADY, AngleError
from analytic.free.chart import Chart
from analytic.free.coordinate_history import CoordinateHistory, Doubt
from analytic.free.limit_position import REACH
from analytic.kinematics import solve_driven
from analytic.prepared import CHUNK, prepared
from analytic.result import MotionArrays, Selection
from models.array import Array
from models.motion import Bound, Crossing, Motion
from models.scene import Scene


def motion_along(
    scene: Scene, history: CoordinateHistory, doubt: Doubt | None, time_s: Array
) -> Motion:
    """Return the motion of a scene at times [s], (T,), in any order; certified where the ``doubt``
    of its coordinate is given."""
    order = np.argsort(time_s, kind="stable")
    ordered = time_s[order]
    state = history.state(ordered)
    errors = None if doubt is None else doubt.at(ordered)
    wanted = Selection.of(scene, None, None, None)
    result = MotionArrays(wanted, ordered, prepared(scene).steps, bound=doubt is not None)
    window, crossings = history.windows_at(ordered), dict[Crossing, None]()
    for chart, first, last in history.legs():
        begin, end = np.searchsorted(window, [first, last])
        for at in range(begin, end, CHUNK):
            span = slice(at, min(at + CHUNK, end))
            u, v, a = (row[span] for row in state)
            error = None if errors is None else AngleError(*(row[span] for row in errors))
            chunk = chart.chunk(u, v, a, error)
            result.write(span, chunk, LegCounter(chart, u, chunk.theta))
        if begin < end:
            start = history.windows[first].u @ (-1.0) ** np.arange(len(history.windows[first].u))
            driver = chart.driver(np.append(state[0][begin:end], start))[0]
            found = passed(prepared(chart.arc.scene).passages, driver.min(), driver.max())
            crossings.update(dict.fromkeys(found))
    motion = replace(result.motion(), crossings=tuple(crossings))
    return motion if (order[1:] > order[:-1]).all() else reordered(motion, np.argsort(order))


@dataclass(frozen=True)
class LegCounter:
    """Counter of the turns of links at coordinates ``u`` (T,) of a chart, driver at ``theta``."""

    chart: Chart
    u: Array
    theta: Array

    def count(self, name: str, angle: Array) -> None:
        """Add the missing whole turns to angles of a link [rad], (T,)."""
        chart = self.chart
        if chart.limit is None:
            Counter(prepared(chart.arc.scene).turns, self.theta).count(name, angle)
            return
        for side in (self.u >= 0.0, self.u < 0.0):
            if not side.any():
                continue
            arc, ahead = (chart.arc, chart.ahead) if self.u[side][0] >= 0.0 else chart.other
            angles = angle[side]
            Counter(prepared(arc.scene).turns, self.theta[side]).count(name, angles)
            angle[side] = angles + ahead.get(name, 0.0)


def reordered(motion: Motion, order: Index) -> Motion:
    """Return the samples of a motion in another order."""

    def change(series: Array) -> Array:
        return np.asarray(series[order])

    bound = motion.bound
    if bound is not None:
        whole = Motion(motion.time_s, bound.links, bound.points, bound.sliders).each_series(change)
        bound = Bound(whole.links, whole.points, whole.sliders)
    sines = {name: change(sine) for name, sine in motion.conditioning.items()}
    return replace(
        motion.each_series(change), time_s=change(motion.time_s), conditioning=sines, bound=bound
    )


NEAR = 0.3
"""Coordinate about a limit [rad^0.5] within which the driver's angle is not used."""
ROUNDS = 8
"""Rounds of Gauss' and Newton's method for the coordinate."""


def places_beside(scene: Scene, history: CoordinateHistory, logged: Motion) -> Motion:
    """Return the positions of the reference, without rates and bounds, beside a run (T,)."""
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
    charts: dict[tuple[float, tuple[tuple[str, int], ...]], Chart] = {}
    for chart, _, _ in history.legs():
        assert chart.limit is not None
        branch = tuple(sorted(chart.arc.scene.branch.items()))
        charts.setdefault((chart.limit.driver_rad, branch), chart)
    return list(charts.values())


def _fitted(
    scene: Scene, chart: Chart, side: float, theta: Array, logged: Motion
) -> tuple[Array, Array]:
    """Return the coordinates on one side of a limit that are next to a run, and the distances of
    the points from there [m], (T,); infinity where the driver is out of the range."""
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
    off = np.maximum(off, scene.longest_m * _turned(chart, u, logged))
    return u, np.where(inside, off, np.inf)


def _off(scene: Scene, chart: Chart, u: Array, logged: Motion, index: Index) -> tuple[Array, Array]:
    """Return the vectors from the points of a run to those of the mechanism [m], and their rates by
    u, (2, points, T) each."""
    unit = chart.unit(u)
    way, slope = [], []
    for name, body in Selection.of(scene, (), None, ()).points.items():
        if name in logged.points:
            at, place = unit.point(body, name), logged.points[name].position[index]
            way.append([at.p.x - place[:, 0], at.p.y - place[:, 1]])
            slope.append([at.v.x + 0.0 * u, at.v.y + 0.0 * u])
    return np.array(way).swapaxes(0, 1), np.array(slope).swapaxes(0, 1)


def _turned(chart: Chart, u: Array, logged: Motion) -> Array:
    """Return the largest rotation of a link against that of a run, (T,): a link that swings about a
    fixed point and guides a block may have all its named points at rest in both assemblies."""
    unit, most = chart.unit(u), np.zeros_like(u)
    for name, link in logged.links.items():
        turn = unit.bodies[name].unit(0.0)
        apart = np.hypot(turn.x - np.cos(link.theta), turn.y - np.sin(link.theta))
        most = np.maximum(most, np.nan_to_num(apart, nan=np.inf))
    return most


def _positions(
    scene: Scene, charts: list[Chart], chosen: Index, u: Array, logged: Motion
) -> Motion:
    """Return the mechanism at coordinates of charts, with the whole turns of the run."""
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
    """Counter of whole turns as in a run, at its samples ``index``."""

    logged: Motion
    index: Index

    def count(self, name: str, angle: Array) -> None:
        """Add the whole turns by which the run is ahead."""
        angle += math.tau * np.round((self.logged.links[name].theta[self.index] - angle) / math.tau)
