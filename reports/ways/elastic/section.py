"""Elastic links: the deflection of engines' segments, beside the beam."""

from collections.abc import Callable, Mapping

import numpy as np

from models.array import Array
from reports.compare.last_turn import Trace
from reports.drawing.moving import first_turn, packed
from reports.output.numbers import duration
from reports.page.sections.cell import known
from reports.page.sections.section import Section, WaySection
from reports.protocol.length import SECONDS, TURNS, Clock, clock_of
from reports.results.lines import Line
from reports.results.overview import Report
from reports.ways.free.section import cost_row, error_curves

KIND = "elastic"
SHOWN = (
    *("deflection_pure", "deflection_limit_pure", "segments_pure", "segments_limit_pure"),
    *("extension_pure", "angle_pure", "gap_pure", "chain_pure", "doubt_pure", "linear_pure"),
    *("steps_per_turn", "verdict", "status"),
)
"""The columns of the table."""
ERRORS = {
    "deflection_pure": ("deflection, beside the beam", "of largest deflection"),
    "segments_pure": ("deflection, beside the exact chain", "of largest deflection"),
    "extension_pure": ("extension", "of longest link"),
    "angle_pure": ("angle of rigid links", "rad"),
    "gap_pure": ("gaps of pins and sliders", "of longest link"),
}
"""Errors drawn against the step, by column of the store: name and unit."""
SCRIPTS = (
    *("legend.js", "charts.js", "free_courses.js", "cell.js", "elastic_links.js"),
    "copying.js",
)
PREFIX = "deflection."
"""Prefix of the series of a trace that are deflections [m], by link."""


def build(report: Report) -> Section | None:
    """The section; None where no link bends."""
    own = report.of_kind(KIND)
    if not own:
        return None
    names = list(dict.fromkeys(line.scene for line in own))
    bent = [one for one in report.recommendations if one.best.way and KIND in one.best.way.kinds]
    names_of_errors, curves = error_curves(report, KIND, ERRORS)
    return Section(
        anchor="elastic",
        title="Elastic links",
        template="elastic_links.html",
        words={
            "scenes": names,
            "errors": names_of_errors,
            "rows": [row for line in own for row in _rows(report, line)],
            "costs": [cost_row(report, one, own[0].period_s) for one in bent],
        },
        embedded={
            "courses": [each for line in own for each in _courses(report, line)],
            **curves,
            **known(report, own),
        },
        scripts=SCRIPTS,
        plotly=True,
    )


def _rows(report: Report, line: Line) -> list[dict[str, object]]:
    return [
        {"scene": line.scene, "look": report.look(line), "turn": clock_of(line.drive).name}
        | {name: cell.get(name) for name in SHOWN}
        for cell in line.cells.to_dict("records")
    ]


def _courses(report: Report, line: Line) -> list[dict[str, object]]:
    """The deflection [m] of each elastic link over the last turn, at the finest good step."""
    ran = line.cells[line.cells["status"] == "ok"]
    if ran.empty:
        return []
    cell = ran.iloc[-1]
    trace = report.stored.trace(str(cell["key"]))
    over, x = COURSES[clock_of(line.drive)](trace)
    return [
        {
            "scene": line.scene,
            "look": report.look(line).number,
            "step": duration(float(cell["dt_s"])),
            "link": name.removeprefix(PREFIX),
            "over": over,
            "x": x,
            "rows": packed(np.vstack([series, trace[f"deflection_error.{name[len(PREFIX) :]}"]])),
        }
        for name, series in trace.items()
        if name.startswith(PREFIX)
    ]


COURSES: Mapping[Clock, Callable[[Trace], tuple[str, Array]]] = {
    TURNS: lambda trace: ("angle of the driver [deg]", np.degrees(first_turn(trace["driver_rad"]))),
    SECONDS: lambda trace: ("time [s]", trace["time_s"]),
}
"""The abscissa of courses: its name, and its numbers (T,)."""
SECTION = WaySection(build)
