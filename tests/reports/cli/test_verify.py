"""`crankcheck verify` from the command line: verdict, table, files, and every mistake."""

from __future__ import annotations

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
from models.files import scene_texts, shipped
from reports.cli.checking import VerifyRequest
from reports.cli.commands import verify as command
from reports.judge.rules import RULES
from tests.worlds.command_line import crank, crank_alone, refused
from tests.worlds.tiers import slowly

FAST = ["--steps-per-turn", "360", "--turns", "1", "--no-convergence"]
ONE = ["verify", "fourbar-lecture-1", *FAST]


def test_a_scene_within_tolerance_ends_with_0() -> None:
    result = crank(*ONE, "--engine", "mujoco", "--profile", "tuned")
    assert result.exit_code == 0
    assert "WITHIN TOLERANCE: 1 cell (1 scene x 1 engine)" in result.output
    assert "mujoco 4" in " ".join(result.output.split())


def test_a_scene_out_of_tolerance_ends_with_1_failures_first_with_their_cure() -> None:
    result = crank(*ONE, "--engine", "mujoco", "--profile", "tuned", "--tol", "angle=1e-12")
    assert result.exit_code == 1
    assert "OUT OF TOLERANCE: 1 of 1 cell (1 scene x 1 engine)" in result.output
    head, _, _ = result.output.partition("profile tuned")
    assert "CC103 angle" in head
    assert "limit 1e-12 rad (--tol)" in " ".join(head.split())
    assert "cure:" in head


def test_by_default_as_shipped_is_shown_and_does_not_count() -> None:
    result = crank(*ONE, "--engine", "mujoco")
    assert result.exit_code == 0
    assert "profile tuned (gated)" in result.output
    assert "profile as-shipped (shown, not gated)" in result.output
    assert "OUT fourbar-lecture-1" in result.output


def test_a_profile_that_is_named_is_gated() -> None:
    result = crank(*ONE, "--engine", "mujoco", "--profile", "as-shipped")
    assert result.exit_code == 1
    assert "profile as-shipped (gated)" in result.output


@pytest.mark.parametrize(
    "dt", ["1e-3", slowly("1e-4", reason="a finer step, which mends what is no floor")]
)
def test_the_table_says_that_mujoco_as_shipped_does_not_shrink(dt: str) -> None:
    shipped = ("--engine", "mujoco", "--profile", "as-shipped")
    result = crank("verify", "fourbar-lecture-1", *shipped, "--dt", dt, "--turns", 1)
    assert result.exit_code == 1
    assert "does not shrink" in result.output.partition("profile as-shipped")[2]


def test_no_line_is_wider_than_a_hundred_columns() -> None:
    result = crank("verify", "slider-crank-excel-350", "--turns", "1")
    assert max(len(line.rstrip()) for line in result.output.splitlines()) <= 100
    assert "slider-crank-excel-350" in result.output.partition("profile tuned")[2]


