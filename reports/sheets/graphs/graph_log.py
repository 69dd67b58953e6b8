"""What a log says of a quantity and its rates, at any place of a graph."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.drawings.graphical import ORDERS, Order, Plotted
from models.array import Array
from models.errors import CrankcheckError, cut
from reports.logs.channel import OwnLog, Reading
from reports.logs.columns import read_columns
from reports.logs.map_file import Map, read_map
from reports.logs.meanings import understood, wanted
from reports.sheets.graphs.graph_range import Range

BESIDE = 4
"""Rows on both sides of the period that the spline goes through as well."""
SAME_ROW = 1e-6
"""How near, in rows, a place is to a row to be on it."""
ANOTHER = 0.1
"""The share of its range that half of all readings of a scene are off by at most."""
NAMES: Mapping[Order, str] = {0: "places", 1: "rates", 2: "accelerations"}


@dataclass(frozen=True)
class LoggedRows:
    """Rows of a reading in the period: instants [s] and values (T,), angles without turns lost."""

    column: str
    time_s: Array
    values: Array


@dataclass(frozen=True)
class GraphLog:
    """A log's readings of a quantity by their order; ``range`` is the period that is drawn."""

    source: Path
    range: Range
    rows: Mapping[Order, LoggedRows]

    @property
    def name(self) -> str:
        """What sheets call it."""
        return self.source.stem

    def at(self, order: Order, x: Array) -> Array:
        """A reading at places of the range, by the cubic spline through its rows."""
        rows = self.rows[order]
        return np.asarray(CubicSpline(rows.time_s, rows.values)(x))

    def at_divisions(self, order: Order, parts: int) -> Plotted:
        """Readings of an order at those divisions that its rows reach; none of what it has not."""
        x = self.range.divisions(parts)
        if order not in self.rows:
            return Plotted(x[:0], x[:0])
        rows = self.rows[order].time_s
        slack = SAME_ROW * float(np.median(np.diff(rows)))
        x = x[(x >= rows[0] - slack) & (x <= rows[-1] + slack)]
        return Plotted(x, self.at(order, x))

    def how(self, order: Order, x: Array) -> str:
        """How readings at places come of the rows, and what that adds: what the spline through the
        exact values at the rows is off by."""
        rows = self.rows[order].time_s
        step = float(np.median(np.diff(rows)))
        after = np.clip(np.searchsorted(rows, x), 1, rows.size - 1)
        nearest = np.minimum(np.abs(rows[after] - x), np.abs(rows[after - 1] - x))
        if np.all(nearest <= SAME_ROW * step):
            return "at its rows"
        exact = CubicSpline(rows, self.range.exact(order, rows))(x)
        off = float(np.abs(exact - self.range.exact(order, x)).max()) / self.range.sizes()[order]
        return (
            f"by cubic splines between its rows, {step:.3g} s apart, which add up to "
            f"{100 * off:.2g} %"
        )


def graph_log(path: Path, map_path: Path | None, whole: Range) -> GraphLog:
    """The readings that a log has of the quantity of a range, over a period of it.

    The period is the first whole one that the log covers, or, where it covers none, the one that
    begins with its first row; what is let go is drawn from its start on.

    Raises
    ------
    CrankcheckError
        A log that can not be read or has nothing of the quantity; one that is shorter than the
        period; one whose readings are not those of the scene.
    """
    if whole.scene.elastic:
        raise CrankcheckError(
            f"--log: links of {whole.scene.name} bend, and graphs are those of rigid ones; "
            "`crankcheck judge` holds the log to the elastic motion"
        )
    if whole.truth is None:
        raise CrankcheckError(
            f"--log: the driver of {whole.scene.name} has no constant speed, and graphs over its "
            "angle are analogues, which no log has; use --over time"
        )
    map_ = read_map(map_path) if map_path else Map()
    columns = read_columns(path, map_.layout, wanted(whole.scene, map_))
    log = understood(columns, whole.scene, map_)
    held = {order: each for order in ORDERS if (each := _reading(log, whole, order)) is not None}
    if not held:
        names = ", ".join(dict.fromkeys(each.channel.of for each in log.readings))
        raise CrankcheckError(
            f"{path}: no column is of {whole.quantity.name}; it has readings of {cut(names, 200)}"
        )
    first = held[min(held)]
    moved = _first_period(first, whole)
    _refuse_short(path, first, moved)
    rows = {
        order: some
        for order, reading in held.items()
        if (some := _rows(reading, moved)) is not None
    }
    return GraphLog(path, moved, rows)


