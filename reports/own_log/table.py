"""A judged log as it is printed, and as JUnit XML: its faults, and their causes."""

import math
from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from models.errors import cut, few, harmless
from reports.causes.cause import Cause
from reports.judge.rules import titled
from reports.judge.rules.rule import share
from reports.logs.log_beside import aside
from reports.output.console import grid, hanging, show_failed
from reports.output.formats import case_of, remark, suite_of
from reports.output.numbers import count, error_text, readable, short
from reports.own_log.drives import why_aside
from reports.own_log.judged import JudgedLog, LogRow, column_text, log_rows
from reports.own_log.log_limits import log_kind

HEADS = ("", "columns", "read as", "largest\nerror:", "of its\nscale:", "limit:", "error /\nlimit:")
WIDE = 90
"""Columns of a terminal that show when an error is largest."""
ROOM = 1000
"""Largest number of characters of a cause."""
FEW = 12
"""Number of missing names that are listed."""


def show(console: Console, judged: JudgedLog, facts: Mapping[str, str]) -> None:
    """Print a judged log."""
    _causes(console, judged)
    console.print(_table(shown_rows(judged), console.width), "")
    _rest(console, judged)
    if judged.known_text:
        hanging(console, "known failures: ", judged.known_text, style="yellow")
    console.print(verdict_line(judged))
    console.print(escape("\n".join(footer(judged, facts))), style="dim", highlight=False)


def _causes(console: Console, judged: JudgedLog) -> None:
    """Print the failures with their causes; within limits the causes of delays, as notes."""
    head, style = ("  cause: ", "cyan") if judged.failures else ("note: ", "yellow")
    if judged.failures:
        title = f"OUT  {judged.log.source}, scene {judged.scene.name}"
        show_failed(console, title, titled(judged.failures))
    for cause in judged.causes:
        hanging(console, head, cause_text(cause), style=style)
    if judged.failures and (rest := unexplained(judged)):
        hanging(console, head, no_cause_text(judged, rest), style=style)
    if judged.failures or judged.causes:
        console.print()


def cause_text(cause: Cause) -> str:
    """Return a cause, and its map entries where the log is right in itself; it may name columns,
    with any text as names."""
    text = cut(harmless(cause.text), ROOM)
    if cause.correction:
        return f"{text}; if this is meant, set in its [[channel]] of the map: " + _keys(
            cause.correction
        )
    each = [f"{column_text(column)}: {_keys(keys)}" for column, keys in cause.of_column.items()]
    if not any(cause.of_column.values()):
        return text
    return f"{text}; if this is meant, set in their [[channel]] of the map: {'; '.join(each)}"


def _keys(correction: Mapping[str, object]) -> str:
    return ", ".join(f"{key} = {_toml(value)}" for key, value in correction.items())


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:.9g}"


def unexplained(judged: JudgedLog) -> list[str]:
    """Return columns out of tolerance without a known cause; where the x of a point has one, its y
    may be right."""
    told = {column for cause in judged.causes for column in cause.columns}
    out = (row for row in log_rows(judged) if row.verdict == "out" and told.isdisjoint(row.columns))
    left = dict.fromkeys(column for row in out for column in row.columns)
    return [column_text(column) for column in left]


def no_cause_text(judged: JudgedLog, columns: Sequence[str]) -> str:
    """Return the sentence on columns out of tolerance without a cause."""
    return log_kind(judged.scene).no_cause.format(few(columns, 6))


def _table(rows: Sequence[LogRow], width: int) -> Table:
    heads = (*HEADS, *["at t\ns:"] * (width >= WIDE))
    table = grid(heads, gap=1, cut=("",), least={"columns": 12, "read as": 16})
    for row in rows:
        mark = Text("ok", "green") if row.verdict == "within" else Text("OUT", "bold red")
        names, what, *numbers = _texts(row)
        at = [f"{row.error.time_of_maximum_s:.4g}".replace("nan", "-")] if width >= WIDE else []
        table.add_row(mark, Text(names), Text(what), *numbers, *at)
    return table


def _texts(row: LogRow) -> tuple[str, ...]:
    pure = f"{error_text(row.error.pure)} {share(row.error)}"
    limit = short(row.limit.number)
    return row.names, row.what, row.size, pure, limit, taken_text(row.taken)


def shown_rows(judged: JudgedLog) -> list[LogRow]:
    """Return the rows of a table: all columns, and other errors out of tolerance, these first."""
    rows = [row for row in log_rows(judged) if row.verdict == "out" or not row.is_aside]
    return sorted(rows, key=lambda row: row.verdict == "within")


def rest_text(judged: JudgedLog) -> str:
    """Return the words for judged errors that are not in the table."""
    left = [row for row in log_rows(judged) if row.verdict == "within" and row.is_aside]
    if not left:
        return ""
    worst = max(left, key=lambda row: row.taken)
    count_ = count(len(left), "more error")
    return (
        f"{count_} within, of rates at the start or differenced; the largest: {worst.what}, "
        f"{taken_text(worst.taken)} of its limit"
    )


def taken_text(taken: float) -> str:
    """Return an error over its limit: 0.12, 34."""
    return readable(taken, 2) if math.isfinite(taken) else "nan"


