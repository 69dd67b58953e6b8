"""The page of a store whose links bend, alone and beside what is driven with rigid ones."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest
from rich.console import Console

from reports.cli.commands import sweep as command
from reports.cli.commands.figures import _planned
from reports.cli.measuring import SweepRequest
from reports.figures import convergence, work_precision
from reports.figures.style import styled
from reports.page.build import page
from reports.page.comment import summary
from reports.page.sections import SECTIONS
from reports.page.sections.section import PageReport
from reports.results.drawable import PLACE_ELASTIC
from reports.results.recommend import ELASTIC_TARGETS, Recommendation, recommendations
from reports.results.table import recommendation_table
from reports.store.manifest import Manifest
from reports.store.reader import Stored, read_store
from tests.reports.page.hostile import Outline
from tests.reports.page.tab import OUT, Tab
from tests.worlds.in_process import in_this_process
from tests.worlds.tiers import few, slowly

SCENE = "fourbar-elastic"


FINER = "finer steps, whose errors are the segments' own: other cells are recommended and drawn"


@pytest.fixture(scope="module", params=["360,720", slowly("720,1440", reason=FINER)])
def bent(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Stored:
    folder = tmp_path_factory.mktemp("elastic") / "store"
    nowhere = Console(file=StringIO())
    asked = SweepRequest(
        folder,
        scenes=(SCENE,),
        engines=("mujoco",),
        profiles=("tuned",),
        segments="3,4",
        steps_per_turn=request.param,
        turns=1.0,
        jobs=1,
    )
    with in_this_process() as patch:
        patch.setattr("reports.sweep.running.ROUNDS", 2)
        command.sweep(asked, nowhere, nowhere)
    return read_store(folder)


@pytest.fixture(scope="module")
def bent_path(bent: Stored, written: Callable[[str], Path]) -> Path:
    return written(page(bent))


def beside(small: Stored, bent: Stored) -> Stored:
    """Both in one store."""
    return replace(
        small,
        cells=pd.concat([small.cells, bent.cells], ignore_index=True),
        manifest=Manifest(
            runs=[*small.manifest.runs, *bent.manifest.runs],
            scenes={**small.manifest.scenes, **bent.manifest.scenes},
        ),
    )


def test_elastic_cells_have_a_section_with_their_own_heads(bent_path: Path) -> None:
    text = bent_path.read_text(encoding="utf-8")
    assert Outline(text).sections() == ["verdict", "elastic", "stability", "fairness", "provenance"]
    told = text[: text.index('id="provenance"')]
    assert "closed form" not in told
    assert "beam / D" in told
    assert "As tuned, 3 segments, it is within tolerance" in told


def test_what_is_rigid_keeps_its_sections_without_what_bends(small: Stored, bent: Stored) -> None:
    report = PageReport(beside(small, bent))
    assert SCENE not in report.driven.scenes
    section = SECTIONS["convergence"](report)
    assert "segments" not in json.dumps(section.embedded, default=list)
    assert SECTIONS["elastic"](report) is not None


def test_the_course_of_the_beam_is_that_of_the_engine_less_its_error(bent: Stored) -> None:
    line = PageReport(bent).elastic_lines[-1]
    trace = bent.trace(str(line.cells.iloc[-1]["key"]))
    largest = abs(trace["deflection.coupler"] - trace["deflection_error.coupler"]).max()
    off = abs(trace["deflection_error.coupler"]).max() / largest
    assert off == pytest.approx(line.cells.iloc[-1]["deflection_pure"], rel=0.02)


def told(found: tuple[Recommendation, ...]) -> str:
    console = Console(file=StringIO(), width=100)
    console.print(recommendation_table(found, 100))
    return console.file.getvalue()


def test_settings_are_recommended_by_the_deflection(small: Stored, bent: Stored) -> None:
    found = recommendations(bent)
    assert [one.target for one in found] == list(ELASTIC_TARGETS)
    assert "/ D" in told(found)
    assert "rad" not in told(found)
    text = found[0].snippet()
    assert "deflection (of the largest) within 0.1" in text
    assert "rigid segments, with a spring of rate EI n / l" in " ".join(text.split())
    assert "over the largest" in summary(bent)
    both = told(recommendations(beside(small, bent)))
    assert "rad" in both
    assert "/ D" in both


@pytest.mark.parametrize(
    "size", few(["wide", "phone"], {"wide"}, "sections of a page share their style")
)
def test_the_section_draws_and_keeps_within_the_window(
    bent_path: Path, size: str, request: pytest.FixtureRequest
) -> None:
    tab: Tab = request.getfixturevalue(size)
    page = tab.open(bent_path, "elastic").page
    page.locator("#elastic-course").select_option("error")
    page.locator("#elastic-error").select_option("segments_pure")
    names = "() => document.getElementById('elastic-chart').data.map(each => each.name)"
    assert any("mujoco tuned, 4 segments" in name for name in page.evaluate(names))
    if size == "phone":
        assert not page.evaluate(OUT)
    assert not tab.said


def test_figures_of_elastic_cells_say_what_their_errors_are_of(bent: Stored) -> None:
    report = PageReport(bent)
    for draw in (convergence.draw, work_precision.draw):
        with styled():
            figure = draw(report, SCENE)
        assert figure.axes[0].get_ylabel() == PLACE_ELASTIC
    assert f"convergence-{SCENE}" in _planned(report, ["convergence"], [])
