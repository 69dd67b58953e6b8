"""What stores, compares and shows cells takes those of elastic links."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reports.cli import app

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


def test_a_run_is_logged_as_the_scene_and_not_judged_as_a_log(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    crankcheck("run", NAME, *STEPS, "-o", log)
    head = log.read_text().splitlines()[0]
    assert "coupler_theta_rad" in head
    assert "coupler-1" not in head
    assert "logs of elastic links are not judged yet" in crankcheck("judge", NAME, log, code=2)


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
        (["verify", "elastic", "--springs", "soft"], "use plain or corrected"),
        (["verify", NAME, "--free"], "is let go and has elastic links"),
        (["tune", NAME, "--engine", "mujoco", "--target", "1e-3"], "takes rigid links"),
        (["advise", NAME, "--dt", "0.01", "--speed", "7", "--target", "1e-3"], "takes rigid links"),
    ],
)
def test_what_makes_no_sense_is_refused(words: list[str], said: str) -> None:
    assert said in crankcheck(*words, code=2)