def _rest(console: Console, judged: JudgedLog) -> None:
    if judged.fit:
        hanging(console, "drive: ", fit_text(judged))
    if text := rest_text(judged):
        hanging(console, "", text)
    for line in not_judged_lines(judged):
        hanging(console, "not judged: ", line)
    for line in unused_lines(judged):
        hanging(console, "not used: ", line)
    for note in judged.notes:
        hanging(console, "note: ", note, style="yellow")
    console.print()


def unused_lines(judged: JudgedLog) -> list[str]:
    """Return the columns without meaning, a line for each reason."""
    reasons: dict[str, list[str]] = {}
    for column, reason in judged.log.unused:
        reasons.setdefault(reason, []).append(column_text(column))
    return [f"{few(columns, FEW)}: {reason}" for reason, columns in reasons.items()]


def not_judged_lines(judged: JudgedLog) -> list[str]:
    """Return the parts of the scene that are not judged, a line for each reason."""
    there = aside(judged.log, judged.not_judged)
    lacking = [each for each in judged.not_judged if each not in there]
    why = f": {why_aside(judged.drive, judged.scene.driver.name)}"
    parts = ((there, why), (lacking, ", which the log lacks"))
    return [f"{_by_quantity(names)}{reason}" for names, reason in parts if names]


def _by_quantity(parts: Sequence[str]) -> str:
    bodies: dict[str, list[str]] = {}
    for each in parts:
        quantity, _, body = each.partition(" of ")
        bodies.setdefault("angle" if quantity == "drive" else quantity, []).append(body)
    return "; ".join(f"{quantity} of {few(names, FEW)}" for quantity, names in bodies.items())


def fit_text(judged: JudgedLog) -> str:
    """Return the fitted drive in words."""
    fit = judged.fit
    assert fit is not None
    return (
        f"fitted to {fit.by}: speed {fit.speed_rad_s:.9g} rad/s (within {short(fit.speed_doubt)}), "
        f"start {math.degrees(fit.start_rad):.7g} deg (within "
        f"{short(math.degrees(fit.start_doubt))}); one standard error each"
    )


def verdict_line(judged: JudgedLog) -> Text:
    """Return the verdict in one line."""
    rows = log_rows(judged)
    samples = judged.log.time_s.size
    what = f"{count(len(rows), 'error')} over {samples} samples of {judged.scene.name}"
    seen = {*judged.log.besides, *(each.channel.column for each in judged.log.still)}  # and right
    names = [column_text(each) for each, _ in judged.log.unused if each not in seen]
    if judged.beside.geometry_alone:
        read = {column for row in rows for column in row.columns}
        every = (each.channel.column for each in judged.log.readings if each.channel.kind.order)
        names += [column_text(each) for each in every if each not in read]
    if names:
        what += f"; not judged: {few(names, 6)}"
    if judged.failures:
        out = sum(row.verdict == "out" for row in rows)
        if judged.is_known:
            return Text(f"KNOWN FAILURE: {out} of {what}", "bold yellow")
        return Text(f"OUT OF TOLERANCE: {out} of {what}", "bold red")
    return Text(f"WITHIN TOLERANCE: {what}", "bold green")


def footer(judged: JudgedLog, facts: Mapping[str, str]) -> list[str]:
    """Return the reference and scale of the numbers, and versions."""
    drives = {
        "scene": "the scene's driver" if judged.log.timed else "the logged angle of the driver",
        "fitted": "a driver fitted to the log",
        "logged": "the logged angle of the driver (geometry alone)",
    }
    assert judged.errors is not None
    time_s = judged.log.time_s
    step = f"step {judged.step_s:g} s" if judged.step_s else "no step known"
    times = f"t = {time_s[0]:.6g} to {time_s[-1]:.6g} s, {step}"
    times = times if judged.log.timed else "No times: rates are at the scene's speed"
    return [
        judged.errors.compared_with(f" moved by {drives[judged.drive]}"),
        f"{times}; limits from "
        f"{', '.join(dict.fromkeys(row.limit.origin for row in log_rows(judged)))}.",
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]


def suite(judged: JudgedLog, facts: Mapping[str, str]) -> Element:
    """Return a test case for each error, and one for the rules on the log as a whole; of a known
    failure they are skipped."""
    cases = []
    kind = "skipped" if judged.is_known else "failure"
    for row in log_rows(judged):
        case = case_of(judged.scene.name, f"{row.what} ({', '.join(row.columns) or 'differenced'})")
        if row.verdict == "out":
            text = f"{row.error.pure:.3g} {share(row.error)}, limit {row.limit.number:.3g}"
            own = {*row.columns}
            why = [cause_text(each) for each in judged.causes if own & {*each.columns}]
            remark(case, kind, "\n".join(why), message=text, type="out")
        cases.append(case)
    whole = case_of(judged.scene.name, "the log as a whole")
    if judged.failures:
        text = "\n".join(f"{each.rule}: {each.text}" for each in judged.failures)
        message = judged.known_text if judged.is_known else judged.failures[0].text
        remark(whole, kind, text, message=message, type=judged.failures[0].rule)
    if judged.not_judged:
        remark(whole, "system-out", f"not judged: {', '.join(judged.not_judged)}")
    return suite_of("judge", [*cases, whole], facts)