def needed(log: GraphLog, order: Order, parts: int, x: Array) -> None:
    """Refuse what can not be drawn of a log: readings of an order that it has not, fewer rows than
    parts, or readings of another motion. Raises CrankcheckError."""
    quantity = log.range.quantity
    if order not in log.rows:
        other = "chords or tangents" if order else "integration"
        raise CrankcheckError(
            f"{log.source}: it has no {NAMES[order]} of {quantity.name} (found "
            f"{', '.join(NAMES[each] for each in log.rows)}); log them, or draw --by {other}"
        )
    rows = log.rows[order].time_s
    slack = SAME_ROW * (log.range.end - log.range.start)
    within = (rows >= log.range.start - slack) & (rows <= log.range.end + slack)
    count = int(np.sum(within))
    if count < parts:
        raise CrankcheckError(
            f"--divisions {parts}: {log.source} has {count} rows in the period; draw fewer parts, "
            "or log more often"
        )
    _refuse_another(log, order, x)


def _reading(log: OwnLog, whole: Range, order: Order) -> Reading | None:
    """The reading of an order, rather one that is not relative to another link."""
    kind, body = whole.quantity.kinds[order], whole.quantity.body
    of_it = [r for r in log.readings if (r.channel.kind, r.channel.of) == (kind, body)]
    return min(of_it, key=lambda each: bool(each.channel.relative_to), default=None)


def _first_period(reading: Reading, whole: Range) -> Range:
    """The first period of those of the driver within the rows, or that from the first row on."""
    first, last = (float(reading.instants[at]) for at in (0, -1))
    lasts = whole.end - whole.start
    if first <= whole.start or whole.scene.is_free:
        return whole
    start = math.ceil(first / lasts - SAME_ROW) * lasts
    return whole.moved(start if start + lasts <= last * (1.0 + SAME_ROW) else first)


def _refuse_short(path: Path, reading: Reading, moved: Range) -> None:
    """Refuse a log that begins after the period, or ends before it. Raises CrankcheckError."""
    start, end = (float(reading.instants[at]) for at in (0, -1))
    lasts = moved.end - moved.start
    if start > moved.start + SAME_ROW * lasts or end < moved.end - SAME_ROW * lasts:
        raise CrankcheckError(
            f"{path}: readings of {moved.quantity.name} from {start:.6g} s to {end:.6g} s; a "
            f"graph takes those from {moved.start:.6g} s to {moved.end:.6g} s: log {lasts:.6g} s "
            "or more"
        )


def _rows(reading: Reading, moved: Range) -> LoggedRows | None:
    """The rows of a reading in the period and next to it; None for too few."""
    first = max(int(np.searchsorted(reading.instants, moved.start)) - BESIDE, 0)
    last = int(np.searchsorted(reading.instants, moved.end)) + BESIDE
    some = replace(
        reading, instants=reading.instants[first:last], values=reading.values[first:last]
    )
    if some.instants.size < BESIDE:
        return None
    assert moved.truth is not None
    kind, body = reading.channel.kind, reading.channel.of
    right = kind.of(moved.truth.at(some.instants), body)
    return LoggedRows(reading.channel.column, some.instants, right + some.error(moved.truth))


def _refuse_another(log: GraphLog, order: Order, x: Array) -> None:
    """Refuse readings that are mostly far from the scene's. Raises CrankcheckError."""
    exact = log.range.exact(order, x)
    off = np.abs(log.at(order, x) - exact)
    size = log.range.sizes()[order]
    share = float(np.median(off)) / size
    if share > ANOTHER:
        raise CrankcheckError(
            f"{log.source}, column {cut(log.rows[order].column)!r}: half of the readings are off "
            f"by {100 * share:.2g} % of the range or more: they are of another mechanism, speed, "
            f"start or unit than {log.range.scene.name}; `crankcheck judge` helps to find which"
        )
