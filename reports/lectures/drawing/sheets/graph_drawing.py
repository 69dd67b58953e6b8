"""Three graphs drawn from the reference and, beside them, from a log, with the errors of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.drawings.graphical import ORDERS, Method, Plotted, ThreeGraphs, three_graphs
from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.motion import Order
from models.scene import Scene
from reports.compare.compare import Truth
from reports.lectures.drawing.sheets.graph_span import ON_END, GraphSpan
from reports.logs.channel import OwnLog, Reading
from reports.logs.columns import read_columns
from reports.logs.map_file import Map, read_map
from reports.logs.meanings import understood, wanted
from reports.output.numbers import count
from reports.own_log.log_limits import LogRequest, log_kind

LOGGED = "#8e24aa"
"""The colour of everything logged."""
ELSEWHERE = 0.1
"""Largest error of a log of the scene at its start: in radians, or longest links; of rates at the
driver's largest speed."""


@dataclass(frozen=True)
class SheetLog:
    """A log of a scene, and its reference, which is known as long as the log is."""

    log: OwnLog
    truth: Truth
    driver_rad: Callable[[Array], Array]
    """The driver's angle at times [rad], by its law or its free motion."""

    @staticmethod
    def of_file(scene: Scene, path: Path, map_: Map, drawing: str) -> SheetLog:
        """Read a file for a ``drawing``, named in the plural.

        Raises
        ------
        CrankcheckError
            A scene whose links bend; a file that can not be read, or has nothing of the scene; a
            log of another motion.
        """
        if scene.elastic:
            raise CrankcheckError(
                f"--log {path}: {few(scene.elastic, 4)} of {scene.name} bends or stretches, and "
                f"{drawing} are those of rigid links; `crankcheck judge` compares such a log "
                "with the beam"
            )
        columns = read_columns(path, map_.file, wanted(scene, map_))
        return SheetLog.of_log(understood(columns, scene, map_))

    @staticmethod
    def of_log(log: OwnLog) -> SheetLog:
        """Take a log that was read. Raises CrankcheckError for one without times, and for another
        motion, too."""
        if not log.timed:
            raise CrankcheckError(
                f"{log.source}: no column of times, which a drawing over time needs; add one, "
                "such as time_s"
            )
        if log.scene.is_free:
            known, truth, _ = log_kind(log.scene).truth(log, LogRequest())
            link = log.scene.driver.link
            found = SheetLog(known, truth, lambda time_s: truth.at(time_s).links[link].theta)
        else:
            law = log.scene.driver.law
            found = SheetLog(log, Truth(log.scene, bound=False), lambda time_s: law.at(time_s)[0])
        found.refuse_another()
        return found

    def refuse_another(self) -> None:
        """Refuse a log that does not begin as its scene moves: an engine begins there, however far
        it departs later. Places decide, or, without places, rates; an engine's first accelerations
        are its own affair. Raises CrankcheckError."""
        order = min((each.channel.kind.order for each in self.log.readings), default=2)
        if order == 2:
            return
        begins = [each.first(1) for each in self.log.readings if each.channel.kind.order == order]
        worst = max(begins, key=self._share)
        if not self._share(worst) <= ELSEWHERE:
            channel, scene = worst.channel, self.log.scene
            unit = ("rad" if channel.kind.body_kind == "link" else "m") + ("", "/s")[order]
            raise CrankcheckError(
                f"{self.log.source}: in its first row, t = {self.log.time_s[0]:.6g} s, "
                f"{channel.name} (column {cut(channel.column)!r}) is "
                f"{abs(float(worst.error(self.truth)[0])):.3g} {unit} from that of "
                f"{scene.name}: the log has another scene, speed, start or unit; name its "
                "scene, or count times from the start of the motion"
            )

    def _share(self, begin: Reading) -> float:
        """The error of a reading in the first row, as a pure number."""
        kind, scene = begin.channel.kind, self.truth.scene
        scale = 1.0 if kind.body_kind == "link" else scene.longest_m
        scale *= scene.pace_rad_s**kind.order
        return abs(float(begin.error(self.truth)[0])) / scale


BESIDE = 4
"""Rows on both sides of the period that the spline also passes."""
ON_ROW = 1e-6
"""Distance of a place from a row below which it is on it, in steps between rows."""
DOUBTED = 0.1
"""Error of half of all readings, as a share of their range, from which a note on it is printed."""
NAMES: Mapping[Order, str] = {0: "places", 1: "rates", 2: "accelerations"}
SIZES: Mapping[Order, str] = {0: "their range", 1: "the largest", 2: "the largest"}
"""Scales of the errors, in words."""


