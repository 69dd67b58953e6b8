"""The three lines: their error over time, and against the step."""

from __future__ import annotations

from reports.drawing.packed import singles
from reports.judge.halving import worst_place
from reports.own_model.account import CheckedLine
from reports.own_model.judged import PARTS, JudgedModel, errors_of
from reports.page.model_sections.line_looks import line_looks
from reports.page.sections.section import Section


def build(judged: JudgedModel) -> Section | None:
    """The section; None where no line logged anything."""
    if not any(one.course for one in judged.three):
        return None
    return Section(
        anchor="lines",
        title="Error of the lines",
        template="model_lines.html",
        words={"converge": judged.account.request.converge},
        embedded={
            "lines": [_line(judged, one) for one in judged.three],
            "limits": {"error": _limit(judged), "gap": _limit_of(judged, "gap")},
        },
        scripts=("legend.js", "charts.js", "model_lines.js"),
        styles=("log.css", "model.css"),
        plotly=True,
    )


def _line(judged: JudgedModel, one: CheckedLine) -> dict[str, object]:
    """A line as the script reads it."""
    dt_s, course = judged.account.dt_s, one.course
    return {
        "look": line_looks(judged)[one.cell.profile].number,
        "dt": [dt_s / parts for parts in PARTS],
        "error": list(errors_of(one)),
        "course": None
        if course is None
        else {
            "time": singles(course.time_s),
            "error": singles(course.error),
            "gap": singles(course.gap),
        },
    }


def _limit(judged: JudgedModel) -> float | None:
    """The limit of the quantity whose error is largest as written."""
    worst = worst_place(judged.own.errors) if judged.own.errors else None
    return None if worst is None else _limit_of(judged, worst.tolerance)


def _limit_of(judged: JudgedModel, name: str) -> float | None:
    limit = judged.own.limits.get(name)
    return None if limit is None else limit.number
