"""Logs of elastic links are judged as runs are: beside the beam, and beside the exact chain."""

from __future__ import annotations

import shlex
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

import crankcheck as face
from reports.cli import app

NAME = "fourbar-elastic"
STEPS = ["--segments", "4", "--steps-per-turn", "720", "--turns", "1"]
STEP_S = 0.0011843018022380978
FEW = ["--step", STEP_S, "--segments", "4"]


def crank(*words: object, code: int = 0) -> str:
    """The output of a command, with its lines as one."""
    result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert result.exit_code == code, result.output
    return " ".join(result.output.split())


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("elastic") / "log.csv"


@pytest.fixture(scope="module")
def said(log: Path) -> str:
    """What `run` says when it has written the log."""
    return crank("run", NAME, *STEPS, "-o", log)


def changed(said: str, log: Path, column: str, factor: float) -> Path:
    """The log with one of its columns times a factor."""
    frame = pd.read_csv(log)
    frame[column] *= factor
    path = log.with_name(f"{column}-{factor:g}.csv")
    frame.to_csv(path, index=False)
    return path


def test_the_log_of_a_run_is_judged_by_the_command_that_run_tells(
    said: str, log: Path, tmp_path: Path
) -> None:
    head = log.read_text().splitlines()[0]
    assert "coupler_deflection_m" in head
    assert "coupler-1" not in head
    words = shlex.split(said.partition("next: crankcheck ")[2])
    told = crank(*words, "-o", tmp_path / "log.html")
    assert "deflection of coupler" in told
    assert "segments of coupler" in told
    assert "closed form" not in told
    assert (tmp_path / "log.html").stat().st_size > 100_000


@pytest.mark.parametrize(
    ("column", "factor", "rule"),
    [
        ("coupler_deflection_m", 1.05, "CC132"),
        ("coupler_deflection_m", 0.8, "CC131"),
        ("coupler_extension_m", 300.0, "CC133"),
        ("rocker_theta_rad", 1.0001, "CC103"),
    ],
)
def test_what_is_wrong_in_a_log_is_seen(
    said: str, log: Path, column: str, factor: float, rule: str
) -> None:
    told = crank("judge", NAME, changed(said, log, column, factor), *FEW, code=1)
    assert rule in told
    assert "causes are not looked for where links bend" in told


def test_other_segments_than_were_run_are_seen(said: str, log: Path) -> None:
    assert "CC132" in crank("judge", NAME, log, "--step", STEP_S, "--segments", "8", code=1)


def test_a_drive_of_its_own_and_a_frame_of_python_are_told(said: str, log: Path) -> None:
    told = crank("judge", NAME, log, *FEW, "--drive", "fitted", code=2)
    assert "leave --drive out" in told
    verdict = face.judge(NAME, log, step_s=STEP_S, segments=4)
    assert verdict.verdict == "within"
    errors = face.compare(NAME, pd.read_csv(log), segments=4)
    assert "deflection" in {row.quantity for row in errors.errors.rows}
    with pytest.raises(face.CrankcheckError, match="segments"):
        face.judge("fourbar-lecture-1", log, step_s=STEP_S, segments=4)


def test_a_motion_in_memory_has_its_deflection(said: str) -> None:
    run = face.run(NAME, segments=4, steps_per_turn=720, turns=1)
    assert run.motion is not None
    verdict = face.judge(NAME, run.motion, step_s=STEP_S, segments=4)
    assert "coupler_deflection_m" in str(verdict)


def test_rigid_links_have_no_deflection(tmp_path: Path) -> None:
    path = tmp_path / "rigid.csv"
    crank("run", "fourbar-lecture-1", "--turns", "1", "-o", path)
    frame = pd.read_csv(path).assign(coupler_deflection_m=0.0)
    frame.to_csv(path, index=False)
    told = crank("judge", "fourbar-lecture-1", path, "--target", "1e-2")
    assert "coupler_deflection_m: 'deflection' is no kind of reading of a link" in told


@pytest.mark.parametrize(
    ("elements", "steps", "springs"), [(4, 360, "beam"), (8, 720, "beam"), (4, 720, "plain")]
)
def test_a_log_starts_within_the_limit_of_its_run(elements: int, steps: int, springs: str) -> None:
    """Joints are solved for, whatever the beam is off by in its places."""
    run = face.run(
        NAME, engine="exudyn", segments=elements, springs=springs, steps_per_turn=steps, turns=1
    )
    of_run = face.judge(NAME, run)
    assert run.motion is not None
    step_s = 720.0 / steps * STEP_S
    of_log = face.judge(NAME, run.motion, step_s=step_s, segments=elements, springs=springs)
    assert (of_run.verdict, of_log.verdict) == ("within", "within")
    first, second = (
        next(finding.limit for finding in verdict.findings if finding.rule == "CC116")
        for verdict in (of_run, of_log)
    )
    assert first == pytest.approx(second, rel=1e-6)
