"""What stores, compares and shows cells takes those of elastic links."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from models.files import find_scene
from reports.cli import app
from reports.store.reader import read_store

STEPS = ["--engine", "mujoco", "--segments", "4", "--steps-per-turn", "720", "--turns", "1"]
NAME = "fourbar-elastic"


def crankcheck(*words: object, code: int = 0) -> str:
    """The output of a command, with its lines as one."""
    result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert result.exit_code == code, result.output
    return " ".join(result.output.split())


@pytest.fixture(scope="module")
def verified(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("elastic") / "verified"
    crankcheck("verify", "elastic", *STEPS, "--no-convergence", "--jobs", "1", "-o", folder)
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
        (["advise", NAME, "--dt", "0.01", "--speed", "7", "--target", "1e-3"], "takes rigid links"),
    ],
)
def test_what_makes_no_sense_is_refused(words: list[str], said: str) -> None:
    assert said in crankcheck(*words, code=2)


def test_errors_say_what_they_are_held_to() -> None:
    asked = ["--profile", "tuned", "--jobs", "1", "--no-convergence"]
    told = crankcheck("verify", "elastic", *STEPS, *asked)
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


def test_elastic_links_that_are_let_go_are_verified_where_they_are_named() -> None:
    asked = ["--engine", "mujoco", "--profile", "tuned", "--segments", "4", "--no-convergence"]
    asked += ["--duration", "0.05", "--jobs", "1"]
    told = crankcheck("verify", "fourbar-elastic-controlled", "fourbar-elastic-pulse", *asked)
    assert "elastic links, profile tuned" in told
    assert "WITHIN TOLERANCE" in told


def test_a_log_of_elastic_links_that_were_let_go_is_not_judged_either(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    crankcheck("run", "fourbar-elastic-pulse", "--segments", "2", "--duration", "0.05", "-o", log)
    told = crankcheck("judge", "fourbar-elastic-pulse", log, code=2)
    assert "logs of elastic links that are let go are not judged yet" in told


def test_what_is_let_go_is_swept_and_timed_over_the_step(tmp_path: Path) -> None:
    asked = ["--free", "--engine", "mujoco", "--profile", "tuned", "--segments", "4"]
    steps = ["--dt", "1e-3,5e-4", "--duration", "0.1", "--jobs", "1"]
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
