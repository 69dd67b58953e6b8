"""JUnit XML: valid, whatever a reason or a source holds."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree as Xml

import pytest

from models.scene import Scene
from reports.judge.cell import Cell, unfinished
from reports.verify.junit import junit

FACTS = {"crankcheck": "1", "made": "2026-01-01T00:00:00+00:00"}


@pytest.mark.parametrize(
    "reason", ["<a> & \"b\" 'c'", "bell \x07 null \x00", "]]>", "\ud800 alone", "\u202e turned"]
)
def test_any_text_gives_valid_xml(fourbar: Scene, reason: str) -> None:
    cell = Cell(replace(fourbar, name="x<y&z"), "mujoco", "tuned", 1e-3, 100)
    text = junit([unfinished(cell, "diverged", reason)], FACTS)
    (suite,) = Xml.fromstring(text.encode())
    case = suite.find("testcase")
    assert case is not None
    assert case.get("name") == "x<y&z"
    assert suite.get("failures") == "1"


def test_a_cell_that_can_not_run_is_an_error_and_no_failure(fourbar: Scene) -> None:
    cell = Cell(fourbar, "mujoco", "tuned", 1e-3, 100)
    (suite,) = Xml.fromstring(junit([unfinished(cell, "unsupported", "no mass")], FACTS))
    assert (suite.get("errors"), suite.get("failures")) == ("1", "0")
