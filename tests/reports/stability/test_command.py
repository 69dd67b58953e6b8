"""`crankcheck stability` from the command line: the matrix, its files, and every mistake."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import Result

from models.errors import CrankcheckError
from reports.stability.catalogue import CATALOGUE
from reports.stability.matrix import read_matrix
from reports.workers.isolated import Lost
from tests.worlds.command_line import crank, crank_alone, flat, refused
from tests.worlds.in_process import Here, in_this_process
from tests.worlds.tiers import slow

LINE = ["stability", "grashof-excess", "--engine", "mujoco", "--profile", "tuned"]


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> tuple[Result, Path]:
    """A case in two profiles, printed and stored."""
    folder = tmp_path_factory.mktemp("matrix")
    args = ["stability", "grashof-excess", "wrong-branch", "--engine", "mujoco"]
    return crank_alone(*args, "-o", folder, "--jobs", 1), folder


def test_the_matrix_is_printed_with_critical_values(stored: tuple[Result, Path]) -> None:
    result, folder = stored
    assert result.exit_code == 0, result.output
    told = flat(result.stdout)
    assert told.endswith(f"{folder}: stability.json, stability.csv, stability.html")
    assert "mujoco tuned" in told
    assert "holds down to" in told
    assert "crankcheck stability CASE --engine ENGINE --profile PROFILE --at VALUE" in told
    assert "mujoco 4" in told
    assert max(map(len, result.stdout.splitlines())) <= 100


def test_every_run_is_stored_with_the_command_that_repeats_it(stored: tuple[Result, Path]) -> None:
    _, folder = stored
    rows = pd.read_csv(folder / "stability.csv")
    matrix = read_matrix(folder)
    assert len(rows) == len(matrix.runs) > 10
    lost = rows[(rows["case"] == "grashof-excess") & (rows["outcome"] != "ok")].iloc[-1]
    words = lost["command"].split()
    assert words[0] == "crankcheck"
    alone = crank_alone(*words[1:])
    assert alone.exit_code == 1
    assert lost["outcome"] in alone.stdout
    number = f"error of place, rad or over the longest link: {lost['error']:.3g}"
    assert number in flat(alone.stdout)


def test_the_page_and_the_pictures_of_failures_are_written(stored: tuple[Result, Path]) -> None:
    _, folder = stored
    matrix = read_matrix(folder)
    failed = {
        (run.profile, run.label)
        for run in matrix.runs
        if run.grid and run.outcome not in CATALOGUE[run.case].good
    }
    assert {(one.profile, one.label) for one in matrix.pictures} == failed
    assert (folder / "stability.html").stat().st_size > 10_000
    assert json.loads((folder / "stability.json").read_text(encoding="utf-8"))["format"] == 1


def test_a_second_run_takes_the_place_of_the_first(tmp_path: Path) -> None:
    args = ["stability", "wrong-branch", "--engine", "pymunk", "-o", str(tmp_path), "--jobs", "1"]
    assert crank_alone(*args).exit_code == crank_alone(*args).exit_code == 0
    assert {run.engine for run in read_matrix(tmp_path).runs} == {"pymunk"}


def test_a_few_cases_do_not_take_the_place_of_a_matrix_of_more(stored: tuple[Result, Path]) -> None:
    _, folder = stored
    before = (folder / "stability.json").read_bytes()
    result = crank("stability", "wrong-branch", "--engine", "pymunk", "-o", folder)
    refused(result, "holds a matrix with 1 case not run now")
    assert (folder / "stability.json").read_bytes() == before


def test_a_value_that_is_held_ends_with_0_and_one_that_is_not_with_1() -> None:
    held, lost = (crank_alone(*LINE, "--at", value) for value in ("1e-3", "1e-6"))
    assert (held.exit_code, "ok" in held.stdout) == (0, True)
    assert (lost.exit_code, "branch-changed" in lost.stdout) == (1, True)
    assert "driver 18" in lost.stdout


@pytest.mark.parametrize(
    ("args", "parts"),
    [
        (["stability", "grashof-exces"], ["grashof-exces", "did you mean grashof-excess"]),
        (["stability", "zzz"], ["'zzz': unknown; use grashof-excess"]),
        (["stability", "--at", "1e-3"], ["a value of one case", "name one"]),
        ([*LINE, "--at", "nan"], ["not a finite number"]),
        ([*LINE, "--at", "-0.5"], ["not above 0", "Grashof margin", "0.01 to 1e-6 m"]),
        ([*LINE, "--at", "5"], ["too far off", "0.01 to 1e-6 m"]),
        (["stability", "tiny-step", "--at", "1e-9"], ["too far off"]),
        ([*LINE, "--limit-s", "0"], ["--limit-s 0: give a number above 0"]),
        (["stability", "long-fourbar", "--at", "2.5"], ["not a whole number", "turns"]),
        (["stability", "wrong-branch", "--at", "5"], ["has the one value -1"]),
        (["stability", "coarse-step", "--at", "5"], ["at least 8"]),
        ([*LINE, "--at", "1e-3", "-o", "x"], ["--at and -o"]),
        (["stability", "--engine", "mujocco"], ["did you mean mujoco"]),
        (["stability", "--profile", "tund"], ["did you mean tuned"]),
        ([*LINE, "-o", "/dev/null/x"], ["-o /dev/null/x"]),
    ],
)
def test_a_mistake_ends_with_2_and_says_what_would_work(args: list[str], parts: list[str]) -> None:
    refused(crank_alone(*args), *parts)


LONG = ("stability", "long-fourbar", "--engine", "pymunk", "--at", "1e4", "--profile")


def late(child: Here[object], *_: object) -> Lost:
    """No run ends in its time."""
    return Lost("timeout", f"no end within {child.limits.time_s:g} s")


def raising(*_: object) -> Lost:
    """What a child raises of what it is asked for."""
    return Lost("crashed", "", CrankcheckError("no such step"))


@pytest.mark.parametrize(
    ("call", "code", "words"),
    [
        (late, 1, "crashed no end within 0.05 s"),
        (raising, 2, "case long-fourbar at 10000: no such step"),
    ],
)
def test_what_comes_of_a_lost_run(call: Callable[..., Lost], code: int, words: str) -> None:
    with in_this_process() as patch:
        patch.setattr(Here, "call", call)
        result = crank(*LONG, "as-shipped", "--limit-s", 0.05)
    assert result.exit_code == code, result.output
    assert words in flat(result.output)


@slow("a real process that its limit ends: 10,000 turns take seconds anywhere")
@pytest.mark.parametrize(("profile", "limit_s"), [("tuned", 0.3), ("as-shipped", 0.05)])
def test_a_run_over_its_limit_is_ended(profile: str, limit_s: float) -> None:
    result = crank(*LONG, profile, "--limit-s", limit_s)
    assert result.exit_code == 1, result.output
    assert f"crashed no end within {limit_s:g} s" in flat(result.stdout)


def test_the_report_of_a_folder_of_hard_cases_is_their_page(
    stored: tuple[Result, Path], tmp_path: Path
) -> None:
    _, folder = stored
    made = crank("report", folder, "-o", tmp_path / "page.html")
    assert made.exit_code == 0, made.output
    assert "runs of hard cases" in flat(made.stdout)
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert page == (folder / "stability.html").read_text(encoding="utf-8")
    assert crank("report", folder, "--format", "md").exit_code == 2


def test_the_report_of_a_sweep_has_the_hard_cases_beside_it_or_says_that_they_are_damaged(
    stored: tuple[Result, Path], tmp_path: Path
) -> None:
    folder, page = tmp_path / "store", tmp_path / "page.html"
    swept = crank_alone(
        *("sweep", "fourbar-lecture-1", "-o", folder, "--engine", "pymunk"),
        *("--profile", "tuned", "--steps-per-turn", "90,180", "--no-timing", "--jobs", 1),
    )
    assert swept.exit_code == 0, swept.output
    shutil.copy(stored[1] / "stability.json", folder)
    assert crank("report", folder, "-o", page).exit_code == 0
    assert "Nearly a parallelogram" in page.read_text(encoding="utf-8")
    (folder / "stability.json").write_text("{", encoding="utf-8")
    told = crank("report", folder, "-o", page)
    assert told.exit_code == 0
    assert "stability.json: can not be read" in flat(told.stderr)
    assert "Nearly a parallelogram" not in page.read_text(encoding="utf-8")
