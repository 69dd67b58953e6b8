"""The verdict on a log: in one line, why, what to write in the map, and every error."""

from __future__ import annotations

from collections.abc import Sequence

from models.errors import few
from reports.causes.cause import Cause
from reports.judge.rules import RULES
from reports.judge.rules.rule import share
from reports.own_log.judged import JudgedLog
from reports.own_log.rows import LogRow
from reports.own_log.table import (
    fit_text,
    missing_text,
    rest_text,
    shown_rows,
    taken_text,
    unexplained,
    verdict_line,
)
from reports.page.log_sections.curves import DrawnChannel
from reports.page.log_sections.foreign_text import name_text, sentence_text, toml_text
from reports.page.sections.section import Section

MOST = 300
"""Columns that are listed as not used."""


def build(judged: JudgedLog, drawn: Sequence[DrawnChannel]) -> Section:
    """The section; its columns lead to their curves, by their numbers among those ``drawn``."""
    numbers = {curve.column: number for number, curve in enumerate(drawn)}
    rows = sorted(shown_rows(judged), key=lambda row: (row.verdict == "within", -row.taken))
    unused = judged.log.unused
    return Section(
        anchor="verdict",
        title="Verdict",
        template="log_verdict.html",
        words={
            "verdict": sentence_text(verdict_line(judged).plain),
            "level": judged.verdict,
            "failures": [
                (each.rule, RULES[each.rule].title, sentence_text(each.text))
                for each in judged.failures
            ],
            "causes": [(sentence_text(each.text), map_lines(each)) for each in judged.causes],
            "unexplained": _unexplained(judged),
            "fit": fit_text(judged) if judged.fit else "",
            "notes": [sentence_text(note) for note in judged.notes],
            "rows": [_row(row, numbers) for row in rows],
            "rest": rest_text(judged),
            "not_judged": missing_text(judged),
            "unused": [(name_text(name), sentence_text(why)) for name, why in unused[:MOST]],
            "number": len(unused),
        },
        scripts=("copying.js",),
        styles=("log.css",),
    )


def _unexplained(judged: JudgedLog) -> str:
    """The columns that no cause explains; of what was let go none is looked for."""
    is_explained = judged.scene.is_free or not judged.failures
    return "" if is_explained else sentence_text(few(unexplained(judged), 6))


def _row(row: LogRow, numbers: dict[str, int]) -> dict[str, object]:
    """A row of the table; a gap leads to its curve as well."""
    error = row.error
    gap = f"gap of {error.body}"
    columns = row.columns or ((gap,) if gap in numbers else ())
    return {
        "within": row.verdict == "within",
        "columns": [(name_text(name, 40), numbers.get(name)) for name in columns],
        "what": row.what,
        "maximum": error.maximum / row.per_unit,
        "unit": row.unit,
        "pure": error.pure,
        "share": share(error),
        "limit": row.limit.number,
        "origin": row.limit.origin,
        "taken": row.taken,
        "taken_told": taken_text(row.taken),
        "time_s": error.time_of_maximum_s,
    }


def map_lines(cause: Cause) -> str:
    """What to write in the map if the log means it as the cause says; "" where no map mends it."""
    tables = []
    for column in cause.columns:
        told = {**cause.correction, **cause.of_column.get(column, {})}
        if told:
            pairs = [f"{key} = {toml_text(value)}" for key, value in told.items()]
            tables.append("\n".join(["[[channel]]", f"column = {toml_text(column)}", *pairs]))
    return "\n\n".join(tables)
