"""Engines side by side: the table above all, with the hard cases that were run beside the store."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
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
    looks = {look.engine: look for look in report.looks.values()}
    looks |= {look.engine: look for look in report.looks.values() if look.variant == JUDGED}
    return Section(
        anchor="engines",
        title="Engines",
        template="engines.html",
        words={
            "columns": COLUMNS,
            "groups": {
                name: list(own) for name, own in itertools.groupby(rows, lambda row: row.formulation)
            },
            "looks": looks,
            "notes": notes(report),
        },
        styles=("engines.css",),
    )


def complete(report: PageReport) -> list[EngineRow]:
    """Return the rows of the table, with the hard cases."""
    return [
        replace(row, scores={**row.scores, "hard": held(report.matrix, row.engine)})
        for row in engine_rows(report)
    ]


def held(matrix: Matrix | None, engine: str) -> Score:
    """Return the share of graded values that an engine holds, and the cases held throughout."""
    good = {case.name: case.good for case in matrix.cases} if matrix else {}
    runs = [
        run
        for run in (matrix.runs if matrix else ())
        if (run.engine, run.profile, run.grid) == (engine, JUDGED, True) and run.case in good
    ]
    graded = [run for run in runs if run.outcome != "unsupported"]
    if not graded:
        return Score(remark="unsupported" if runs else "not run")
    well = [run.outcome in good[run.case] for run in graded]
    failed = {run.case for run, ok in zip(graded, well, strict=True) if not ok}
    cases = {run.case for run in graded}
    remark = f"{len(cases - failed)} of {count(len(cases), 'case')} throughout"
    if out := len(runs) - len(graded):
        remark += f"; {count(out, 'value')} unsupported"
    share = sum(well) / len(well)
    return Score(share, f"{100 * share:.0f} %", remark)


def notes(report: PageReport) -> list[str]:
    """Return a line on each group of columns: what its numbers are."""
    steps = near_ms(report)
    span = " to ".join(dict.fromkeys(map(duration, steps))) if steps else "none was run"
    return [
        "All but the times: profile tuned, in each cell the median over the scenes, or as it says; "
        "a dash has its reason.",
        "Error at 1 ms: the largest error of place (rad, or of the longest link) of a run at the "
        f"measured step nearest to 1 ms ({span}).",
        "Order and floor: fitted to that error over the steps of each scene; the floor is the "
        "largest that was seen.",
        "Turn to 1e-3, 1e-4: the least measured time of a turn, of all settings and steps, with "
        "every scene within that error.",
        "Hard cases: share of the graded values that are held.",
        "Free motion: the error of place over the sensitivity of the motion, at the finest step.",
        "Forces: the error of the reactions, of the largest reaction, at the finest step.",
    ]


def in_markdown(report: PageReport, room: int) -> Iterator[str]:
    """Yield the head, the table and its notes; nothing for fewer than three engines."""
    rows = complete(report)
    if not rows:
        return
    heads = [f"{name}: {head}" for name, own in COLUMNS.items() for head in own.values()]
    yield "### Engines"
    cells = ([_engine(row), row.formulation, *map(_words, _in_order(row))] for row in rows)
    yield table(("engine", "formulation", *(f"{head}:" for head in heads)), cells, room, "engines")
    yield "\n".join(f"- {note}" for note in notes(report))


def _engine(row: EngineRow) -> str:
    single = " (single precision)" if row.precision == "single" else ""
    return f"{row.engine} {row.version}{single}"


def _in_order(row: EngineRow) -> Sequence[Score]:
    return [row.scores[name] for own in COLUMNS.values() for name in own]


def _words(score: Score) -> str:
    return f"{score.told} ({score.remark})" if score.remark else score.told
