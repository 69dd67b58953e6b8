"""What stores, compares and shows cells takes those of elastic links."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

import crankcheck as face
from models.errors import CrankcheckError
from models.files import find_scene, load_scene
from reports.cli import app
from reports.plan.chosen_study import StudyChoice, chosen_study
from reports.plan.elastic import counted_released
from reports.plan.free import scenes_of, under_control
from reports.plan.grid import grid
from reports.plan.study import load_study
from reports.store.reader import read_store
from tests.worlds.in_process import in_this_process
from tests.worlds.tiers import few, slowly

STEPS = ["--engine", "mujoco", "--segments", "4", "--steps-per-turn", "720", "--turns", "1"]
NAME, CONTROLLED = "fourbar-elastic", "fourbar-elastic-controlled"


def crankcheck(*words: object, code: int = 0) -> str:
    """The output of a command, with its lines as one."""
    with in_this_process():
        result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert result.exit_code == code, result.output
    return " ".join(result.output.split())


@pytest.fixture(
    scope="module",
    params=few([NAME, "elastic"], {NAME}, "seconds for the truth of each: a group is a list"),
)
def verified(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    folder = tmp_path_factory.mktemp("elastic") / "verified"
    crankcheck("verify", request.param, *STEPS, "--no-convergence", "--jobs", "1", "-o", folder)
    return folder


def test_a_verification_is_kept_with_what_links_were_given_as(verified: Path) -> None:
    document = json.loads((verified / "verify.json").read_text())
    rows = document["cells"]
    assert {(row["segments"], row["springs"]) for row in rows} == {(4, "plain")}
    assert rows[0]["place_pure"] == rows[0]["deflection_pure"]
    assert rows[0]["chain_pure"] == pytest.approx(0.05, rel=0.1)


def test_a_verification_is_compared_with_itself(verified: Path) -> None:
    assert "0 worse" in crankcheck("diff", verified, verified)


def test_a_sweep_has_a_line_for_every_number_of_segments(tmp_path: Path) -> None:
    asked = ["--engine", "mujoco", "--profile", "tuned", "--segments", "3,4", "--no-timing"]
    told = crankcheck(
        "sweep", NAME, "-o", tmp_path / "store", *asked, "--turns", "1", "--jobs", "1"
    )
    assert "6 run now" in told  # the steps that they hold, twice and four times these
    page = tmp_path / "report.html"
    assert "not whole" not in crankcheck("report", tmp_path / "store", "-o", page)
    assert "3 segments" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["verify", "fourbar-lecture-1", "--segments", "4"], "no scene has one"),
        (["verify", "elastic", "--segments", "1"], "a link bends with 2 segments or more"),
        (["verify", "elastic", "--springs", "soft"], "use plain, corrected or beam"),
        (["verify", NAME, "--free"], "what is let go comes back after no period"),
        (
            ["tune", NAME, "--engine", "mujoco", "--target", "1e-3"],
            f"`crankcheck sweep {NAME} --segm",
        ),
        (
            ["tune", "fourbar-elastic-pulse", "--engine", "mujoco", "--target", "1e-3"],
            "`crankcheck sweep fourbar-elastic-pulse --free --segments 4,8,16 -o DIR`",
        ),
        (
            ["tune", CONTROLLED, "--engine", "mujoco", "--target", "1e-3"],
            f"`crankcheck sweep {CONTROLLED} --free --segments 4,8,16 -o DIR`",
        ),
        (
            ["sweep", CONTROLLED, "--engine", "mujoco", "--segments", "4", "-o", "none"],
            "it has no turns; `crankcheck sweep --free` lets it go so",
        ),
        (["advise", NAME, "--dt", "0.01", "--speed", "7", "--target", "1e-3"], "takes rigid links"),
    ],
)
def test_what_makes_no_sense_is_refused(words: list[str], said: str) -> None:
    assert said in crankcheck(*words, code=2)


def test_errors_say_what_they_are_held_to() -> None:
    asked = ["--profile", "tuned", "--jobs", "1", "--no-convergence"]
    told = crankcheck("verify", NAME, *STEPS, *asked)
    assert "against the solved motion of the beam with foreshortening" in told
    assert "closed form" not in told
    asked += ["--engine", "mujoco", "--duration", "0.1"]
    assert "closed form" not in crankcheck("verify", "fourbar-swing", *asked)


def test_a_sweep_of_both_steps_elastic_links_as_their_segments_ask(tmp_path: Path) -> None:
    """With the shipped study's steps, of which segments hold hardly any, all would come apart."""
    asked = ["--engine", "mujoco", "--profile", "tuned", "--segments", "3", "--no-timing"]
    folder = tmp_path / "store"
    told = crankcheck("sweep", NAME, "fourbar-lecture-1", "-o", folder, *asked, "--jobs", "1")
    assert "10 run now" in told
    assert "diverged" not in told
    stored = read_store(folder)
    assert not stored.notice  # it is whole
    cells = stored.cells
    steps = cells[cells["scene"] == NAME]["steps_per_turn"]
    assert sorted(steps / steps.min()) == [1.0, 2.0, 4.0]
    assert cells["segments"].isna().sum() == 7