def test_a_scene_may_be_a_path(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    path.write_text(text.replace('"fourbar-lecture-1"', '"mine"'), encoding="utf-8")
    result = crank("verify", str(path), *FAST, "--engine", "mujoco")
    assert result.exit_code == 0
    assert "mine" in result.output


def test_all_files_of_a_folder_are_written_and_hold_the_same_cells(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    assert crank(*ONE, "-o", str(folder), "--engine", "mujoco").exit_code == 0
    assert sorted(path.name for path in folder.iterdir()) == [
        "errors.parquet",
        "verify.csv",
        "verify.json",
        "verify.junit.xml",
    ]
    cells = pd.read_csv(folder / "verify.csv")
    assert cells["profile"].tolist() == ["tuned", "as-shipped"]
    stored = json.loads((folder / "verify.json").read_text())
    assert [cell["verdict"] for cell in stored["cells"]] == ["within", "out"]
    assert stored["cells"][0]["angle_error_rad"] == pytest.approx(cells["angle_error_rad"][0])
    assert {f["rule"] for f in stored["cells"][0]["findings"]} <= set(RULES)
    long = pd.read_parquet(folder / "errors.parquet")
    rocker = long.query("profile == 'tuned' and body == 'rocker' and quantity == 'angle'")
    assert set(rocker["kind"]) == {"total", "geometric"}
    assert rocker["maximum"].max() <= cells["angle_error_rad"][0] * (1 + 1e-12)
    suite = Xml.fromstring((folder / "verify.junit.xml").read_text())
    assert [case.get("name") for case in suite.iter("testcase")] == ["fourbar-lecture-1"] * 2


def test_a_second_run_replaces_the_files_of_the_first(tmp_path: Path) -> None:
    for tolerance in ("1e-12", "1e-1"):
        crank(*ONE, "-o", str(tmp_path), "--engine", "mujoco", "--tol", f"angle={tolerance}")
    cells = pd.read_csv(tmp_path / "verify.csv")
    assert cells["verdict"][0] == "within"
    assert len(list(tmp_path.iterdir())) == 4


def test_junit_names_the_failure_and_skips_what_is_not_gated(tmp_path: Path) -> None:
    path = tmp_path / "j.xml"
    result = crank(*ONE, "--engine", "mujoco", "--tol", "angle=1e-12", "--junit", str(path))
    assert result.exit_code == 1
    (suite,) = Xml.fromstring(path.read_text())
    times = [float(case.get("time", "nan")) for case in suite.iter("testcase")]
    assert all(each > 0.0 for each in times)
    assert float(suite.get("time", "nan")) == pytest.approx(sum(times), abs=2e-3)
    assert (suite.get("tests"), suite.get("failures"), suite.get("skipped")) == ("2", "1", "1")
    failure = suite.find("testcase/failure")
    assert failure.get("type") == "CC103"
    assert "cure" in (failure.text or "")


def test_outputs_are_written_even_when_out_of_tolerance(tmp_path: Path) -> None:
    path = tmp_path / "cells.csv"
    result = crank(*ONE, "--engine", "pymunk", "--tol", "drive=1e-30", "--csv", str(path))
    assert result.exit_code == 1
    assert "CC102" in pd.read_csv(path)["failed_rules"][0]


def test_a_disk_that_fills_up_costs_the_file_and_not_the_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    result = crank(*ONE, "--engine", "mujoco", "--csv", str(tmp_path / "cells.csv"))
    assert "WITHIN TOLERANCE" in result.output
    refused(result, "cells.csv: can not be written: No space left on device; free some space")


def test_an_engine_that_is_not_installed_names_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import reports.plan.chosen as names

    def missing(name: str) -> object:
        raise EngineError(f"engine {name}: not installed; pip install {name}")

    monkeypatch.setattr(names, "engine", missing)
    refused(crank(*ONE), "engine mujoco: not installed", "pip install mujoco")


def edited(tmp_path: Path, name: str, *changes: tuple[str, str]) -> Path:
    """A shipped scene with some of its text changed, as a file."""
    text = shipped()[name].read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "edited.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_two_files_with_one_name_are_refused(tmp_path: Path) -> None:
    path = edited(tmp_path, "fourbar-crossed", ('"fourbar-crossed"', '"fourbar-lecture-1"'))
    refused(crank(*ONE, path), "a second scene called fourbar-lecture-1", "rename one")


LIMIT = ("[driver]", "[tolerance]\nangel = 1e-3\n[driver]")
NEVER = [("0.25", "0.01"), ("length_m = 0.2 ", "length_m = 0.05 ")]


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ([LIMIT], ["[tolerance] angel", "did you mean angle"]),
        ([("0.25", "0.17")], ["crank can stand at", "deg"]),
        (NEVER, ["cannot be assembled", "open by", "change a length"]),
    ],
    ids=["a limit of no quantity", "a driver that cannot go round", "a loop that never closes"],
)
def test_a_fault_of_the_scene_is_told_before_anything_runs(
    changes: list[tuple[str, str]], parts: list[str], tmp_path: Path
) -> None:
    refused(crank("verify", edited(tmp_path, "fourbar-lecture-1", *changes)), *parts)


def test_a_massless_link_is_refused_by_the_engine_that_needs_its_mass(tmp_path: Path) -> None:
    massless = ("length_m = 0.25", "length_m = 0.25, mass_kg = 0.0")
    result = crank("verify", edited(tmp_path, "fourbar-lecture-1", massless), *FAST)
    refused(result, "coupler", "mass_kg")
    assert "unsupported" in result.output


def test_ctrl_c_ends_with_130_and_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> object:
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "check_all", interrupted)
    result = crank(*ONE)
    assert result.exit_code == 130
    assert result.stderr.splitlines() == ["crankcheck: interrupted"]


