"""A judged log as JUnit XML."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element

from reports.output.junit import case_of, say, suite_of
from reports.own_log.judged import JudgedLog
from reports.own_log.rows import log_rows, share_of
from reports.own_log.table import cause_text


def suite(judged: JudgedLog, facts: Mapping[str, str]) -> Element:
    """A test case for each error, and one for what the rules say of the log as a whole."""
    cases = []
    for row in log_rows(judged):
        case = case_of(judged.scene.name, f"{row.what} ({', '.join(row.columns) or 'differenced'})")
        if row.verdict == "out":
            text = f"{row.error.pure:.3g} {share_of(row.error)}, limit {row.limit.number:.3g}"
            say(case, "failure", "\n".join(_causes(judged, row.columns)), message=text, type="out")
        cases.append(case)
    whole = case_of(judged.scene.name, "the log as a whole")
    if judged.failures:
        text = "\n".join(f"{each.rule}: {each.text}" for each in judged.failures)
        say(whole, "failure", text, message=judged.failures[0].text, type=judged.failures[0].rule)
    if judged.not_judged:
        say(whole, "system-out", f"not judged: {', '.join(judged.not_judged)}")
    return suite_of("judge", [*cases, whole], facts)


def _causes(judged: JudgedLog, columns: tuple[str, ...]) -> list[str]:
    """What explains the errors of some columns."""
    return [cause_text(cause) for cause in judged.causes if set(columns) & set(cause.columns)]
