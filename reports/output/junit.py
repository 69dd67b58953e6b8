"""JUnit XML, which continuous integration reads."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from xml.etree import ElementTree as Xml

from reports.output.write import clean


def junit(*suites: Xml.Element) -> str:
    """The text of a file of these suites."""
    root = Xml.Element("testsuites")
    root.extend(suites)
    Xml.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{Xml.tostring(root, "unicode")}\n'


def suite_of(
    name: str,
    cases: Sequence[Xml.Element],
    facts: Mapping[str, str],
    time: str = "0",
    **attributes: str,
) -> Xml.Element:
    """Cases with their counts, and where they come from."""
    count = Counter(told.tag for case in cases for told in case)
    heads = {
        "name": f"crankcheck {name}",
        "tests": str(len(cases)),
        "failures": str(count["failure"]),
        "errors": str(count["error"]),
        "time": time,
        "skipped": str(count["skipped"]),
    }
    suite = Xml.Element("testsuite", heads | attributes)
    properties = Xml.SubElement(suite, "properties")
    for fact, value in facts.items():
        Xml.SubElement(properties, "property", name=clean(fact), value=clean(value))
    suite.extend(cases)
    return suite


def case_of(group: str, name: str, time: str = "0") -> Xml.Element:
    """A cell; what became of it is told by `remark`, and nothing where it is as it should be."""
    heads = {"classname": f"crankcheck.{group}", "name": name, "time": time}
    return Xml.Element("testcase", {head: clean(value) for head, value in heads.items()})


def remark(case: Xml.Element, tag: str, text: str = "", **attributes: str) -> None:
    """Add a ``failure``, ``error``, ``skipped`` or ``system-out`` to a case."""
    cleaned = {name: clean(value) for name, value in attributes.items()}
    Xml.SubElement(case, tag, cleaned).text = clean(text)
