"""What fails is tried with what its engine has against it, and nothing else is run again; and JUnit
XML is valid, whatever a reason or a source holds."""

from dataclasses import replace
from xml.etree import ElementTree as Xml

import pytest

from models.files.reading import load_scene
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check, unfinished
from reports.output.formats import junit
from reports.verify import advised as advice
from reports.verify.advised import advised
from reports.verify.table import suite
from tests.worlds.turns import of_turns


def cures(checked: Checked) -> set[str]:
    return {finding.cure for finding in checked.failures}


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[Cell]:
    asked: list[Cell] = []

    def noted(one: Cell) -> Checked:
        asked.append(one)
        return check(one)

    monkeypatch.setattr(advice, "check", noted)
    return asked


def test_a_setting_that_helps_is_named_with_what_it_leaves(runs: list[Cell]) -> None:
    scene = load_scene("slider-crank-offset")  # a light rod between the crank and a heavy block
    block = replace(scene.sliders["C"], mass_kg=1.5e4 * scene.links["rod"].mass_kg)
    found = advised(of_turns(replace(scene, sliders={"C": block})))
    (told,) = cures(found)
    assert told.startswith("Tried at the same step: sweep --set mujoco.solref_timeconst_steps=2 ")
    worst = max(f.number / f.limit for f in found.failures if f.number and f.limit)
    assert told.endswith(f"of its limit instead of {worst:.2g}.")
    assert runs[-1].settings == {"solref_timeconst_steps": 2}
    assert {(one.dt_s, one.steps) for one in runs} == {(found.cell.dt_s, found.cell.steps)}


def test_where_nothing_helps_all_that_was_tried_is_named_and_half_the_step_told() -> None:
    (told,) = cures(advised(of_turns("fourbar-lecture-1", tolerance={"angle": 1e-12})))
    assert told.startswith("No tried setting lowers the error threefold at the same step: ")
    for setting in ("close=B", "close=D", "solref_timeconst_steps=2", "solref_dampratio=0.3"):
        assert f"mujoco.{setting}" in told
    assert "Half the step leaves" in told


@pytest.mark.parametrize("asked", [{}, {"profile": "as-shipped"}, {"drive": "servo"}])
def test_what_is_within_or_cured_is_not_run_again(runs: list[Cell], asked: dict[str, str]) -> None:
    advised(of_turns("fourbar-lecture-1", **asked))
    assert len(runs) == 1


def test_any_text_gives_valid_xml_and_what_can_not_run_is_no_failure(fourbar: Scene) -> None:
    cell = Cell(replace(fourbar, name="x<y&z"), "mujoco", "tuned", 1e-3, 100)

    def read(status: str, reason: str) -> Xml.Element:
        facts = {"crankcheck": "1", "made": "2026-01-01T00:00:00+00:00"}
        (one,) = Xml.fromstring(junit(suite([unfinished(cell, status, reason)], facts)).encode())
        assert one.find("testcase").get("name") == "x<y&z"
        return one

    for reason in (
        "<a> & \"b\" 'c'",
        "bell \x07 null \x00",
        "]]>",
        "\ud800 alone",
        "\u202e turned",
    ):
        assert read("diverged", reason).get("failures") == "1"
    lacking = read("unsupported", "no mass")
    assert (lacking.get("errors"), lacking.get("failures")) == ("1", "0")
