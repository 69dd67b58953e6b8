"""A judged log as flat rows: what was read as what, and how far it is off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from models.errors import cut, harmless
from reports.compare.errors import Error
from reports.judge.rows import AS_THEY_ARE
from reports.judge.tolerance import Limit
from reports.logs.channel import Reading
from reports.logs.log_beside import readings_of
from reports.logs.units import UNITS
from reports.output.numbers import error_text
from reports.own_log.judged import JudgedLog
from reports.own_log.log_limits import limit_of

LONGEST = 60
"""Characters of a column's name that are shown."""
KINDS = ("total", "start", "passage")
"""Kinds of errors that have limits."""


@dataclass(frozen=True)
class LogRow:
    """One error of a body: ``columns`` it was read from, and its ``limit`` [pure]. ``unit`` is that
    of the columns, of which one is ``per_unit`` in SI."""

    columns: tuple[str, ...]
    what: str
    error: Error
    limit: Limit
    unit: str
    per_unit: float

    @property
    def size(self) -> str:
        """The largest error in the user's own unit."""
        return f"{error_text(self.error.maximum / self.per_unit)} {self.unit}"

    @property
    def is_aside(self) -> bool:
        """Whether it is not of a whole column as it was logged."""
        return self.error.source != "reported" or self.error.kind != "total"

    @property
    def names(self) -> str:
        """The columns as they are shown, - for none."""
        return ", ".join(map(column_text, self.columns)) or "-"

    @property
    def taken(self) -> float:
        """The part of the limit that it takes; no end where it is not finite."""
        if not math.isfinite(self.error.pure):
            return math.inf
        return self.error.pure / self.limit.number

    @property
    def verdict(self) -> Literal["within", "out"]:
        return "within" if self.taken <= 1.0 else "out"


def column_text(column: str) -> str:
    """The name of a column, short, and as text that does nothing to a terminal."""
    return cut(harmless(column[:LONGEST]), LONGEST)


def log_rows(judged: JudgedLog) -> list[LogRow]:
    """Each error that is held to a limit, in the order of the quantities."""
    errors = judged.errors
    if errors is None:
        return []
    rows = []
    for error in errors.rows:
        if error.kind not in KINDS or error.tolerance not in judged.limits:
            continue
        limit = limit_of(error, judged, errors)
        read = [
            each
            for each in readings_of(judged.log, error.quantity, error.body)
            if error.source == "reported"
            and (each.channel.kind.judged_of == error.body_kind or error.body_kind == "driver")
        ]
        columns = tuple(each.channel.column for each in read)
        unit = _unit(read, error.unit)
        for gap in judged.log.gaps:
            if (error.quantity, error.body) == ("gap", gap.of):
                columns, unit = (gap.column,), (gap.unit, UNITS["length"][gap.unit])
        if judged.log.forces and (error.quantity, error.body) in judged.log.forces.columns:
            columns = judged.log.forces.columns[error.quantity, error.body]
        rows.append(LogRow(columns, _what(error), error, limit, *unit))
    return rows


def _unit(read: Sequence[Reading], otherwise: str) -> tuple[str, float]:
    """The unit of some columns, and what one is in SI; SI where they have several."""
    channels = [each.channel for each in read]
    units = {each.unit for each in channels}
    if len(units) != 1:
        return otherwise, 1.0
    first = channels[0]
    return first.unit, UNITS[first.kind.dimension][first.unit]


def _what(error: Error) -> str:
    """An error in words: quantity, body, and where it is not from a column itself, from what."""
    quantity = "angle" if error.quantity == "drive" else error.quantity
    driver = ", the driver" if error.body_kind == "driver" else ""
    differenced = ", differenced" if error.source == "differenced" else ""
    kind = {"start": ", at the start", "passage": ", near a change point"}.get(error.kind, "")
    return f"{quantity} of {error.body}{driver}{differenced}{kind}"


def row_table(judged: JudgedLog) -> list[dict[str, object]]:
    """The rows with unit suffixes in their names, for frames, CSV and JSON."""
    return [
        {
            "scene": judged.scene.name,
            "columns": " ".join(row.columns),
            **{name: getattr(row.error, name) for name in AS_THEY_ARE},
            "maximum_pure": row.error.pure,
            "limit_pure": row.limit.number,
            "limit_origin": row.limit.origin,
            "verdict": row.verdict,
            "time_of_maximum_s": row.error.time_of_maximum_s,
            "driver_at_maximum_rad": row.error.driver_at_maximum_rad,
            "reference_bound": row.error.bound,
            "samples": row.error.samples,
        }
        for row in log_rows(judged)
    ]
