"""A workbook that computes: inputs, their table of formulas, and charts of both."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from openpyxl import Workbook  # type: ignore[import-untyped]  # ships no stubs

from analytic.mechanism.fourbar import FourBar
from analytic.prepared import prepared
from analytic.structure.groups import Group
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import StructureError
from models.scene import GROUND, Scene
from models.scene.laws import ConstantSpeed
from reports.lectures.drawing.workbook.charts import Curves, add_chart, add_value_charts, widen
from reports.lectures.drawing.workbook.formula_cells import TABLE, write_columns, write_inputs
from reports.lectures.drawing.workbook.formula_table import FormulaTable
from reports.lectures.drawing.workbook.four_bar_formulas import four_bar_table
from reports.lectures.drawing.workbook.slider_crank_formulas import slider_crank_table
from reports.lectures.drawing.workbook.slotted_lever_formulas import slotted_lever_table
from reports.output.provenance import crankcheck_version
from reports.output.write import clean

TIME = "time"


def formulas_of(scene: Scene, count: int, step_deg: float) -> FormulaTable | None:
    """The formulas of a four-bar, a slider-crank or a slotted lever at constant speed; None of any
    other scene, and of one that goes through change points: formulas stay on one branch there."""
    if not isinstance(scene.driver.law, ConstantSpeed) or prepared(scene).passages:
        return None
    order = analyse(scene).order
    group = order[0] if len(order) == 1 else None
    if not isinstance(group, Group):
        return None
    if group.kind == "RRR" and _is_four_bar(scene):
        return four_bar_table(scene, group, count, step_deg)
    if group.kind == "RRP" and _is_slider_crank(scene, group):
        return slider_crank_table(scene, group, count, step_deg)
    if group.kind == "RPR" and _is_slotted_lever(scene, group):
        return slotted_lever_table(scene, group, count, step_deg)
    return None


def _is_four_bar(scene: Scene) -> bool:
    """Whether the two links hang between the crank and the ground, and have a length each."""
    try:
        FourBar.of(scene)
    except StructureError:
        return False
    return True


def _is_slider_crank(scene: Scene, group: Group) -> bool:
    """Whether the rod hangs on the crank's pin, and what slides does so on the ground."""
    return scene.sliders[group.outer2].on == GROUND and group.outer1 in _crank_pins(scene)


def _is_slotted_lever(scene: Scene, group: Group) -> bool:
    """Whether a block on the crank's pin slides on a lever that is pinned to the ground."""
    slider = scene.sliders[group.inner]
    if slider.link is not None or slider.on not in scene.links:
        return False
    grounded = {group.outer1, group.outer2} & set(scene.ground) & set(scene.links[slider.on].points)
    return bool(grounded) and slider.point in _crank_pins(scene)


def _crank_pins(scene: Scene) -> set[str]:
    """The points of the crank that turn about its pivot."""
    return set(scene.links[scene.driver.link].points) - {scene.driver_pivot}


def add_live(book: Workbook, table: FormulaTable) -> None:
    """Put inputs, formulas and charts into a workbook."""
    write_inputs(book, table)
    write_columns(book, table)
    for number, (title, names) in enumerate(table.charts.items()):
        curves = [(table.place(_time_of(name, table)), table.place(name)) for name in names]
        add_chart(book, number, title, Curves(TABLE, curves, table.count))


def _time_of(column: str, table: FormulaTable) -> str:
    """The times of a column: those of its member, where members have their own."""
    own = f"{TIME}_{column.rpartition('_')[2]}"
    return own if any(each.name == own for each in table.columns) else TIME


def live_workbook(table: FormulaTable, origin: Mapping[str, str]) -> bytes:
    """A workbook of the formulas alone, and where they come from."""
    book = Workbook()
    about = book.active
    assert about is not None
    about.title = "source"
    facts = {"what": "value", **origin, "crankcheck": crankcheck_version()}
    for what, value in facts.items():
        about.append([what, clean(value)])
    for letter, width in zip("AB", (14, 70), strict=True):
        about.column_dimensions[letter].width = width
    for row in about.iter_rows():
        for cell in row:
            cell.data_type = "s"  # a text that begins with "=" is no formula
    add_live(book, table)
    buffer = io.BytesIO()
    book.save(buffer)
    return buffer.getvalue()


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
