"""A log whose names say nothing: the map that is written is a form, and filled in it reads it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import crankcheck
from analytic.kinematics import solve
from models.files import load_scene
from reports.logs.map_file import read_map
from tests.reports.own_log.conftest import Judge

SCENE = "fourbar-lecture-1"
TIME_S = np.linspace(0.0, 0.6, 301)
ROCKER_DEG = np.degrees(solve(load_scene(SCENE), TIME_S).links["rocker"].theta)
TIMES, THING = "the column of the times", "of at least one column what it is of"
FILLED = {"# of": 'of = "rocker"', "# kind": 'kind = "angle"', "# unit": 'unit = "deg"'}


def log(times: str, angle: str) -> bytes:
    rows = [f"{t!r},{a!r}" for t, a in zip(TIME_S.tolist(), ROCKER_DEG.tolist(), strict=True)]
    return "\n".join([f"{times},{angle}", *rows, ""]).encode()


def filled(form: str, times: str) -> str:
    """The form with the column of times, and the angle of the rocker for what is left."""
    form = form.replace(f'# column = "{times}"\n', f'column = "{times}"\n', 1)
    if THING in form:
        head, mark, rest = form.rpartition("# [[channel]]")
        rest = rest.replace("# column", "column")
        for key, line in FILLED.items():
            rest = rest.replace(f'{key} = ""', line)
        form = head + mark.removeprefix("# ") + rest
    return form


@pytest.mark.parametrize(
    ("times", "angle", "lacks"),
    [
        ("time_s", "sensor 3", [THING]),
        ("Zeit", "rocker_deg", [TIMES]),
        ("Zeit", "sensor 3", [TIMES, THING]),
        ("Zeit\\t", "the # '[3]'", [TIMES, THING]),
    ],
)
def test_it_is_a_form_that_filled_in_reads_the_log(
    times: str, angle: str, lacks: list[str], judge: Judge, tmp_path: Path
) -> None:
    path, text = tmp_path / "form.toml", log(times, angle)
    told = " ".join(judge(SCENE, text, "--write-map", path, target=()).output.split())
    form = path.read_text(encoding="utf-8")
    for one in (TIMES, THING):
        assert (one in told) == (one in form) == (one in lacks)
    read_map(path)
    judge(SCENE, text, mapped=filled(form, times.replace("\\", "\\\\")))


def test_what_a_map_says_already_stays(judge: Judge, tmp_path: Path) -> None:
    path = tmp_path / "form.toml"
    told = '[[channel]]\ncolumn = "sensor 3"\nof = "rocker"\nkind = "angle"\nunit = "deg"\n'
    told += 'sign = -1\noffset = 0.5\nwrapped = true\nrelative_to = "coupler"'
    judge(SCENE, log("Zeit", "sensor 3"), "--write-map", path, mapped=told)
    assert told in path.read_text()


@pytest.mark.parametrize(
    ("text", "mapped"),
    [
        (log("Zeit", "sensor 3"), '[[channel]]\ncolumn = "sensor 4"\nof = "rocker"'),
        (log("Zeit", "sensor 3"), '[time]\ncolumn = "Zet"'),
        (b"time_s,rocker_deg\n0,1\n0,2\n", ""),
        (b"", ""),
    ],
)
def test_another_fault_is_one_still(text: bytes, mapped: str, judge: Judge, tmp_path: Path) -> None:
    judge(SCENE, text, "--write-map", tmp_path / "form.toml", mapped=mapped, code=2)
    assert not (tmp_path / "form.toml").exists()


def test_in_python_the_cure_is_an_argument() -> None:
    with pytest.raises(crankcheck.CrankcheckError, match="in Python: the argument map"):
        crankcheck.judge(SCENE, {"t": TIME_S, "sensor 3": ROCKER_DEG}, target=1e-3)
