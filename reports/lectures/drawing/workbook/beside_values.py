"""What a workbook of a motion has beside its values: formulas where there are any, and charts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from models.array import Array
from models.scene import Scene
from reports.lectures.drawing.workbook.live_workbook import add_live, formulas_of
from reports.lectures.drawing.workbook.value_charts import add_value_charts, widen

MOST_LIVE, MOST_DRAWN = 20_000, 100_000
"""Rows that a spreadsheet computes, and draws, while one looks on."""


def beside_values(scene: Scene, time_s: Array, columns: Sequence[str]) -> Callable[[Any], None]:
    """What puts formulas and charts into the workbook of a motion over ``time_s``, evenly spaced
    from 0, whose first sheet has the ``columns``."""
    count = time_s.size
    table = None
    if 1 < count <= MOST_LIVE:
        step = math.degrees(float(time_s[1]) * scene.pace_rad_s)
        table = formulas_of(scene, count, step)

    def put(book: Any) -> None:
        values = book.worksheets[0]
        widen(values)
        if table is not None:
            add_live(book, table)
        elif 1 < count <= MOST_DRAWN:
            add_value_charts(book, values.title, columns, count)

    return put


def left_out(count: int) -> str:
    """What a workbook of so many rows does not have, in words that end a sentence."""
    if count <= MOST_LIVE:
        return ""
    charts = f", and charts of {MOST_DRAWN}" * (count > MOST_DRAWN)
    return f"; values alone: formulas are of at most {MOST_LIVE} rows{charts}"


def live_sheet(
    scene: Scene, time_s: Array, columns: Sequence[str]
) -> tuple[str, Callable[[Any], None]]:
    """What a workbook does not have, in words, and what puts formulas and charts into it."""
    return left_out(time_s.size), beside_values(scene, time_s, columns)
