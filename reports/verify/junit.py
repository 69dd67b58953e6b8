"""A verification as JUnit XML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element

from reports.judge.cell import Checked
from reports.judge.rules import RULES
from reports.judge.rules.rule import Finding
from reports.output.junit import case_of, say, suite_of


def suite(checked: Sequence[Checked], facts: Mapping[str, str]) -> Element:
    """One test case per cell; a cell that is shown without being gated is skipped, with its
    findings in the message."""
    return suite_of(
        "verify",
        [_case(one) for one in checked],
        facts,
        time=f"{sum(one.wall_s for one in checked):.3f}",
        timestamp=facts["made"].removesuffix("+00:00"),
    )


def _case(one: Checked) -> Element:
    """One cell."""
    cell = one.cell
    case = case_of(f"{cell.engine}.{cell.profile}", cell.scene.name, f"{one.wall_s:.3f}")
    text = "\n".join(_line(finding) for finding in one.failures)
    head = one.failures[0].text if one.failures else "within tolerance"
    if not cell.gated:
        say(case, "skipped", message=f"shown, not gated: {head}")
    elif one.verdict == "unsupported":
        say(case, "error", text, message=head, type="unsupported")
    elif one.failures:
        say(case, "failure", text, message=head, type=one.failures[0].rule)
    if one.advice:
        say(case, "system-out", "\n".join(_line(finding) for finding in one.advice))
    return case


def _line(finding: Finding) -> str:
    """A finding with its rule and cure."""
    rule = RULES[finding.rule]
    return f"{rule.id} {rule.title}: {finding.text}" + (
        f"\n  cure: {finding.cure}" if finding.cure else ""
    )
