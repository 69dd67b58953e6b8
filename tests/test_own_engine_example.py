"""The engine of examples/engine as its reader has it: spelled, installed, swept, with faults."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from reports.cli import app
from reports.selftest.all_faults import FAULTS
from reports.selftest.trial import sites
from sim.registry import engine
from tests.test_architecture import ROOT
from tests.worlds.own_engines import CODE, EXAMPLE, fresh, installed, with_faults
from tests.worlds.tiers import slow

Crank = Callable[..., Result]
THREE_FAULTS = {
    "velocity_shift=SHIFT": "velocity_shift=0.5",
    "VERSION, check, PenaltySession": "VERSION, lambda settings: None, PenaltySession",
    "        check(settings)\n": "",
    "[every] * (steps // every)": "[every] * (steps // every - 1)",
}
"""Velocities of another instant, every setting taken, a sample less."""


@pytest.fixture
def crank(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Crank]:
    """The command, in a folder; only its workers are processes of their own."""

    def invoked(*arguments: str) -> Result:
        return CliRunner(env={"COLUMNS": "120"}).invoke(app, arguments)

    (tmp_path / "home").mkdir()
    with fresh(tmp_path / "home", monkeypatch):
        yield invoked


def test_it_is_one_short_file_that_imports_the_public_names_alone() -> None:
    lines = CODE.splitlines()
    assert len(lines) < 150
    imports = [line for line in lines if line.startswith(("import", "from"))]
    assert imports == ["import time", "import numpy as np", "import crankcheck.engine as cc"]


def test_installed_it_is_listed_checked_swept_and_shown(
    crank: Crank, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two workers are started; nothing less shows that they find it."""
    site = tmp_path / "site"
    site.mkdir()
    installed(site)
    monkeypatch.syspath_prepend(site)
    listed = " ".join(crank("engines", "--settings").output.split())
    assert "penalty 1.0 as-shipped" in listed
    assert "stiffness = 0.8: a six-bar is unstable" in listed
    checked = crank("engines", "check", "penalty", "--clause", "EC41")
    assert checked.exit_code == 0, checked.output
    assert "HOLDS THE CONTRACT: penalty 1.0, 1 of 1 clause" in checked.output
    Path("study.toml").write_text(
        'scenes = ["fourbar-lecture-1"]\nsteps_per_turn = [90, 180, 360]\n'
        '[[variants]]\nengine = "penalty_engine:ENGINE"\nprofile = "tuned"\n'
    )
    swept = crank("sweep", "--study", "study.toml", "-o", "out", "--no-timing", "--jobs", "1")
    assert swept.exit_code == 0, swept.output
    assert "3 cells: 3 run now" in swept.output
    shown = crank("report", "out", "--format", "md", "-o", "summary.md")
    assert shown.exit_code == 0, shown.output
    summary = Path("summary.md").read_text()
    assert "penalty 1.0" in summary
    assert "penalty_engine" not in summary
    assert crank("diff", "out", "out").exit_code == 0


@slow("the clauses that find them have wrong engines of their own in tests/reports/contract")
def test_three_faults_are_each_named_with_their_cure(crank: Crank) -> None:
    Path("faulty_penalty.py").write_text(with_faults(THREE_FAULTS))
    clauses = [word for each in ("EC11", "EC13", "EC32", "EC41") for word in ("--clause", each)]
    done = crank("engines", "check", "faulty_penalty:ENGINE", *clauses, "--jobs", "1")
    assert done.exit_code == 1, done.output
    words = " ".join(done.output.split())
    assert "ok EC11" in words
    assert "OUT EC13 a wrong setting is refused with SettingError" in words
    assert "OUT EC32 a log holds the current sample" in words
    assert "record gave 40 samples, and has to give 41" in words
    assert "OUT EC41 velocities belong to the instant" in words
    assert "cure: In check, call check_ranges for the numbers" in words
    assert "BREAKS THE CONTRACT: penalty 1.0, 3 clauses of 4: EC13, EC32, EC41" in words


def test_it_is_out_of_tolerance_by_its_own_name(crank: Crank) -> None:
    Path("penalty_engine.py").write_text(CODE)
    own = ("--engine", "penalty_engine:ENGINE")
    verified = crank("verify", "fourbar-lecture-1", *own, "--profile", "tuned", "--turns", "1")
    assert verified.exit_code == 1, verified.output
    assert "OUT  fourbar-lecture-1, penalty, tuned" in verified.output
    assert "order 2.0" in verified.output


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("tune fourbar-lecture-1 --target 1e-3 --engine", "engine penalty: it has no knobs"),
        ("history 1.0", "history penalty: it has released versions of mujoco"),
        ("verify slotted-lever --engine", "slotted-lever, penalty, tuned: penalty: it has no slid"),
        ("run slotted-lever -o log.csv --engine", "slotted-lever, penalty: unsupported: penalty"),
        ("verify fourbar-lecture-1 --drive servo --engine", "penalty: it has no servo"),
        ("selftest --fault joint-dropped --engine", "found --engine penalty"),
    ],
)
def test_what_it_has_not_is_said(crank: Crank, command: str, words: str) -> None:
    Path("penalty_engine.py").write_text(CODE)
    name, *rest = command.split()
    spelled = "penalty_engine:ENGINE"
    line = [name, *rest, spelled] if name != "history" else [name, spelled, *rest]
    done = crank(*line)
    assert done.exit_code == 2, done.output
    assert words in " ".join(done.output.split())
    assert not Path("log.csv").exists()


def test_faults_are_planted_where_it_holds_the_scene(crank: Crank) -> None:
    Path("penalty_engine.py").write_text(CODE)
    engine("penalty_engine:ENGINE")
    assert sites([FAULTS["row-lost"]], ["penalty"]) == [("fourbar-lecture-1", "penalty")]


@slow("pip and a whole contract in 8 s; without it, each clause is checked in the process")
def test_pip_installs_it_from_its_folder_and_it_holds_the_contract(tmp_path: Path) -> None:
    source = tmp_path / "source"
    source.mkdir()
    for path in EXAMPLE.glob("*.*"):
        (source / path.name).write_bytes(path.read_bytes())
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation"]
    site = tmp_path / "site"
    subprocess.run([*pip, "--target", str(site), str(source)], check=True)
    done = subprocess.run(
        [sys.executable, "-P", "-m", "crankcheck", "engines", "check", "penalty"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{site}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "HOLDS THE CONTRACT: penalty 1.0, 24 of 24 clauses" in done.stdout
