"""A workbook that computes: inputs, their table of formulas, and charts of both."""

import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from openpyxl import Workbook  # type: ignore[import-untyped]  # ships no stubs
from openpyxl.chart import (  # type: ignore[import-untyped]  # as above
    Reference,
    ScatterChart,
    Series,
)
from openpyxl.chart.axis import ChartLines  # type: ignore[import-untyped]  # as above
from openpyxl.chart.shapes import GraphicalProperties  # type: ignore[import-untyped]  # as above
from openpyxl.drawing.line import LineProperties  # type: ignore[import-untyped]  # as above
from openpyxl.worksheet.properties import (  # type: ignore[import-untyped]  # as above
    PageSetupProperties,
)

from analytic.mechanism.fourbar import FourBar
from analytic.prepared import prepared
from analytic.structure.groups import Group
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import StructureError
from models.scene import GROUND, Scene
from models.scene.laws import ConstantSpeed
from reports.describe.free_motion import motion_frame
from reports.lectures.drawing.workbook import formulas
from reports.lectures.drawing.workbook.family import SceneFamily
from reports.lectures.drawing.workbook.formula_cells import TABLE, write_columns, write_inputs
from reports.lectures.drawing.workbook.formulas import FormulaTable
from reports.output.formats import workbook
from reports.output.write import clean, crankcheck_version

CHART_SHEET = "charts"
WIDE_CM, HIGH_CM, ROWS_EACH = 24.0, 9.0, 19
GRID, LINE_EMU = "D9DDE3", 15875
"""Colour of the lines of a grid, and width of a curve, 1.25 pt."""


@dataclass(frozen=True)
class Curves:
    """Pairs of columns of a sheet by number, across and up, in rows below a head."""

    sheet: str
    pairs: Sequence[tuple[int, int]]
    rows: int


def add_chart(book: Workbook, number: int, title: str, curves: Curves) -> None:
    """Add the chart below ``number`` others."""
    if CHART_SHEET not in book.sheetnames:
        on_one_page = PageSetupProperties(fitToPage=True)
        book.create_sheet(CHART_SHEET).sheet_properties.pageSetUpPr = on_one_page
    sheet = book[CHART_SHEET]
    source, last = book[curves.sheet], curves.rows + 1
    chart = ScatterChart()
    chart.title, chart.style, chart.scatterStyle = title, 2, "lineMarker"
    chart.width, chart.height = WIDE_CM, HIGH_CM
    chart.x_axis.title, chart.legend.position = "time [s]", "b"
    for axis in (chart.x_axis, chart.y_axis):
        axis.delete, axis.tickLblPos = False, "low"
        axis.number_format = "General"  # its own, and not the many digits of the cells
        axis.numFmt.sourceLinked = False
        grey = GraphicalProperties(ln=LineProperties(solidFill=GRID))
        axis.majorGridlines = ChartLines(spPr=grey)
    for over, up in curves.pairs:
        across = Reference(source, min_col=over, min_row=2, max_row=last)
        drawn = Reference(source, min_col=up, min_row=1, max_row=last)
        series = Series(drawn, across, title_from_data=True)
        series.marker.symbol, series.smooth = "none", False
        series.graphicalProperties.line.width = LINE_EMU
        chart.series.append(series)
    sheet.add_chart(chart, f"A{1 + ROWS_EACH * number}")


KINDS = (
    ("angles of links [rad]", "_theta_rad"),
    ("angular velocities [rad/s]", "_omega_rad_s"),
    ("angular accelerations [rad/s^2]", "_alpha_rad_s2"),
    ("displacements of sliders [m]", "_displacement_m"),
    ("speeds of sliders [m/s]", "_speed_m_s"),
    ("accelerations of sliders [m/s^2]", "_acceleration_m_s2"),
)
MOST_CURVES = 8
MARGIN, NARROWEST = 2, 12
"""Width of a column beyond its head, and the smallest width [characters]."""


def add_value_charts(book: Workbook, sheet: str, columns: Sequence[str], rows: int) -> None:
    """Add a chart for each kind of column that the sheet has, over its first column."""
    number = 0
    for title, ending in KINDS:
        places = [k for k, name in enumerate(columns, 1) if name.endswith(ending)]
        if places:
            pairs = [(1, place) for place in places[:MOST_CURVES]]
            add_chart(book, number, title, Curves(sheet, pairs, rows))
            number += 1


