"""`check_model`: a model of one's own as a value, and what is refused at the call."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import pandas as pd
import pytest

import crankcheck
from reports.drawing.svg import svg
from tests.worlds.in_process import Here
from tests.worlds.own_models import CROWDED, FACTS, SLIDER_CRANK, judged
from tests.worlds.tiers import slow


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("model") / "engine.xml"
    path.write_text(SLIDER_CRANK)
    return path


def checked(model: Path) -> crankcheck.ModelVerdict:
    return crankcheck.check_model(model, "motor", -10.0, turns=0.5, converge=False)


@pytest.fixture(scope="module")
def verdict(model: Path) -> crankcheck.ModelVerdict:
    """Read and run in this process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.own_model.account.Isolated", Here)
        patch.setattr("reports.own_model.running.Isolated", Here)
        return checked(model)


@slow("a second for the start of processes, as a user has it")
def test_processes_apart_give_the_same(model: Path, verdict: crankcheck.ModelVerdict) -> None:
    apart = checked(model)
    pd.testing.assert_frame_equal(apart.frame(), verdict.frame())
    assert apart.patch == verdict.patch


def test_it_is_a_value_with_its_verdict_lines_scene_and_diff(
    verdict: crankcheck.ModelVerdict,
) -> None:
    assert verdict.verdict == "out"
    assert "CC105" in {finding.rule for finding in verdict.failures}
    assert set(verdict.failures) <= set(verdict.findings)
    assert [line.cell.profile for line in verdict.lines][:2] == ["as-written", "contacts-off"]
    assert list(verdict.scene.links) == ["crank", "rod"]
    assert verdict.patch.startswith("--- engine.xml\n")
    assert verdict.facts["mujoco"] == verdict.own.version
    assert verdict == verdict
    assert pickle.loads(pickle.dumps(verdict)).patch == verdict.patch


def test_its_frame_has_every_error_of_every_line(verdict: crankcheck.ModelVerdict) -> None:
    frame = verdict.frame()
    assert list(frame["profile"].unique()) == [line.cell.profile for line in verdict.lines]
    gaps = frame[(frame["quantity"] == "gap") & (frame["profile"] == "as-written")]
    assert set(gaps["body"]) == {joint.name for joint in verdict.joints()}


def test_it_prints_the_table_and_a_notebook_shows_the_mechanism(
    verdict: crankcheck.ModelVerdict,
) -> None:
    assert str(verdict) == repr(verdict)
    assert "OUT OF TOLERANCE as written" in str(verdict)
    page = verdict._repr_html_()
    assert "<svg" in page
    assert "recommended" in page
    assert "<option" not in page


def test_a_linkage_that_goes_through_no_whole_turn_is_drawn_as_far_as_it_went() -> None:
    """Driven at its rocker, which swings."""
    one = judged(CROWDED, "ankle", turns=0.02, dt_s=1e-4)
    swung = crankcheck.ModelVerdict(account=one.account, lines=one.lines, facts=FACTS)
    assert "<svg" in swung._repr_html_()
    with pytest.raises(crankcheck.ReachError):
        svg(one.scene)


REFUSED = {
    "model: found 3; give a path": {"model": 3},
    "drive: found None; give a name": {"drive": None},
    "drive is missing": {"drive": ""},
    "speed_rad_s: found 'x'; give a number": {"speed_rad_s": "x"},
    "speed_rad_s 0: give that of the crank": {"speed_rad_s": 0},
    "start_rad nan: give an angle": {"start_rad": math.nan},
    "branch: found 3; give a dict": {"branch": 3},
    "branch C: found 2; it is 1 or -1": {"branch": {"C": 2}},
    "dt_s: found 'x'; give a number above 0": {"dt_s": "x"},
    "dt_s and steps_per_turn: both set the step": {"dt_s": 1e-3, "steps_per_turn": 100},
    "tolerance 'angel': it is no quantity": {"tolerance": {"angel": 1.0}},
    "converge: found 1; give True or False": {"converge": 1},
    "limit_s 0: give a number above 0": {"limit_s": 0},
}


@pytest.mark.parametrize("message", REFUSED)
def test_an_argument_that_is_none_is_refused_in_the_words_of_the_call(
    message: str, model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from reports.face import model_verdict
    from reports.own_model.account import read_here

    monkeypatch.setattr(model_verdict, "read", lambda request, _: read_here(request))
    given = {"model": model, "drive": "motor", "speed_rad_s": 10.0, **REFUSED[message]}
    with pytest.raises(crankcheck.CrankcheckError) as caught:
        crankcheck.check_model(**given)  # type: ignore[arg-type]
    assert message in str(caught.value)
    assert "--" not in str(caught.value)
