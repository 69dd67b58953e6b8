"""Free motion: the time for which each engine stays near the reference."""

from collections.abc import Mapping

from reports.output.numbers import duration
from reports.page.sections.cell import known
from reports.page.sections.errors import drawn
from reports.page.sections.section import BUDGET, Section, WaySection, steps_held
from reports.protocol.length import clock_of
from reports.results.lines import Line, lines
from reports.results.overview import Report
from reports.results.recommend import Recommendation, short_target
from reports.ways.free.courses import FreeCourses, sizes_of

KIND = "free"
SHOWN = (
    *("phase_pure", "phase_limit_pure", "geometry_pure", "energy_pure"),
    *("horizon_1e-1_s", "horizon_1e-3_s", "precision", "sensitivity", "dt_s", "verdict", "status"),
)
"""The columns of the table."""
SCRIPTS = (
    *("legend.js", "charts.js", "mechanism.js", "stage.js", "free_courses.js", "cell.js"),
    *("free.js", "copying.js"),
)
FREE_DRIVE = ", free drive"
"""Words of a variant that are left out here, where all motion is free."""
ERRORS = {
    "phase_pure": ("phase, over the sensitivity", "rad"),
    "geometry_pure": ("geometry at the run's own angle", "rad, or of longest link"),
    "energy_pure": ("drift of energy", "of largest kinetic energy"),
    "place_pure": ("place at the same time, over the sensitivity", "rad, or of longest link"),
    "gap_pure": ("gaps of pins and sliders", "of longest link"),
}
"""Errors drawn against the step, by column of the store: name and unit."""


def build(report: Report, room: int = BUDGET) -> Section | None:
    """The section; None where everything was driven. ``room`` is the size of its drawings and
    curves [characters]."""
    lines = report.of_kind(KIND)
    if not lines:
        return None
    names = list(dict.fromkeys(line.scene for line in lines))
    sizes = sizes_of(report, lines)
    held = steps_held(sizes, lines, room)
    costs = [
        one for one in report.recommendations if one.best.way and one.best.way.kinds == (KIND,)
    ]
    names_of_errors, curves = error_curves(report, KIND, ERRORS)
    return Section(
        anchor="free",
        title="Free motion",
        template="free.html",
        words={
            "rows": [row for line in lines for row in _rows(report, line)],
            "scenes": [
                {"name": name, "source": scene.source, "note": scene.note}
                if (scene := report.scenes[name])
                else {"name": name, "source": "", "note": ""}
                for name in names
            ],
            "errors": names_of_errors,
            "costs": [cost_row(report, one) for one in costs],
            "thinned": held < max(len(line.cells) for line in lines),
            "held": held,
        },
        embedded={
            "scenes": [
                FreeCourses(report, name, report.scenes[name], sizes, held).embedded()
                for name in names
            ],
            **curves,
            **known(report, lines),
            "judged": sorted({report.look(x).number for x in lines if x.cells["gated"].all()}),
        },
        scripts=SCRIPTS,
        plotly=True,
    )


def _rows(report: Report, line: Line) -> list[dict[str, object]]:
    look = report.look(line)
    return [
        {"scene": line.scene, "look": look, "variant": line.variant}
        | {name: cell.get(name) for name in SHOWN}
        | {
            f"{name}_told": "not at all" if held == 0.0 else duration(held)
            for name in ("1e-1", "1e-3")
            for held in (cell[f"horizon_{name}_s"],)
        }
        for cell in line.cells.to_dict("records")
    ]


def cost_row(report: Report, one: Recommendation, period_s: float = 1.0) -> dict[str, object]:
    """The cheapest settings of an engine that keep a target on every scene, as a row, with their
    text to be copied for a driver of that period."""
    best = one.best
    return {
        "one": one,
        "called": best.variant,
        "snippet": one.snippet(period_s),
        "target": short_target(one.target),
        "look": report.looks[best.engine, best.variant, best.drive],
        "reason": one.reason.replace(FREE_DRIVE, ""),
        "caution": one.caution.replace(FREE_DRIVE, ""),
        "dt_s": 1.0 / best.steps_per_turn,
        "steps": f"{best.steps_per_turn:g} a {clock_of(best.drive).name}",
        "us_per_step": best.us_per_step,
        "ms": 1e3 * best.s_per_turn,
        "error": best.worst_error,
        "scene": best.worst_scene,
    }


def error_curves(
    report: Report, kind: str, errors: Mapping[str, tuple[str, str]]
) -> tuple[dict[str, str], dict[str, object]]:
    """The errors of a kind against the step, by column of the store, of their names and units: the
    names; and the curves of all lines with their fits, and the units, to be drawn."""
    own = {column: named for column, named in errors.items() if column in report.cells}
    fits = {
        column: [
            drawn(report, line) | {"lasts_s": line.period_s}
            for line in lines(report.stored, column)
            if kind in line.way.kinds
        ]
        for column in own
    }
    units = {column: unit for column, (_, unit) in own.items()}
    return {column: name for column, (name, _) in own.items()}, {"fits": fits, "units": units}


SECTION = WaySection(build, build)
