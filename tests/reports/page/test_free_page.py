"""The page of a store that holds what was let go, alone and beside what was driven."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from reports.page.build import page
from reports.page.sections import SECTIONS
from reports.page.sections.section import PageReport
from reports.results.recommend import recommendations
from reports.store.manifest import Manifest
from reports.store.reader import Stored, read_store
from tests.reports.page.hostile import Outline
from tests.reports.page.tab import Tab
from tests.worlds.free_store import SCENE

FREE = ["verdict", "free", "stability", "fairness", "provenance"]


@pytest.fixture(scope="module")
def free(free_store: Path) -> Stored:
    return read_store(free_store)


@pytest.fixture(scope="module")
def path(free: Stored, written: Callable[[str], Path]) -> Path:
    return written(page(free))


def embedded(report: PageReport, name: str) -> dict[str, object]:
    section = SECTIONS[name](report)
    return json.loads(json.dumps(section.embedded, default=list))


def test_a_page_of_free_runs_has_no_section_that_speaks_of_turns(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert Outline(text).sections() == FREE
    told = text[: text.index('id="provenance"')]
    assert "free drive" not in told  # where all were let go it needs no word
    assert "steps a turn" not in told
    assert "closed form" not in told


def test_what_was_driven_keeps_its_sections_beside_what_was_let_go(
    small: Stored, free: Stored
) -> None:
    cells = pd.concat([small.cells, free.cells], ignore_index=True)
    scenes = {**small.manifest.scenes, **free.manifest.scenes}
    both = replace(small, manifest=Manifest(scenes, small.manifest.runs), cells=cells)
    vars(both)["_traces"] = {**small._traces, **free._traces}
    report = PageReport(both)
    assert SCENE not in report.driven.scenes
    assert {x.number for x in report.driven.looks.values()} <= {
        x.number for x in report.looks.values()
    }
    assert [each["name"] for each in embedded(report, "free")["scenes"]] == [SCENE]
    for line in report.driven.lines:
        assert report.driven.look(line) == report.look(line)


def test_without_anything_let_go_the_driven_part_is_the_whole(small: Stored) -> None:
    report = PageReport(small)
    assert report.driven is report
    assert SECTIONS["free"](report) is None


def test_every_free_run_moves_with_its_courses(free: Stored) -> None:
    shown = embedded(PageReport(free), "free")["scenes"][0]
    assert len(shown["lines"]) == 4
    for line in shown["lines"]:
        assert [cell["dt"] for cell in line["cells"]] == ["4.00 ms", "2.00 ms"]
        for cell in line["cells"]:
            assert cell["off"] is not None
            assert {"phase", "phase_judged", "angle", "speed", "energy"} <= set(cell["names"])


def test_columns_of_stability_stand_under_their_engines(free: Stored) -> None:
    section = SECTIONS["stability"](PageReport(free))
    assert dict(section.words["engines"]) == {"mujoco": 2, "pymunk": 2}
    assert [look.engine for look in section.words["looks"]] == ["mujoco"] * 2 + ["pymunk"] * 2


def test_a_free_run_is_drawn_and_every_choice_has_curves(wide: Tab, path: Path) -> None:
    seen = wide.open(path, "free").page
    for course in ("phase_judged", "phase", "energy", "speed", "angle", "portrait"):
        seen.select_option("#free-course", course)
        seen.wait_for_function(
            "() => document.getElementById('free-chart').data.some(each => each.x.length > 50)"
        )
        titles = seen.evaluate(
            "() => document.getElementById('free-chart').layout.yaxis.title.text"
        )
        assert titles
    before = wide.drawn("#free-picture .overlays path")[0]
    wide.slide("free-slider", 300)
    assert wide.drawn("#free-picture .overlays path")[0] != before
    assert "0.417 s" in seen.locator("#free-angle").inner_text()
    assert wide.said == []
    assert wide.asked == [wide.file.as_uri()] or all(x.startswith("file") for x in wide.asked)


def test_settings_of_free_motion_are_to_be_copied(free: Stored) -> None:
    """Each is led by what it promises, has the step that was run, and no speed of a crank."""
    cells = free.cells.assign(us_per_step=1.0, s_per_turn=1e-3)
    timed = replace(free, cells=cells)
    found = [one for one in recommendations(timed) if not one.reason]
    assert {one.best.engine for one in found} == {"mujoco", "pymunk"}
    for one in found:
        text = one.snippet()
        assert repr(1.0 / one.best.steps_per_turn) in text
        assert "place over the sensitivity" in " ".join(text.split())
        assert "Drive: none." in text
        assert "crank at" not in text
        assert "speed)" not in text
    section = SECTIONS["free"](PageReport(timed))
    assert "copying.js" in section.scripts
    assert "To be copied" in page(timed)
