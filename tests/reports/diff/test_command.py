"""`crankcheck diff` as a user sees it: exit code, what is named, files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as Xml

import pandas as pd
import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.cli.changes import DiffRequest
from reports.cli.commands.diff import run_diff

Copy = Callable[..., Path]
Planted = Callable[..., Callable[[pd.DataFrame], None]]


def text(console: Console) -> str:
    return console.export_text()


def test_a_run_against_itself_ends_with_0(stored: Copy, paper: Console) -> None:
    folder = stored("old")
    assert run_diff(DiffRequest(folder, folder, strict=True), paper) == 0
    assert "NOT WORSE: 0 worse, 0 better, 4 equal, 0 new, 0 missing" in text(paper)


def test_a_planted_growth_ends_with_1_and_is_named(
    stored: Copy, planted: Planted, paper: Console
) -> None:
    request = DiffRequest(stored("old"), stored("new", planted(1.2)))
    assert run_diff(request, paper) == 1
    shown = text(paper)
    assert shown.startswith("WORSE: 1 worse, 0 better, 3 equal, 0 new, 0 missing")
    (row,) = [line for line in shown.splitlines() if line.startswith("fourbar-lecture-1")]
    assert row.split()[:5] == ["fourbar-lecture-1", "mujoco", "tuned", "90", "position"]
    assert row.split()[-1] == "1.20"
    assert run_diff(DiffRequest(request.new, request.old), paper) == 0


def test_a_growth_below_the_factor_ends_with_0(
    stored: Copy, planted: Planted, paper: Console
) -> None:
    old, new = stored("old"), stored("new", planted(1.05))
    assert run_diff(DiffRequest(old, new), paper) == 0
    assert run_diff(DiffRequest(old, new, factor=1.01), paper) == 1


def test_a_growth_at_the_size_of_rounding_ends_with_0(
    stored: Copy, planted: Planted, paper: Console
) -> None:
    old, new = stored("old"), stored("new", planted(20.0, "drive_pure"))
    assert run_diff(DiffRequest(old, new), paper) == 0


def test_a_run_that_diverged_tells_why(stored: Copy, paper: Console) -> None:
    def plant(frame: pd.DataFrame) -> None:
        frame.loc[2, ["status", "reason"]] = ["diverged", "came apart at 0.1 s"]

    request = DiffRequest(stored("old"), stored("new", plant))
    assert run_diff(request, paper) == 1
    shown = " ".join(text(paper).split())
    assert "pymunk tuned 90 status ok diverged -" in shown
    assert "pymunk tuned: came apart at 0.1 s" in shown


def test_steps_of_one_line_are_one_row_with_the_worst(store: Copy, paper: Console) -> None:
    old, new = store("old"), store("new", version="4.0.1", gaps={90.0: 2.0, 180.0: 3.0})
    assert run_diff(DiffRequest(old, new), paper) == 1
    shown = " ".join(text(paper).split())
    assert "WORSE: 2 worse, 0 better, 0 equal" in shown
    assert "mujoco 4.0.0 -> 4.0.1" in shown
    assert "mujoco tuned 180 (also 90) gap" in shown
    assert shown.count("fourbar-lecture-1") == 1


@pytest.mark.parametrize(
    ("us", "cpu", "told"),
    [(4.0, "one", "mujoco tuned 2.00 x (median of 2 cells)"),
     (2.1, "one", "equal inside the noise of 10%"),
     (4.0, "another", None)],
)  # fmt: skip
def test_costs_are_advice_and_only_told_of_one_processor(
    us: float, cpu: str, told: str | None, store: Copy, paper: Console
) -> None:
    assert run_diff(DiffRequest(store("old"), store("new", us=us, cpu=cpu)), paper) == 0
    shown = " ".join(text(paper).split())
    assert ("as advice" in shown) == (told is not None)
    assert told is None or told in shown


def test_a_scene_that_changed_is_told_and_not_compared(
    stored: Copy, planted: Planted, paper: Console
) -> None:
    def renamed(frame: pd.DataFrame) -> None:
        frame.loc[1:, "scene"] = "another"

    def both(frame: pd.DataFrame) -> None:
        renamed(frame)
        planted(9.0)(frame)

    old, new = stored("old", renamed, text="a = 1"), stored("new", both, text="a = 2")
    assert run_diff(DiffRequest(old, new), paper) == 0
    shown = text(paper)
    assert "the text of fourbar-lecture-1 changed: 1 cell not compared" in shown
    assert run_diff(DiffRequest(old, new, strict=True), paper) == 1


def test_a_comment_in_scene_text_is_no_change(stored: Copy, paper: Console) -> None:
    old, new = stored("old", text="a = 1"), stored("new", text="# new\na = 1")
    assert run_diff(DiffRequest(old, new, strict=True), paper) == 0


def test_missing_cells_are_told_and_count_when_strict(stored: Copy, paper: Console) -> None:
    old, new = stored("old"), stored("new", drop=(3,))
    assert run_diff(DiffRequest(old, new), paper) == 0
    assert "fourbar-lecture-1, pymunk as-shipped, 90 steps a turn" in text(paper)
    assert run_diff(DiffRequest(old, new, strict=True), paper) == 1
    assert "NOT WHOLE (--strict)" in text(paper)


def test_versions_of_one_store_are_compared(store: Copy, paper: Console) -> None:
    store("s", version="3.6.0")
    folder = store("s", version="3.7.0")
    request = DiffRequest(folder, folder, old_version="3.6.0", new_version="3.7.0")
    assert run_diff(request, paper) == 0
    assert "mujoco 3.6.0 -> 3.7.0" in text(paper)


def test_junit_has_a_case_for_every_cell(
    stored: Copy, planted: Planted, paper: Console, tmp_path: Path
) -> None:
    path = tmp_path / "j.xml"
    old = stored("old", drop=(2,))
    new = stored("new", planted(1.5), drop=(3,))
    assert run_diff(DiffRequest(old, new, junit=path), paper) == 1
    (suite,) = Xml.fromstring(path.read_text(encoding="utf-8"))
    assert [suite.get(key) for key in ("tests", "failures", "skipped")] == ["4", "1", "2"]
    failed = {case.get("name"): case.find("failure") for case in suite.iter("testcase")}
    (failure,) = [found for found in failed.values() if found is not None]
    assert "mujoco tuned, 90 steps a turn, 1 turn: position" in failure.get("message", "")
    assert "ratio 1.50 (worse)" in (failure.text or "")
    run_diff(DiffRequest(old, new, junit=path, strict=True), paper)
    (suite,) = Xml.fromstring(path.read_text(encoding="utf-8"))
    assert suite.get("failures") == "2", "the exit code 1 of --strict is told in the file too"


def test_markdown_goes_to_the_terminal_or_to_a_file(
    stored: Copy, planted: Planted, paper: Console, tmp_path: Path
) -> None:
    old, new = stored("old"), stored("new", planted(1.2))
    assert run_diff(DiffRequest(old, new, format="md"), paper) == 1
    printed = text(paper)
    assert printed.startswith("## crankcheck diff: worse\n")
    assert "| fourbar-lecture-1 | mujoco tuned | 90 | position |" in printed
    path = tmp_path / "diff.md"
    assert run_diff(DiffRequest(old, new, format="md", output=path), paper) == 1
    assert path.read_text(encoding="utf-8") == printed
    assert "WORSE: 1 worse" in text(paper), "the terminal then has the text"


def test_a_full_disk_costs_the_file_and_not_the_verdict(
    stored: Copy, paper: Console, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    request = DiffRequest(stored("old"), stored("new"), junit=tmp_path / "j.xml")
    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(CrankcheckError, match="No space left"):
        run_diff(request, paper)
    assert "NOT WORSE" in text(paper)


def test_a_mistake_is_refused_before_anything_is_written(
    stored: Copy, paper: Console, tmp_path: Path
) -> None:
    old, new, path = stored("old"), stored("new"), tmp_path / "x"
    for request, fault in (
        (DiffRequest(old, tmp_path / "none", junit=path), "none: no such folder"),
        (DiffRequest(old, new, factor=0.5, junit=path), "--factor 0.5"),
        (
            DiffRequest(old, new, format="html", junit=path),
            "--format 'html': unknown; use text or md",
        ),
        (DiffRequest(old, new, output=path, junit=path), "-o and --junit: both name"),
        (DiffRequest(old, new, output=tmp_path), "-o .*: a folder"),
        (DiffRequest(old, new, old_version="9", junit=path), "--old-version 9: .* has mujoco"),
    ):
        with pytest.raises(CrankcheckError, match=fault):
            run_diff(request, paper)
        assert not path.exists()
        assert text(paper) == ""