@dataclass(frozen=True)
class LoggedRows:
    """Rows of a reading in the period: instants [s] and values (T,), angles with all turns."""

    time_s: Array
    values: Array


@dataclass(frozen=True)
class GraphLog:
    """A log's readings of a quantity by their order; ``span`` is the drawn period."""

    source: Path
    span: GraphSpan
    rows: Mapping[Order, LoggedRows]

    @property
    def name(self) -> str:
        """The name of the log on sheets."""
        return self.source.stem

    def at(self, order: Order, x: Array) -> Array:
        """A reading at places of the range, by the cubic spline through its rows."""
        rows = self.rows[order]
        return np.asarray(CubicSpline(rows.time_s, rows.values)(x))

    def at_divisions(self, order: Order, parts: int) -> Plotted:
        """Readings of an order at the divisions that its rows reach; none without rows."""
        x = self.span.divisions(parts)
        if order not in self.rows:
            return Plotted(x[:0], x[:0])
        rows = self.rows[order].time_s
        slack = ON_ROW * float(np.median(np.diff(rows)))
        x = x[(x >= rows[0] - slack) & (x <= rows[-1] + slack)]
        return Plotted(x, self.at(order, x))

    def doubt(self, order: Order, x: Array) -> str:
        """A note that readings are mostly far from the scene's; empty where they are not."""
        off = np.abs(self.at(order, x) - self.span.exact(order, x))
        share = float(np.median(off)) / self.span.sizes()[order]
        if share <= DOUBTED:
            return ""
        what, name = self.span.quantity.name, self.span.scene.name
        return (
            f"half of its {NAMES[order]} of {what} have errors of {100 * share:.0f} % of "
            f"{SIZES[order]} or more: if no engine failed, the log has another speed or unit "
            f"than {name}; `crankcheck judge` helps to find which"
        )

    def how(self, order: Order, x: Array) -> str:
        """The source of readings at places: rows, or the spline between them, with the error that
        the spline through the exact values has."""
        rows = self.rows[order].time_s
        step = float(np.median(np.diff(rows)))
        after = np.clip(np.searchsorted(rows, x), 1, rows.size - 1)
        nearest = np.minimum(np.abs(rows[after] - x), np.abs(rows[after - 1] - x))
        if np.all(nearest <= ON_ROW * step):
            return "at its rows"
        exact = CubicSpline(rows, self.span.exact(order, rows))(x)
        off = float(np.abs(exact - self.span.exact(order, x)).max()) / self.span.sizes()[order]
        return (
            f"by cubic splines between its rows, {step:.3g} s apart, which add up to "
            f"{100 * off:.2g} %"
        )


def graph_log(path: Path, map_path: Path | None, whole: GraphSpan) -> GraphLog:
    """Read a log's readings of the quantity of a range, over a period of it.

    The period is the first whole one that the log covers, or, where it covers none, the one that
    begins with its first row; free motion is drawn from its start on.

    Raises
    ------
    CrankcheckError
        As `SheetLog.of_file`; a log without the quantity, or shorter than the period; graphs of
        analogues.
    """
    if whole.truth is None:
        raise CrankcheckError(
            f"--log: the driver of {whole.scene.name} has no constant speed, and graphs over its "
            "angle are analogues, which no log has; use --over time"
        )
    map_ = read_map(map_path) if map_path else Map()
    beside = SheetLog.of_file(whole.scene, path, map_, "graphs")
    log = beside.log
    held = {order: each for order in ORDERS if (each := _reading(log, whole, order)) is not None}
    if not held:
        names = ", ".join(dict.fromkeys(each.channel.of for each in log.readings))
        raise CrankcheckError(
            f"{path}: no column gives {whole.quantity.name}; it has readings of {cut(names, 200)}"
        )
    first = held[min(held)]
    moved = whole.within(*(float(first.instants[at]) for at in (0, -1)))
    _refuse_short(path, first, moved)
    rows = {
        order: some
        for order, reading in held.items()
        if (some := _rows(reading, beside.truth, moved)) is not None
    }
    return GraphLog(path, moved, rows)


