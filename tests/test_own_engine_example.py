"""The engine of examples/engine as its reader has it: spelled, installed, swept, with faults."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from reports.selftest.trial import FAULTS, sites
from sim.registry import engine
from tests.worlds.command_line import flat, told
from tests.worlds.in_process import Here, in_this_process
from tests.worlds.own_engines import CODE, fresh, installed


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A folder with the engine, in which only workers are processes of their own."""
    monkeypatch.setenv("COLUMNS", "120")
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "penalty_engine.py").write_text(CODE)
    with fresh(tmp_path / "home", monkeypatch):
        yield


def test_it_is_one_short_file_that_imports_the_public_names_alone() -> None:
    lines = CODE.splitlines()
    assert len(lines) < 150
    imports = [line for line in lines if line.startswith(("import", "from"))]
    assert imports == ["import time", "import numpy as np", "import crankcheck.engine as cc"]


def test_installed_it_is_listed_checked_swept_and_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker is started for the sweep; nothing less shows that it finds it."""
    Path("penalty_engine.py").unlink()
    site = tmp_path / "site"
    site.mkdir()
    installed(site)
    monkeypatch.syspath_prepend(site)
    listed = flat(told("engines --settings"))
    assert "penalty 1.0 as-shipped" in listed
    assert "stiffness = 0.8: a six-bar is unstable" in listed
    with in_this_process() as patch:
        patch.setattr("reports.contract.ruling.Isolated", Here)
        checked = told("engines check penalty --clause EC41")
    assert "HOLDS THE CONTRACT: penalty 1.0, 1 of 1 clause" in checked
    Path("study.toml").write_text(
        'scenes = ["fourbar-lecture-1"]\nsteps_per_turn = [90, 180]\n'
        '[[variants]]\nengine = "penalty_engine:ENGINE"\nprofile = "tuned"\n'
    )
    swept = told("sweep --study study.toml -o out --no-timing --jobs 1")
    assert "2 cells: 2 run now" in swept
    told("report out --format md -o summary.md")
    summary = Path("summary.md").read_text()
    assert "penalty 1.0" in summary
    assert "penalty_engine" not in summary


def test_it_is_out_of_tolerance_by_its_own_name_where_faults_are_planted_too() -> None:
    own = "--engine penalty_engine:ENGINE --profile tuned --turns 1"
    with in_this_process():
        said = told(f"verify fourbar-lecture-1 {own}", code=1)
    assert "OUT  fourbar-lecture-1, penalty, tuned" in said
    assert "order 2.0" in said
    engine("penalty_engine:ENGINE")
    assert sites([FAULTS["row-lost"]], ["penalty"]) == [("fourbar-lecture-1", "penalty")]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("tune fourbar-lecture-1 --target 1e-3 --engine X", "engine penalty: it has no knobs"),
        ("history X 1.0", "history penalty: only mujoco"),
        ("verify slotted-lever --engine X", "slotted-lever, penalty, tuned: penalty: it has no sl"),
        ("selftest --fault joint-dropped --engine X", "found --engine penalty"),
    ],
)
def test_what_it_has_not_is_said(line: str, words: str) -> None:
    with in_this_process():
        assert words in flat(told(line.replace("X", "penalty_engine:ENGINE"), code=2))
