"""`crankcheck verify` from the command line: verdict, table, files, baselines. More of what it
tells is in `test_told.py`, mistakes are in `test_refusals.py`."""

import io
import json
import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as Xml

import pandas as pd
import pytest
from rich.console import Console

from models.errors import CrankcheckError, EngineError
from reports.judge.rules import RULES
from reports.requests import verify as command
from reports.requests.verify import VerifyRequest
from tests.worlds.command_line import crank, crank_alone, edited, flat, refused, told

FAST = "--steps-per-turn 360 --turns 1 --no-convergence"
ONE = f"verify fourbar-lecture-1 {FAST}"
MUJOCO = f"{ONE} --engine mujoco"


def raising(error: BaseException) -> Callable[..., object]:
    def raises(*_: object, **__: object) -> object:
        raise error

    return raises


def test_failures_end_with_1_and_stand_first_and_in_all_outputs_with_a_cure(tmp_path: Path) -> None:
    junit, csv = tmp_path / "j.xml", tmp_path / "cells.csv"
    output = told(f"{MUJOCO} --tol angle=1e-12", "--junit", junit, "--csv", csv, code=1)
    assert "OUT OF TOLERANCE: 1 of 1 cell (1 scene x 1 engine)" in output
    head = flat(output.partition("profile tuned")[0])
    parts = ("CC103 angle", "limit 1e-12 rad (--tol)", "cure:")
    assert [part for part in parts if part not in head] == []
    assert "CC103" in pd.read_csv(csv)["failed_rules"][0]
    (suite,) = Xml.fromstring(junit.read_text())
    times = [float(case.get("time", "nan")) for case in suite.iter("testcase")]
    assert min(times) > 0.0
    assert float(suite.get("time", "nan")) == pytest.approx(sum(times), abs=2e-3)
    # What is not gated is skipped.
    assert (suite.get("tests"), suite.get("failures"), suite.get("skipped")) == ("2", "1", "1")
    failure = suite.find("testcase/failure")
    assert failure.get("type") == "CC103"
    assert "cure" in (failure.text or "")


def test_all_files_of_a_folder_hold_the_same_cells_of_the_last_run(tmp_path: Path) -> None:
    """Of a scene in a file, which a first run had out of tolerance."""
    folder = tmp_path / "out"
    path = edited(tmp_path, "fourbar-lecture-1", ('"fourbar-lecture-1"', '"mine"'))
    line = f"verify {FAST} --engine mujoco"
    told(line, path, "-o", folder, "--tol", "angle=1e-12", code=1)
    assert "mine" in told(line, path, "-o", folder)
    names = ["errors.parquet", "verify.csv", "verify.html", "verify.json", "verify.junit.xml"]
    assert sorted(path.name for path in folder.iterdir()) == names
    cells = pd.read_csv(folder / "verify.csv")
    assert cells["profile"].tolist() == ["tuned", "as-shipped"]
    stored = json.loads((folder / "verify.json").read_text())
    verdicts = [cell["verdict"] for cell in stored["cells"]]
    assert verdicts == cells["verdict"].tolist() == ["within", "out"]
    assert stored["cells"][0]["angle_error_rad"] == pytest.approx(cells["angle_error_rad"][0])
    assert {f["rule"] for f in stored["cells"][0]["findings"]} <= set(RULES)
    long = pd.read_parquet(folder / "errors.parquet")
    rocker = long.query("profile == 'tuned' and body == 'rocker' and quantity == 'angle'")
    assert set(rocker["kind"]) == {"total", "geometric"}
    assert rocker["maximum"].max() <= cells["angle_error_rad"][0] * (1 + 1e-12)
    suite = Xml.fromstring((folder / "verify.junit.xml").read_text())
    assert [case.get("name") for case in suite.iter("testcase")] == ["mine"] * 2


def test_a_full_disk_costs_the_file_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "replace", raising(OSError(28, "No space left on device")))
    result = crank(*MUJOCO.split(), "--csv", tmp_path / "cells.csv")
    assert "WITHIN TOLERANCE" in result.output
    refused(result, "cells.csv: can not be written: No space left on device; free some space")


def test_two_files_with_one_name_are_refused(tmp_path: Path) -> None:
    path = edited(tmp_path, "fourbar-crossed", ('"fourbar-crossed"', '"fourbar-lecture-1"'))
    refused(crank(*ONE.split(), path), "two different scenes have the name", "rename one")


def test_a_fault_of_the_scene_is_told_before_anything_runs(tmp_path: Path) -> None:
    never = [("0.25", "0.01"), ("length_m = 0.2 ", "length_m = 0.05 ")]
    result = crank("verify", edited(tmp_path, "fourbar-lecture-1", *never))
    refused(result, "cannot be assembled", "open by", "change a length")