def test_a_scene_that_no_engine_can_hold_is_a_row_and_exit_2(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import reports.judge.cell as cell

    def refuse(*_: object, **__: object) -> object:
        raise EngineError("mujoco: coupler has no mass; give it a mass_kg")

    monkeypatch.setattr(cell, "run", refuse)
    result = crank(*ONE, "--engine", "mujoco", "--profile", "tuned")
    assert result.exit_code == 2
    assert "coupler has no mass" in " ".join(result.output.split())
    assert "NONE fourbar-lecture-1" in result.output


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
        code = command.verify(VerifyRequest(**{**given, **asked}), console, console)  # type: ignore[arg-type]
        return code, console.export_text()

    return run


def plant(folder: Path, column: str, factor: float) -> None:
    """Make an error of a stored run so many times as large."""
    cells = pd.read_csv(folder / "verify.csv")
    cells[column] *= factor
    cells.to_csv(folder / "verify.csv", index=False)


def test_a_run_as_good_as_its_baseline_ends_with_0(against: Verify, tmp_path: Path) -> None:
    against(folder=tmp_path)
    code, text = against(baseline=tmp_path)
    assert code == 0
    verdict, _, diff = text.partition("NOT WORSE: 0 worse, 0 better, 1 equal, 0 new, 0 missing")
    assert "WITHIN TOLERANCE" in verdict
    assert f"old: {tmp_path}" in "".join(diff.splitlines())


def test_a_run_worse_than_its_baseline_ends_with_1_though_within(
    against: Verify, tmp_path: Path
) -> None:
    against(folder=tmp_path)
    plant(tmp_path, "gap_pure", 1 / 1.2)
    code, text = against(baseline=tmp_path, junit=tmp_path / "j.xml")
    assert code == 1
    assert "WITHIN TOLERANCE" in text
    assert "WORSE: 1 worse" in text
    assert against(baseline=tmp_path, factor=1.3)[0] == 0
    own, diff = Xml.fromstring((tmp_path / "j.xml").read_text(encoding="utf-8"))
    assert [suite.get("failures") for suite in (own, diff)] == ["0", "1"]
    assert ["gap" in failure.get("message", "") for failure in diff.iter("failure")] == [True]


def test_the_baseline_does_not_excuse_what_is_out_of_tolerance(
    against: Verify, tmp_path: Path
) -> None:
    against(folder=tmp_path)
    code, text = against(baseline=tmp_path, tolerance=("angle=1e-12",))
    assert code == 1
    assert "OUT OF TOLERANCE" in text
    assert "NOT WORSE" in text


def test_the_baseline_may_be_the_folder_that_is_written(against: Verify, tmp_path: Path) -> None:
    against(folder=tmp_path)
    plant(tmp_path, "gap_pure", 1 / 1.2)
    assert against(baseline=tmp_path, folder=tmp_path)[0] == 1
    assert against(baseline=tmp_path, folder=tmp_path)[0] == 0, "it is the new run by now"


def test_only_what_is_run_now_is_compared(against: Verify, tmp_path: Path) -> None:
    against(folder=tmp_path, profiles=("tuned", "as-shipped"))
    code, text = against(baseline=tmp_path, scenes=("fourbar-lecture-1", "scotch-yoke"))
    assert code == 0
    assert "1 equal, 1 new, 0 missing" in text


def test_an_engine_that_can_not_run_ends_with_2_beside_its_diff(
    against: Verify, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import reports.judge.cell as cell

    def refuse(*_: object, **__: object) -> object:
        raise EngineError("mujoco: coupler has no mass; give it a mass_kg")

    against(folder=tmp_path)
    monkeypatch.setattr(cell, "run", refuse)
    code, text = against(baseline=tmp_path)
    assert code == 2
    assert "status" in text.partition("WORSE: 1 worse")[2]


def test_a_scene_that_changed_since_the_baseline_is_refused(
    against: Verify, tmp_path: Path
) -> None:
    scene = tmp_path / "mine.toml"
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    scene.write_text(text.replace("0.25", "0.26"), encoding="utf-8")
    against(folder=tmp_path)
    with pytest.raises(CrankcheckError, match="every scene of both changed in between"):
        against(baseline=tmp_path, scenes=(str(scene),))


def test_a_bad_baseline_is_refused_before_the_run(
    against: Verify, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    against(folder=tmp_path)
    monkeypatch.setattr(command, "check_all", lambda *_: pytest.fail("it ran"))
    for asked, fault in (
        ({"baseline": tmp_path / "none"}, "none: no such folder"),
        ({"baseline": tmp_path, "steps_per_turn": 180.0}, "no cell in common: .* holds 1 cell"),
        ({"baseline": tmp_path, "factor": 0.5}, "--factor 0.5: give a number of at least 1"),
    ):
        with pytest.raises(CrankcheckError, match=fault):
            against(**asked)


def test_a_failing_cell_is_told_what_was_tried_and_a_sweep_takes_it(tmp_path: Path) -> None:
    text = scene_texts(["slider-crank-offset"])["slider-crank-offset"]
    path = tmp_path / "heavy.toml"
    path.write_text(text.replace("mass_kg = 0.5", "mass_kg = 3e3"))
    steps = ["--steps-per-turn", "360", "--turns", "1", "--engine", "mujoco"]
    done = crank("verify", str(path), "--profile", "tuned", *steps)
    assert done.exit_code == 1
    told = re.findall(r"cure: Tried at the same step: sweep (--set) (\S+) ", done.output)
    assert len(told) == 1, done.output
    out = ["--no-timing", "-o", str(tmp_path / "out")]
    assert crank_alone("sweep", path, *steps, *told[0], *out).exit_code == 0
