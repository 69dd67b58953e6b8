"""A judged log as Markdown, for a comment."""

from __future__ import annotations

from collections.abc import Mapping

from reports.judge.rules import RULES
from reports.output.markdown import folded, plain, table
from reports.output.numbers import error_text, short
from reports.own_log.judged import JudgedLog
from reports.own_log.rows import share_of
from reports.own_log.table import (
    cause_text,
    fit_text,
    footer,
    missing_text,
    rest_text,
    shown_rows,
    taken_text,
    unused_lines,
    verdict_line,
)

ROOM = 20_000
HEADS = ("", "columns", "read as", "largest error:", "of its scale:", "limit:", "taken:")


def markdown(judged: JudgedLog, facts: Mapping[str, str]) -> str:
    """The verdict, what is wrong and why, every error, and what the numbers are."""
    parts = [
        f"## crankcheck judge: {plain(judged.log.source)}",
        f"**{verdict_line(judged).plain}**",
    ]
    parts += [
        "\n".join(
            f"- {f.rule} {plain(RULES[f.rule].title)}: {plain(f.text)}" for f in judged.failures
        ),
        "\n".join(f"- cause: {plain(cause_text(c))}" for c in judged.causes),
    ]
    cells = [
        (
            "ok" if row.verdict == "within" else "OUT",
            row.names,
            row.what,
            row.size,
            f"{error_text(row.error.pure)} {share_of(row.error)}",
            short(row.limit.number),
            taken_text(row.taken),
        )
        for row in sorted(shown_rows(judged), key=lambda row: row.verdict == "within")
    ]
    parts.append(table(HEADS, cells, ROOM, "errors"))
    told = [f"drive: {fit_text(judged)}"] if judged.fit else []
    if judged.not_judged:
        told.append(f"not judged: {missing_text(judged)}, which the log has not")
    told += filter(None, [rest_text(judged)])
    told += [f"not used: {line}" for line in unused_lines(judged)]
    told += judged.notes
    if told:
        parts.append(folded("more", "\n".join(f"- {plain(each)}" for each in told)))
    parts.append("\n".join(f"{plain(line)}  " for line in footer(judged, facts)))
    return "\n\n".join(part for part in parts if part)
