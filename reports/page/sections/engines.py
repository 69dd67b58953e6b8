"""Engines side by side: the table above all, with the hard cases that were run beside the store."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

from reports.output.formats import table
from reports.output.numbers import count, duration
from reports.page.sections.section import PageReport, Section
from reports.results.engine_table import EngineRow, Score, engine_rows, near_ms
from reports.stability.matrix import Matrix

COLUMNS = {
    "kinematics": {
        "near": "error at 1 ms",
        "order": "order",
        "floor": "floor",
        "to 0.001": "turn to 1e-3",
        "to 0.0001": "turn to 1e-4",
    },
    "hard cases": {"hard": "held"},
    "free motion": {"free": "finest error", "free order": "order"},
    "forces": {"forces": "finest error", "forces order": "order"},
}
"""Columns in their groups: name of the score, and head."""
JUDGED = "tuned"


def build(report: PageReport) -> Section | None:
    """Return the section; None for a store of fewer than three engines."""
    rows = complete(report)
    if not rows:
        return None
    every = sorted(report.looks.values(), key=lambda look: look.variant == JUDGED)
    groups = itertools.groupby(rows, lambda row: row.declaration.formulation)
    return Section(
        anchor="engines",
        title="Engines",
        template="engines.html",
        words={
            "columns": COLUMNS,
            "groups": {name: list(own) for name, own in groups},
            "looks": {look.engine: look for look in every},
            "notes": notes(report),
        },
        styles=("engines.css",),
    )


def complete(report: PageReport) -> list[EngineRow]:
    """Return the rows of the table, with the hard cases."""
    rows = engine_rows(report)
    return [replace(x, scores={**x.scores, "hard": held(report.matrix, x.engine)}) for x in rows]


def held(matrix: Matrix | None, engine: str) -> Score:
    """Return the share of graded values that an engine holds, and the cases held throughout."""
    good = {case.name: case.good for case in matrix.cases} if matrix else {}
    own = [run for run in matrix.runs if run.engine == engine and run.grid] if matrix else []
    runs = [run for run in own if run.profile == JUDGED and run.case in good]
    graded = [run for run in runs if run.outcome != "unsupported"]
    if not graded:
        return Score(remark="unsupported" if runs else "not run")
    failed = [run.case for run in graded if run.outcome not in good[run.case]]
    cases = {run.case for run in graded}
    remark = f"{len(cases - set(failed))} of {count(len(cases), 'case')} throughout"
    if out := len(runs) - len(graded):
        remark += f"; {count(out, 'value')} unsupported"
    return Score(f"{100 * (1 - len(failed) / len(graded)):.0f} %", remark)


def notes(report: PageReport) -> list[str]:
    """Return a line on the numbers of each group of columns."""
    span = " to ".join(dict.fromkeys(map(duration, near_ms(report)))) or "none was run"
    return [
        "Numbers are of profile tuned, the median over the scenes unless stated otherwise; the "
        "reason of a dash stands under it.",
        "Error at 1 ms: the largest error of position in a run (rad, or over the longest link), at "
        f"the measured step nearest to 1 ms ({span}); its order and floor are fitted per scene, "
        "and the largest floor is shown.",
        "Turn to 1e-3, 1e-4: the least measured time of a turn, of all settings and steps, with "
        "every scene within that error.",
        "Hard cases: the share of graded values that the engine holds.",
        "Free motion: the error of position over the sensitivity of the motion. Forces: the error "
        "of the reactions over the largest one. Both at the finest step.",
    ]


def in_markdown(report: PageReport, room: int) -> Iterator[str]:
    """Yield the head, the table and its notes; nothing for fewer than three engines."""
    rows = complete(report)
    if not rows:
        return
    heads = [f"{group}: {head}:" for group, own in COLUMNS.items() for head in own.values()]
    names = [name for own in COLUMNS.values() for name in own]
    lines = []
    for row in rows:
        name = f"{row.engine} {row.version}, {row.declaration.precision} precision"
        scores = [row.scores[each].words for each in names]
        lines.append([name, row.declaration.formulation, *scores])
    yield "### Engines"
    yield table(("engine", "formulation", *heads), lines, room, "engines")
    yield "\n".join(f"- {note}" for note in notes(report))
