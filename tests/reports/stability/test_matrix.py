"""The stored matrix is read back as it was; a file that is not one is refused with the cure."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from models.errors import CrankcheckError
from reports.stability.catalogue import CATALOGUE
from reports.stability.critical import critical
from reports.stability.grading import graded
from reports.stability.matrix import FILE, Matrix, label, read_matrix, to_json


def edited(text: str, table: str, **changed: object) -> str:
    """The text with some of the first row of a table changed."""
    content = json.loads(text)
    content[table][0] |= changed
    return json.dumps(content)


@pytest.fixture(scope="module")
def matrix() -> Matrix:
    """A small real one, with runs that hold, and one with a picture."""
    case = CATALOGUE["grashof-excess"]
    found = [graded(case, "pymunk", "tuned", value, draw=True) for value in (1e-2, 1e-5)]
    runs = [run for run, _ in found]
    return Matrix(
        {"crankcheck": "0"},
        (case.facts(),),
        tuple(runs),
        (critical(case, runs),),
        tuple(picture for _, picture in found if picture is not None),
    )


def test_a_matrix_is_read_back_as_it_was(matrix: Matrix, tmp_path: Path) -> None:
    (tmp_path / FILE).write_text(to_json(matrix), encoding="utf-8")
    assert repr(read_matrix(tmp_path)) == repr(matrix)  # NaN is not equal to itself
    assert [run.outcome for run in matrix.runs] == ["ok", "branch-changed"]
    assert [picture.label for picture in matrix.pictures] == [label(1e-5)]


def test_a_number_that_is_missing_is_still_missing(matrix: Matrix, tmp_path: Path) -> None:
    run = replace(matrix.runs[0], error=math.nan, at_s=math.inf)
    text = to_json(replace(matrix, runs=(run,)))
    assert "NaN" not in text
    assert "Infinity" not in text
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    read = read_matrix(tmp_path).runs[0]
    assert math.isnan(read.error)


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: "",
        lambda text: text[: len(text) // 2],
        lambda text: "[]",
        lambda text: "[" * 100_000,
        lambda text: json.dumps(json.loads(text) | {"format": 99}),
        lambda text: json.dumps({"format": 1, "facts": {}}),
        lambda text: text.replace('"outcome"', '"ending"'),
        lambda text: text.replace('"branch-changed"', '"gone"'),
        lambda text: edited(text, "runs", error="abc"),
        lambda text: edited(text, "cases", values=None),
        lambda text: edited(text, "cases", labels=["0.01"]),
        lambda text: edited(text, "pictures", drawing=3),
        lambda text: json.dumps(json.loads(text) | {"facts": [1]}),
        lambda text: json.dumps(json.loads(text) | {"runs": 5}),
        lambda text: json.dumps(json.loads(text) | {"runs": ["a"]}),
    ],
)
def test_a_damaged_matrix_is_refused_with_the_cure(
    matrix: Matrix, tmp_path: Path, damage: object
) -> None:
    (tmp_path / FILE).write_text(damage(to_json(matrix)), encoding="utf-8")  # type: ignore[operator]
    with pytest.raises(CrankcheckError, match=r"crankcheck stability -o .* again"):
        read_matrix(tmp_path)


def test_a_folder_without_one_says_what_makes_it(tmp_path: Path) -> None:
    with pytest.raises(CrankcheckError, match=r"no stability\.json .* makes one"):
        read_matrix(tmp_path)