Verify = Callable[..., tuple[int, str]]


@pytest.fixture
def against(tmp_path: Path) -> Verify:
    """Verify a four-bar with MuJoCo against a baseline; gives the exit code and the output."""

    def run(**asked: object) -> tuple[int, str]:
        console = Console(width=100, record=True, file=io.StringIO())
        given: dict[str, object] = {
            "scenes": ("fourbar-lecture-1",), "engines": ("mujoco",), "profiles": ("tuned",),
            "steps_per_turn": 90.0, "turns": 1.0, "converge": False, "jobs": 1,
        }  # fmt: skip
        code = VerifyRequest(**{**given, **asked}).run(console, console)  # type: ignore[arg-type]
        return code, console.export_text()

    return run


def test_a_run_as_good_as_its_baseline_ends_by_the_limits(against: Verify, tmp_path: Path) -> None:
    against(folder=tmp_path)
    code, text = against(baseline=tmp_path)
    assert code == 0
    verdict, _, diff = text.partition("NOT WORSE: 0 worse, 0 better, 1 equal, 0 new, 0 missing")
    assert "WITHIN TOLERANCE" in verdict
    assert f"old: {tmp_path}" in "".join(diff.splitlines())
    assert against(baseline=tmp_path, tolerance=("angle=1e-12",))[0] == 1


def test_a_run_within_but_worse_than_before_ends_with_1(against: Verify, tmp_path: Path) -> None:
    against(folder=tmp_path)
    cells = pd.read_csv(tmp_path / "verify.csv")
    cells.assign(gap_pure=cells["gap_pure"] / 1.2).to_csv(tmp_path / "verify.csv", index=False)
    code, text = against(baseline=tmp_path, junit=tmp_path / "j.xml")
    assert code == 1
    assert "WITHIN TOLERANCE" in text
    assert "WORSE: 1 worse" in text
    assert against(baseline=tmp_path, factor=1.3)[0] == 0
    own, diff = Xml.fromstring((tmp_path / "j.xml").read_text(encoding="utf-8"))
    assert [suite.get("failures") for suite in (own, diff)] == ["0", "1"]
    assert ["gap" in failure.get("message", "") for failure in diff.iter("failure")] == [True]
    # The baseline may be the folder that is written, and is the new run then.
    assert [against(baseline=tmp_path, folder=tmp_path)[0] for _ in range(2)] == [1, 0]
    # Only what is run now is compared.
    against(folder=tmp_path, profiles=("tuned", "as-shipped"))
    code, text = against(baseline=tmp_path, scenes=("fourbar-lecture-1", "scotch-yoke"))
    assert code == 0
    assert "1 equal, 1 new, 0 missing" in text


def test_an_engine_that_can_not_run_ends_with_2_beside_its_diff(
    against: Verify, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    against(folder=tmp_path)
    monkeypatch.setattr("reports.judge.cell.run", raising(EngineError("mujoco: no mass")))
    code, text = against(baseline=tmp_path)
    assert code == 2
    assert "status" in text.partition("WORSE: 1 worse")[2]


def test_a_bad_baseline_is_refused_before_the_run(
    against: Verify, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    against(folder=tmp_path)
    scene = edited(tmp_path, "fourbar-lecture-1", ("0.25", "0.26"))
    monkeypatch.setattr(command, "check_all", lambda *_: pytest.fail("it ran"))
    for asked, fault in (
        ({"baseline": tmp_path, "scenes": (str(scene),)}, "every scene of both changed in between"),
        ({"baseline": tmp_path / "none"}, "none: no such folder"),
        ({"baseline": tmp_path, "steps_per_turn": 180.0}, "no cell in common: .* holds 1 cell"),
        ({"baseline": tmp_path, "factor": 0.5}, "--factor 0.5: give a number of at least 1"),
    ):
        with pytest.raises(CrankcheckError, match=fault):
            against(**asked)


def test_a_failing_cell_is_told_what_was_tried_and_a_sweep_takes_it(tmp_path: Path) -> None:
    path = edited(tmp_path, "slider-crank-offset", ("mass_kg = 0.5", "mass_kg = 3e3"))
    steps = "--steps-per-turn 360 --turns 1 --engine mujoco"
    output = told(f"verify {steps} --profile tuned", path, code=1)
    ((option, setting),) = re.findall(r"cure: Tried at the same step: sweep (--set) (\S+) ", output)
    out = ["--no-timing", "-o", tmp_path / "out"]
    assert crank_alone("sweep", path, *steps.split(), option, setting, *out).exit_code == 0
