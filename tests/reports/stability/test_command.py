"""`crankcheck stability` from the command line: the matrix, its files, and every mistake; a stored
matrix is read back as it was, and a file that is not one refused with the cure."""

import json
import math
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import Result

from models.errors import CrankcheckError
from reports.stability.grading import CATALOGUE, graded
from reports.stability.matrix import FILE, Matrix, label, read_matrix, to_json
from reports.stability.running import critical
from reports.workers.isolated import Lost
from tests.worlds.command_line import crank, crank_alone, flat, refused
from tests.worlds.in_process import Here, in_this_process

PYMUNK = ("stability", "wrong-branch", "--engine", "pymunk")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("matrix")


@pytest.fixture(scope="module")
def stored(folder: Path) -> Result:
    args = ["stability", "grashof-excess", "wrong-branch", "--engine", "mujoco"]
    return crank_alone(*args, "-o", folder, "--jobs", 1)


def test_the_matrix_is_printed_and_each_run_stored_with_its_command_and_failures_with_pictures(
    stored: Result, folder: Path
) -> None:
    assert stored.exit_code == 0, stored.output
    told = flat(stored.stdout)
    assert told.endswith(f"{folder}: stability.json, stability.csv, stability.html")
    assert "mujoco tuned" in told
    assert "holds down to" in told
    assert "crankcheck stability CASE --engine ENGINE --profile PROFILE --at VALUE" in told
    assert "mujoco 4" in told
    assert max(map(len, stored.stdout.splitlines())) <= 100
    rows = pd.read_csv(folder / "stability.csv")
    assert len(rows) == len(read_matrix(folder).runs) > 10
    lost = rows[(rows["case"] == "grashof-excess") & (rows["outcome"] != "ok")].iloc[-1]
    program, *words = lost["command"].split()
    assert program == "crankcheck"
    alone = crank_alone(*words)
    assert alone.exit_code == 1
    assert lost["outcome"] in alone.stdout
    number = f"error of place, rad or over the longest link: {lost['error']:.3g}"
    assert number in flat(alone.stdout)
    matrix = read_matrix(folder)
    failed = {
        (run.profile, run.label)
        for run in matrix.runs
        if run.grid and run.outcome not in CATALOGUE[run.case].good
    }
    assert {(one.profile, one.label) for one in matrix.pictures} == failed
    assert (folder / "stability.html").stat().st_size > 10_000
    assert json.loads((folder / "stability.json").read_text(encoding="utf-8"))["format"] == 1


def test_a_second_run_takes_the_place_of_the_first_but_never_of_more_cases(
    tmp_path: Path, stored: Result, folder: Path
) -> None:
    for _ in range(2):
        assert crank_alone(*PYMUNK, "-o", tmp_path, "--jobs", 1).exit_code == 0
    assert {run.engine for run in read_matrix(tmp_path).runs} == {"pymunk"}
    before = (folder / "stability.json").read_bytes()
    refused(crank(*PYMUNK, "-o", folder), "holds a matrix with 1 case not run now")
    assert (folder / "stability.json").read_bytes() == before


LINE = ["stability", "grashof-excess", "--engine", "mujoco", "--profile", "tuned"]


@pytest.mark.parametrize(
    ("args", "parts"),
    [
        (["stability", "grashof-exces"], ["grashof-exces", "did you mean grashof-excess"]),
        (["stability", "--at", "1e-3"], ["a value of one case", "name one"]),
        ([*LINE, "--at", "nan"], ["not a finite number"]),
        ([*LINE, "--at", "-0.5"], ["not above 0", "Grashof margin", "0.01 to 1e-6 m"]),
        ([*LINE, "--at", "5"], ["too far off", "0.01 to 1e-6 m"]),
        ([*LINE, "--limit-s", "0"], ["--limit-s 0: give a number above 0"]),
        (["stability", "long-fourbar", "--at", "2.5"], ["not a whole number", "turns"]),
        (["stability", "wrong-branch", "--at", "5"], ["has the one value -1"]),
        (["stability", "coarse-step", "--at", "5"], ["at least 8"]),
        ([*LINE, "--at", "1e-3", "-o", "x"], ["--at and -o"]),
        (["stability", "coarse-step", "--elastic"], ["no elastic link in it; those are elastic"]),
        (["stability", "--free", "--elastic"], ["no case is of both"]),
        (["stability", "--engine", "mujocco"], ["did you mean mujoco"]),
        (["stability", "--profile", "tund"], ["did you mean tuned"]),
    ],
)
def test_a_mistake_ends_with_2_and_says_what_would_work(args: list[str], parts: list[str]) -> None:
    refused(crank_alone(*args), *parts)