@pytest.mark.parametrize(
    "names",
    [
        ["fourbar-elastic-pulse"],
        slowly(["fourbar-elastic-pulse", CONTROLLED], reason="the controller's truth: two seconds"),
    ],
)
def test_elastic_links_that_are_let_go_are_verified_where_they_are_named(names: list[str]) -> None:
    asked = ["--engine", "mujoco", "--profile", "tuned", "--segments", "4", "--no-convergence"]
    asked += ["--duration", "0.3", "--jobs", "1"]
    told = crankcheck("verify", *names, *asked)
    assert "elastic links, profile tuned" in told
    assert "WITHIN TOLERANCE" in told


@pytest.mark.parametrize("name", ["fourbar-elastic-pulse", CONTROLLED])
def test_a_log_of_elastic_links_that_were_let_go_is_not_judged_either(
    name: str, tmp_path: Path
) -> None:
    log = tmp_path / "log.csv"
    asked = ["--segments", "2", "--duration", "0.05"]
    assert "next:" not in crankcheck("run", name, *asked, "-o", log)
    said = "logs of elastic links that are let go are not judged yet"
    for free in ([], ["--free"]):
        assert said in crankcheck("judge", name, log, "--target", "1e-3", *free, code=2)
    frame = pd.read_csv(log)
    with pytest.raises(CrankcheckError, match=said):
        face.judge(name, frame, target=1e-3, segments=2)
    with pytest.raises(CrankcheckError, match=said):
        face.compare(name, frame, segments=2)


def test_a_check_in_turns_of_what_a_controller_drives_says_what_takes_it() -> None:
    with pytest.raises(CrankcheckError, match="it has no turns; `run` runs it"):
        face.check(CONTROLLED, segments=4)


def test_what_a_controller_drives_keeps_it_when_it_is_let_go() -> None:
    (own,) = scenes_of([CONTROLLED], free=True)
    assert own.is_free
    assert own == under_control(load_scene(CONTROLLED))
    assert own.loads


def test_a_sweep_of_what_is_let_go_steps_elastic_links_as_their_segments_ask() -> None:
    """At 4 ms all would come apart."""

    def steps(name: str, **choice: object) -> list[float]:
        asked = StudyChoice([name], ["mujoco"], ["tuned"], free=True, segments=[4], **choice)  # type: ignore[arg-type]
        study = chosen_study(load_study(None), asked, is_shipped=True)
        return [task.cell.dt_s for task in grid(study).tasks]

    for name in ("fourbar-elastic-pulse", CONTROLLED):
        own = under_control(load_scene(name))
        held_s, _ = counted_released(own, None, 0.1, 4, "plain")
        assert steps(name, duration_s=0.1) == [held_s, held_s / 2, held_s / 4]
        assert steps(name, duration_s=0.1, dt_s=[5e-4]) == [5e-4]


def test_what_is_let_go_is_swept_and_timed_over_the_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.sweep.measured.REPEAT_S", 1e-5)  # nobody compares these times
    asked = ["--free", "--engine", "mujoco", "--profile", "tuned", "--segments", "4"]
    steps = ["--dt", "1e-3,5e-4", "--duration", "0.3", "--jobs", "1"]
    told = crankcheck("sweep", "fourbar-elastic-pulse", "-o", tmp_path / "s", *asked, *steps)
    assert "2 run now" in told
    assert "2 timed now" in told


@pytest.mark.parametrize("name", [NAME, "fourbar-elastic-pulse"])
def test_a_link_that_stretches_alone_is_a_row_with_its_reason(name: str, tmp_path: Path) -> None:
    text = find_scene(name).read_text(encoding="utf-8")
    stretched = text.replace(
        "[elastic.coupler]", "[elastic.coupler]\nbends = false\nstretches = true"
    )
    (tmp_path / "axial.toml").write_text(stretched.replace("periodic", "quasi-static"))
    told = crankcheck("verify", tmp_path / "axial.toml", "--engine", "mujoco", code=2)
    assert "elastic.coupler stretches, and a chain of segments does not" in told
