"""JUnit XML: valid, whatever a reason or a source holds."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree as Xml

import pytest

from models.scene import Scene
from reports.judge.cell import Cell, unfinished
from reports.output.junit import junit
from reports.verify.junit import suite

FACTS = {"crankcheck": "1", "made": "2026-01-01T00:00:00+00:00"}


@pytest.mark.parametrize(
    "reason", ["<a> & \"b\" 'c'", "bell \x07 null \x00", "]]>", "\ud800 alone", "\u202e turned"]
)
def test_any_text_gives_valid_xml(fourbar: Scene, reason: str) -> None:
    cell = Cell(replace(fourbar, name="x<y&z"), "mujoco", "tuned", 1e-3, 100)
    text = junit(suite([unfinished(cell, "diverged", reason)], FACTS))
    (read,) = Xml.fromstring(text.encode())
    case = read.find("testcase")
    assert case.get("name") == "x<y&z"
    assert read.get("failures") == "1"


def test_a_cell_that_can_not_run_is_an_error_and_no_failure(fourbar: Scene) -> None:
    cell = Cell(fourbar, "mujoco", "tuned", 1e-3, 100)
    text = junit(suite([unfinished(cell, "unsupported", "no mass")], FACTS))
    (read,) = Xml.fromstring(text)
    assert (read.get("errors"), read.get("failures")) == ("1", "0")