def test_what_comes_of_a_lost_run() -> None:
    line = "stability long-fourbar --engine pymunk --at 1e4 --profile as-shipped --limit-s 0.05"

    def late(child: Here[object], *_: object) -> Lost:
        return Lost("timeout", f"no end within {child.limits.time_s:g} s")

    def at_fault(*_: object) -> Lost:
        return Lost("crashed", "", CrankcheckError("no"))

    for call, code, words in (
        (late, 1, "crashed no end within 0.05 s"),
        (at_fault, 2, "case long-fourbar at 10000: no"),
    ):
        with in_this_process() as patch:
            patch.setattr(Here, "call", call)
            result = crank(*line.split())
        assert result.exit_code == code, result.output
        assert words in flat(result.output)


def test_a_report_is_of_the_folder_or_of_a_sweep_with_the_hard_cases_beside_it_or_damaged(
    stored: Result, folder: Path, tmp_path: Path
) -> None:
    store, page = tmp_path / "store", tmp_path / "page.html"
    swept = crank_alone(
        *("sweep", "fourbar-lecture-1", "-o", store, "--engine", "pymunk"),
        *("--profile", "tuned", "--steps-per-turn", "90,180", "--no-timing", "--jobs", 1),
    )
    assert swept.exit_code == 0, swept.output
    shutil.copy(folder / "stability.json", store)
    assert crank("report", store, "-o", page).exit_code == 0
    assert "Nearly a parallelogram" in page.read_text(encoding="utf-8")
    (store / "stability.json").write_text("{", encoding="utf-8")
    told = crank("report", store, "-o", page)
    assert told.exit_code == 0
    assert "stability.json: can not be read" in flat(told.stderr)
    assert "Nearly a parallelogram" not in page.read_text(encoding="utf-8")
    made = crank("report", folder, "-o", page)
    assert made.exit_code == 0, made.output
    assert "runs of hard cases" in flat(made.stdout)
    assert page.read_bytes() == (folder / "stability.html").read_bytes()
    assert crank("report", folder, "--format", "md").exit_code == 2


@pytest.fixture(scope="module")
def matrix() -> Matrix:
    """A small real one, with runs that hold, and one with a picture."""
    case = CATALOGUE["grashof-excess"]
    found = [graded(case, "pymunk", "tuned", value, draw=True) for value in (1e-2, 1e-5)]
    runs = tuple(run for run, _ in found)
    pictures = tuple(picture for _, picture in found if picture is not None)
    return Matrix({"crankcheck": "0"}, (case.facts(),), runs, (critical(case, runs),), pictures)


def test_a_matrix_is_read_back_as_it_was(matrix: Matrix, tmp_path: Path) -> None:
    (tmp_path / FILE).write_text(to_json(matrix), encoding="utf-8")
    assert repr(read_matrix(tmp_path)) == repr(matrix)  # NaN is not equal to itself
    assert [run.outcome for run in matrix.runs] == ["ok", "branch-changed"]
    assert [picture.label for picture in matrix.pictures] == [label(1e-5)]
    # Also a number that is missing, for which JSON has no word.
    run = replace(matrix.runs[0], error=math.nan, at_s=math.inf)
    text = to_json(replace(matrix, runs=(run,)))
    assert "NaN" not in text
    assert "Infinity" not in text
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    assert math.isnan(read_matrix(tmp_path).runs[0].error)


def edited(text: str, table: str, **changed: object) -> str:
    content = json.loads(text)
    content[table][0] |= changed
    return json.dumps(content)


def other(text: str, **changed: object) -> str:
    return json.dumps(json.loads(text) | changed)


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[: len(text) // 2],
        lambda text: "[]",
        lambda text: "[" * 100_000,
        lambda text: other(text, format=99),
        lambda text: json.dumps({"format": 1, "facts": {}}),
        lambda text: text.replace('"branch-changed"', '"gone"'),
        lambda text: edited(text, "runs", error="abc"),
        lambda text: edited(text, "cases", labels=["0.01"]),
        lambda text: other(text, runs=5),
        lambda text: other(text, runs=["a"]),
    ],
)
def test_a_damaged_matrix_is_refused_with_the_cure(
    matrix: Matrix, tmp_path: Path, damage: Callable[[str], str]
) -> None:
    with pytest.raises(CrankcheckError, match=r"no stability\.json .* makes one"):
        read_matrix(tmp_path)
    (tmp_path / FILE).write_text(damage(to_json(matrix)), encoding="utf-8")
    with pytest.raises(CrankcheckError, match=r"crankcheck stability -o .* again"):
        read_matrix(tmp_path)
