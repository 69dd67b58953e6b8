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


def test_the_matrix_is_printed_and_runs_and_pictures_stored(stored: Result, folder: Path) -> None:
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


def test_a_second_run_replaces_no_larger_one(tmp_path: Path, stored: Result, folder: Path) -> None:
    for _ in range(2):
        assert crank_alone(*PYMUNK, "-o", tmp_path, "--jobs", 1).exit_code == 0
    assert {run.engine for run in read_matrix(tmp_path).runs} == {"pymunk"}
    before = (folder / "stability.json").read_bytes()
    refused(crank(*PYMUNK, "-o", folder), "holds a matrix with 1 case not run now")
    assert (folder / "stability.json").read_bytes() == before


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


def test_a_report_is_of_the_folder_or_a_sweep(stored: Result, folder: Path, tmp_path: Path) -> None:
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
    assert '"force"' not in to_json(matrix)
    run = replace(matrix.runs[0], error=math.nan, at_s=math.inf, force=1e-4)
    text = to_json(replace(matrix, runs=(run,)))
    assert "NaN" not in text
    assert "Infinity" not in text
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    (again,) = read_matrix(tmp_path).runs
    assert math.isnan(again.error)
    assert again.force == 1e-4


def edited(text: str, table: str, **changed: object) -> str:
    content = json.loads(text)
    content[table][0] |= changed
    return json.dumps(content)


DAMAGED: dict[str, Callable[[str], str]] = {
    "cut off": lambda text: text[: len(text) // 2],
    "no table": lambda text: "[]",
    "nested": lambda text: "[" * 100_000,
    "of another format": lambda text: text.replace('"format":', '"format": 9'),
    "an unknown end": lambda text: text.replace('"branch-changed"', '"gone"'),
    "no number": lambda text: edited(text, "runs", error="abc"),
    "labels of other values": lambda text: edited(text, "cases", labels=["0.01"]),
}


@pytest.mark.parametrize("damage", DAMAGED)
def test_a_damaged_matrix_is_told_its_cure(matrix: Matrix, tmp_path: Path, damage: str) -> None:
    with pytest.raises(CrankcheckError, match=r"no stability\.json .* makes one"):
        read_matrix(tmp_path)
    (tmp_path / FILE).write_text(DAMAGED[damage](to_json(matrix)), encoding="utf-8")
    with pytest.raises(CrankcheckError, match=r"crankcheck stability -o .* again"):
        read_matrix(tmp_path)
