"""The places of all bodies along an integrated motion, by the closed forms, with bounds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from analytic.change_points.find import passed
from analytic.change_points.smooth import Index
from analytic.dyads.plane import AngleError
from analytic.free.chart import Chart
from analytic.free.coordinate_history import CoordinateHistory
from analytic.free.doubt import Doubt
from analytic.prepared import CHUNK, prepared
from analytic.result import MotionArrays, Selection
from analytic.turns.count import Counter
from models.array import Array
from models.motion import Bound, Crossing, Motion
from models.scene import Scene


def motion_along(
    scene: Scene, history: CoordinateHistory, doubt: Doubt | None, time_s: Array
) -> Motion:
    """The motion of a scene at times [s], (T,), in any order; certified where the doubt is given
    that there is about its coordinate."""
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
    """Counts the turns of links at coordinates ``u`` (T,) of a chart, driver at ``theta``."""

    chart: Chart
    u: Array
    theta: Array

    def count(self, name: str, angle: Array) -> None:
        """Add the whole turns that angles of a link [rad], (T,), are short of."""
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
    """The samples of a motion in another order."""

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
