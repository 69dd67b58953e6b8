"""A verification as JUnit XML, which continuous integration reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree as Xml

from reports.judge.cell import Checked
from reports.judge.rules import RULES
from reports.judge.rules.base import Finding
from reports.output.write import clean


def junit(checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """One test case per cell; a cell that is shown without being gated is skipped, with its
    findings in the message."""
    suite = Xml.Element(
        "testsuite",
        name="crankcheck verify",
        tests=str(len(checked)),
        failures=str(sum(_fails(one) and one.verdict == "out" for one in checked)),
        errors=str(sum(_fails(one) and one.verdict == "unsupported" for one in checked)),
        time=f"{sum(one.wall_s for one in checked):.3f}",
        skipped=str(sum(not one.cell.gated for one in checked)),
        timestamp=facts["made"].removesuffix("+00:00"),
    )
    properties = Xml.SubElement(suite, "properties")
    for name, value in facts.items():
        Xml.SubElement(properties, "property", name=clean(name), value=clean(value))
    for one in checked:
        _case(suite, one)
    root = Xml.Element("testsuites")
    root.append(suite)
    Xml.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + Xml.tostring(root, "unicode") + "\n"


def _fails(one: Checked) -> bool:
    return one.cell.gated and one.verdict != "within"


def _case(suite: Xml.Element, one: Checked) -> None:
    """One cell."""
    cell = one.cell
    case = Xml.SubElement(
        suite,
        "testcase",
        classname=clean(f"crankcheck.{cell.engine}.{cell.profile}"),
        name=clean(cell.scene.name),
        time=f"{one.wall_s:.3f}",
    )
    text = "\n".join(_line(finding) for finding in one.failures)
    head = one.failures[0].text if one.failures else "within tolerance"
    if not cell.gated:
        Xml.SubElement(case, "skipped", message=clean(f"shown, not gated: {head}"))
    elif one.verdict == "unsupported":
        Xml.SubElement(case, "error", message=clean(head), type="unsupported").text = clean(text)
    elif one.failures:
        rule = one.failures[0].rule
        Xml.SubElement(case, "failure", message=clean(head), type=rule).text = clean(text)
    notes = [_line(finding) for finding in one.advice]
    if notes:
        Xml.SubElement(case, "system-out").text = clean("\n".join(notes))


def _line(finding: Finding) -> str:
    """A finding with its rule and cure."""
    rule = RULES[finding.rule]
    return f"{rule.id} {rule.title}: {finding.text}" + (
        f"\n  cure: {finding.cure}" if finding.cure else ""
    )