def widen(sheet: Any) -> None:
    """Make columns as wide as their heads."""
    for cell in sheet[1]:
        width = max(len(str(cell.value)) + MARGIN, NARROWEST)
        sheet.column_dimensions[cell.column_letter].width = width


def formulas_of(scene: Scene, count: int, step_deg: float) -> FormulaTable | None:
    """The formulas of a four-bar, a slider-crank or a slotted lever at constant speed; None for any
    other scene, and for one with change points: formulas stay on one branch there."""
    if not isinstance(scene.driver.law, ConstantSpeed) or prepared(scene).passages:
        return None
    order = analyse(scene).order
    group = order[0] if len(order) == 1 else None
    if not isinstance(group, Group):
        return None
    if group.kind == "RRR" and _is_four_bar(scene):
        return formulas.four_bar_table(scene, group, count, step_deg)
    if group.kind == "RRP" and _is_slider_crank(scene, group):
        return formulas.slider_crank_table(scene, group, count, step_deg)
    if group.kind == "RPR" and _is_slotted_lever(scene, group):
        return formulas.slotted_lever_table(scene, group, count, step_deg)
    return None


def _is_four_bar(scene: Scene) -> bool:
    try:
        FourBar.of(scene)
    except StructureError:
        return False
    return True


def _is_slider_crank(scene: Scene, group: Group) -> bool:
    """True if the rod is on the crank's pin, and the slider on the ground."""
    return scene.sliders[group.outer2].on == GROUND and group.outer1 in _crank_pins(scene)


def _is_slotted_lever(scene: Scene, group: Group) -> bool:
    """True if a block on the crank's pin slides on a lever that is pinned to the ground."""
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
    """The column of times of a column: its member's, where members have their own."""
    own = f"time_{column.rpartition('_')[2]}"
    return own if any(each.name == own for each in table.columns) else "time"


def live_workbook(table: FormulaTable, origin: Mapping[str, str]) -> bytes:
    """A workbook of the formulas alone, with their origin."""
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
    book.properties.creator = "crankcheck"
    buffer = io.BytesIO()
    book.save(buffer)
    return buffer.getvalue()


MOST_LIVE, MOST_DRAWN = 20_000, 100_000
"""Most rows that a spreadsheet computes, and draws, at once."""


def live_sheet(
    scene: Scene, time_s: Array, columns: Sequence[str]
) -> tuple[str, Callable[[Any], None]]:
    """The parts missing from the workbook of a motion over ``time_s``, evenly spaced from 0, in
    words; and the function that puts formulas and charts beside the ``columns`` of its first
    sheet."""
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

    return left_out(count), put


def left_out(count: int) -> str:
    """The parts missing from a workbook of so many rows, in words that end a sentence."""
    if count <= MOST_LIVE:
        return ""
    charts = f", and charts of {MOST_DRAWN}" * (count > MOST_DRAWN)
    return f"; values alone: formulas are of at most {MOST_LIVE} rows{charts}"


SHEET, TIME = "family", "time_s"


def scene_family_workbook(family: SceneFamily, origin: dict[str, str]) -> bytes:
    """The content of the workbook: the times of each member, the angles and displacements of all
    with their rates, and a chart for each of these with all members."""
    import pandas as pd

    scene = family.scene
    kept = [
        f"{name}{ending}"
        for name in (*(f"{slider}_slider" for slider in scene.sliders), *scene.links)
        if name != scene.driver.link
        for _, ending in KINDS
    ]
    members = {
        f"{family.name} = {value:.10g}": motion_frame(motion)
        for value, motion in zip(family.values, family.motions, strict=True)
    }
    kept = [name for name in kept if name in members[next(iter(members))]]
    frame = pd.DataFrame(
        {
            f"{column}, {member}": own[column]
            for member, own in members.items()
            for column in (TIME, *kept)
        }
    )
    places = {name: place for place, name in enumerate(frame.columns, 1)}

    def put(book: Any) -> None:
        widen(book[SHEET])
        for number, name in enumerate(kept):
            pairs = [(places[f"{TIME}, {each}"], places[f"{name}, {each}"]) for each in members]
            add_chart(book, number, name, Curves(SHEET, pairs, len(frame)))

    return workbook(frame, SHEET, origin, put)