def needed(log: GraphLog, order: Order, parts: int) -> None:
    """Refuse a drawing for which a log lacks readings of an order, or has fewer rows than parts.
    Raises CrankcheckError."""
    quantity = log.span.quantity
    if order not in log.rows:
        others = {0: "chords or tangents", 2: "integration"}
        able = [f"draw --by {others[each]}" for each in log.rows if each in others]
        held = ", ".join(NAMES[each] for each in log.rows) or f"fewer than {BESIDE} rows of it"
        raise CrankcheckError(
            f"{log.source}: it has no {NAMES[order]} of {quantity.name} (found {held}); "
            f"{', or '.join([f'log {NAMES[order]}', *able])}"
        )
    rows = log.rows[order].time_s
    slack = ON_END * (log.span.end - log.span.start)
    within = (rows >= log.span.start - slack) & (rows <= log.span.end + slack)
    held_rows = int(np.sum(within))
    if held_rows < parts:
        raise CrankcheckError(
            f"--divisions {parts}: {log.source} has {count(held_rows, 'row')} in the period; draw "
            "fewer parts, or log more often"
        )


def _reading(log: OwnLog, whole: GraphSpan, order: Order) -> Reading | None:
    """The reading of an order, preferably one that is not relative to another link."""
    kind, body = whole.quantity.kinds[order], whole.quantity.body
    of_it = [r for r in log.readings if (r.channel.kind, r.channel.of) == (kind, body)]
    return min(of_it, key=lambda each: bool(each.channel.relative_to), default=None)


def _refuse_short(path: Path, reading: Reading, moved: GraphSpan) -> None:
    """Refuse a log that begins after the period, or ends before it. Raises CrankcheckError."""
    start, end = (float(reading.instants[at]) for at in (0, -1))
    lasts = moved.end - moved.start
    if start > moved.start + ON_END * lasts or end < moved.end - ON_END * lasts:
        raise CrankcheckError(
            f"{path}: readings of {moved.quantity.name} from {start:.6g} s to {end:.6g} s; a "
            f"graph needs those from {moved.start:.6g} s to {moved.end:.6g} s: log {lasts:.6g} "
            "s or more"
        )


def _rows(reading: Reading, truth: Truth, moved: GraphSpan) -> LoggedRows | None:
    """The rows of a reading in the period and next to it; None for too few."""
    first = max(int(np.searchsorted(reading.instants, moved.start)) - BESIDE, 0)
    last = int(np.searchsorted(reading.instants, moved.end)) + BESIDE
    some = replace(
        reading, instants=reading.instants[first:last], values=reading.values[first:last]
    )
    if some.instants.size < BESIDE:
        return None
    right = reading.channel.kind.of(truth.at(some.instants), reading.channel.of)
    return LoggedRows(some.instants, right + some.error(truth))


READ: dict[Method, Order] = {"chords": 0, "tangents": 0, "integration": 2}
"""The order from which each method starts."""


@dataclass(frozen=True)
class DrawnGraphs:
    """A quantity and its rates over a range in equal parts, drawn ``by`` a method: of the
    reference, and of a log where there is one. ``sizes`` are the scales of the errors."""

    span: GraphSpan
    by: Method
    parts: int
    reference: ThreeGraphs
    log: GraphLog | None
    logged: ThreeGraphs | None
    sizes: tuple[float, float, float]

    @property
    def derived(self) -> tuple[Order, Order]:
        """The derived orders, in the order of drawing."""
        return (1, 0) if self.by == "integration" else (1, 2)

    def off(self, drawn: ThreeGraphs, order: Order) -> float:
        """Largest error of a graph against the exact curve, over the size."""
        graph = drawn.graphs[order]
        exact = self.span.exact(order, graph.x)
        return float(np.abs(graph.y - exact).max()) / self.sizes[order]

    def own_part(self, order: Order) -> float:
        """Largest difference of the log's graph from the reference's, over the size: both contain
        the error of the method."""
        assert self.logged is not None
        one, other = self.logged.graphs[order], self.reference.graphs[order]
        return float(np.abs(one.y - other.y).max()) / self.sizes[order]


def drawn_graphs(of: GraphSpan, by: Method, parts: int, log: GraphLog | None = None) -> DrawnGraphs:
    """Draw the graphs. Raises CrankcheckError for a log without the readings of the method."""
    x = of.divisions(parts)
    start = float(of.exact(0, x[:1])[0]), float(of.exact(1, x[:1])[0])
    reference = three_graphs(by, x, of.exact, start)
    logged = None
    if log is not None:
        needed(log, READ[by], parts)
        logged = three_graphs(by, x, log.at, start)
    return DrawnGraphs(of, by, parts, reference, log, logged, of.sizes())
