"""A diff as JUnit XML, which continuous integration reads."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as Xml

from reports.diff.words import ratio, size, told
from reports.output.write import clean
from reports.results.changes.changes import CellPair, Diff
from reports.results.changes.runs import CellName, StoredCell

DECLARATION = '<?xml version="1.0" encoding="utf-8"?>\n'


def junit(diff: Diff, strict: bool = False) -> str:
    """One test case per cell of either run: a failure where it is worse, skipped where there is
    nothing to compare it with; ``strict`` makes failures of those but the new ones."""
    root = Xml.Element("testsuites")
    root.append(_suite(diff, strict))
    return _text(root)


def joined(verification: str, diff: Diff) -> str:
    """The JUnit XML of a verification with the diff as a second suite."""
    root = Xml.fromstring(verification)
    root.append(_suite(diff, strict=False))
    return _text(root)


def _text(root: Xml.Element) -> str:
    Xml.indent(root)
    return DECLARATION + Xml.tostring(root, "unicode") + "\n"


def _suite(diff: Diff, strict: bool) -> Xml.Element:
    """The cases with their counts."""
    cases = [_compared(pair) for pair in diff.pairs]
    lost = "failure" if strict else "skipped"
    cases += _uncompared(diff.missing, lost, "missing: only the old run has it")
    cases += _uncompared(diff.other_scene, lost, "the scene changed in between")
    cases += _uncompared(diff.added, "skipped", "new: only the new run has it")
    suite = Xml.Element(
        "testsuite",
        name="crankcheck diff",
        tests=str(len(cases)),
        failures=str(sum(case.find("failure") is not None for case in cases)),
        errors="0",
        time="0",
        skipped=str(sum(case.find("skipped") is not None for case in cases)),
    )
    properties = Xml.SubElement(suite, "properties")
    for side, run in (("old", diff.old), ("new", diff.new)):
        for name, value in {"run": run.label, **run.facts}.items():
            Xml.SubElement(properties, "property", name=clean(f"{side} {name}"), value=clean(value))
    suite.extend(cases)
    return suite


def _compared(pair: CellPair) -> Xml.Element:
    """A cell of both runs."""
    case = _case(pair.name)
    if pair.word == "worse":
        versions = f"{pair.name.engine} {pair.old.version} -> {pair.new.version}"
        rows = [
            f"{change.quantity}: {size(change.old)} -> {size(change.new)}, ratio {ratio(change)}"
            f" ({change.word(pair.factor)})"
            for change in pair.changes
        ]
        kind = "status" if pair.turned else "error"
        message = f"{pair.name.label}: {told(pair)}"
        failure = Xml.SubElement(case, "failure", message=clean(message), type=kind)
        failure.text = clean("\n".join([versions, *rows]))
    elif pair.word == "better":
        Xml.SubElement(case, "system-out").text = clean(f"better: {told(pair)}")
    return case


def _uncompared(cells: Sequence[StoredCell], tag: str, why: str) -> list[Xml.Element]:
    """Cells that there is nothing to compare with."""
    found = []
    for cell in cells:
        case = _case(cell.name)
        Xml.SubElement(case, tag, message=clean(why))
        found.append(case)
    return found


def _case(name: CellName) -> Xml.Element:
    return Xml.Element(
        "testcase",
        classname=clean(f"crankcheck.diff.{name.engine}.{name.variant}"),
        name=clean(name.label),
        time="0",
    )
