"""`crankcheck stability` from the command line: the matrix, its files, and every mistake."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner, Result

from models.errors import CrankcheckError
from reports.cli import app
from reports.stability.catalogue import CATALOGUE
from reports.stability.matrix import read_matrix
from reports.workers.isolated import Lost
from tests.worlds.in_process import Here, in_this_process

Crank = Callable[..., Result]
LINE = ["stability", "grashof-excess", "--engine", "mujoco", "--profile", "tuned"]


@pytest.fixture(scope="module")
def crank() -> Crank:
    """Run the command with arguments."""
    runner = CliRunner()

    def run(*args: str) -> Result:
        return runner.invoke(app, list(args), catch_exceptions=False)

    return run


@pytest.fixture(scope="module")
def stored(crank: Crank, tmp_path_factory: pytest.TempPathFactory) -> tuple[Result, Path]:
    """A case in two profiles, printed and stored."""
    folder = tmp_path_factory.mktemp("matrix")
    args = ["stability", "grashof-excess", "wrong-branch", "--engine", "mujoco"]
    with in_this_process():
        return crank(*args, "-o", str(folder), "--jobs", "1"), folder


def test_the_matrix_is_printed_with_critical_values(stored: tuple[Result, Path]) -> None:
    result, _ = stored
    assert result.exit_code == 0, result.output
    flat = " ".join(result.stdout.split())
    assert "mujoco tuned" in flat
    assert "holds down to" in flat
    assert "crankcheck stability CASE --engine ENGINE --profile PROFILE --at VALUE" in flat
    assert "mujoco 4" in flat
    assert max(map(len, result.stdout.splitlines())) <= 100


def test_every_run_is_stored_with_the_command_that_repeats_it(
    stored: tuple[Result, Path], crank: Crank
) -> None:
    _, folder = stored
    rows = pd.read_csv(folder / "stability.csv")
    matrix = read_matrix(folder)
    assert len(rows) == len(matrix.runs) > 10
    lost = rows[(rows["case"] == "grashof-excess") & (rows["outcome"] != "ok")].iloc[-1]
    words = lost["command"].split()
    assert words[0] == "crankcheck"
    with in_this_process():
        alone = crank(*words[1:])
    assert alone.exit_code == 1
    assert lost["outcome"] in alone.stdout
    number = f"error of place, rad or over the longest link: {lost['error']:.3g}"
    assert number in " ".join(alone.stdout.split())


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


def test_a_second_run_takes_the_place_of_the_first(
    stored: tuple[Result, Path], crank: Crank, tmp_path: Path
) -> None:
    args = ["stability", "wrong-branch", "--engine", "pymunk", "-o", str(tmp_path), "--jobs", "1"]
    with in_this_process():
        assert crank(*args).exit_code == crank(*args).exit_code == 0
    assert {run.engine for run in read_matrix(tmp_path).runs} == {"pymunk"}


def test_a_few_cases_do_not_take_the_place_of_a_matrix_of_more(
    stored: tuple[Result, Path], crank: Crank
) -> None:
    _, folder = stored
    before = (folder / "stability.json").read_bytes()
    result = crank("stability", "wrong-branch", "--engine", "pymunk", "-o", str(folder))
    assert result.exit_code == 2
    assert "holds a matrix with 1 case not run now" in " ".join(result.stderr.split())
    assert (folder / "stability.json").read_bytes() == before


def test_a_value_that_is_held_ends_with_0_and_one_that_is_not_with_1(crank: Crank) -> None:
    with in_this_process():
        held, lost = (crank(*LINE, "--at", value) for value in ("1e-3", "1e-6"))
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
def test_a_mistake_ends_with_2_and_says_what_would_work(
    crank: Crank, args: list[str], parts: list[str]
) -> None:
    with in_this_process():
        result = crank(*args)
    assert result.exit_code == 2, result.output
    assert "Traceback" not in result.output
    flat = " ".join(result.stderr.split())
    for part in parts:
        assert part in flat, flat


def late(child: Here[object], *_: object) -> Lost:
    """No run ends in its time."""
    return Lost("timeout", f"no end within {child.limits.time_s:g} s")


def refused(*_: object) -> Lost:
    """What a child raises of what it is asked for."""
    return Lost("crashed", "", CrankcheckError("no such step"))


@pytest.mark.parametrize(
    ("call", "code", "words"),
    [
        (late, 1, "crashed no end within 0.05 s"),
        (refused, 2, "case long-fourbar at 10000: no such step"),
    ],
)
def test_what_comes_of_a_lost_run(
    crank: Crank, call: Callable[..., Lost], code: int, words: str
) -> None:
    args = ["stability", "long-fourbar", "--engine", "pymunk", "--profile", "as-shipped"]
    with in_this_process() as patch:
        patch.setattr(Here, "call", call)
        result = crank(*args, "--at", "1e4", "--limit-s", "0.05")
    assert result.exit_code == code, result.output
    assert words in " ".join(result.output.split())


def test_the_report_of_a_folder_of_hard_cases_is_their_page(
    stored: tuple[Result, Path], crank: Crank, tmp_path: Path
) -> None:
    _, folder = stored
    made = crank("report", str(folder), "-o", str(tmp_path / "page.html"))
    assert made.exit_code == 0, made.output
    assert "runs of hard cases" in " ".join(made.stdout.split())
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert page == (folder / "stability.html").read_text(encoding="utf-8")
    text = crank("report", str(folder), "--format", "md")
    assert text.exit_code == 2


def test_the_report_of_a_sweep_has_the_hard_cases_beside_it_or_says_that_they_are_damaged(
    stored: tuple[Result, Path], crank: Crank, tmp_path: Path
) -> None:
    folder, page = tmp_path / "store", tmp_path / "page.html"
    with in_this_process():
        swept = crank(
            *("sweep", "fourbar-lecture-1", "-o", str(folder), "--engine", "pymunk"),
            *("--profile", "tuned", "--steps-per-turn", "90,180", "--no-timing", "--jobs", "1"),
        )
    assert swept.exit_code == 0, swept.output
    shutil.copy(stored[1] / "stability.json", folder)
    assert crank("report", str(folder), "-o", str(page)).exit_code == 0
    assert "Nearly a parallelogram" in page.read_text(encoding="utf-8")
    (folder / "stability.json").write_text("{", encoding="utf-8")
    told = crank("report", str(folder), "-o", str(page))
    assert told.exit_code == 0
    assert "stability.json: can not be read" in " ".join(told.stderr.split())
    assert "Nearly a parallelogram" not in page.read_text(encoding="utf-8")
