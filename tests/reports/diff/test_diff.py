"""`crankcheck diff` as a user sees it: exit code, what is named, files, also of a large diff."""

import io
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as Xml

import pandas as pd
import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.diff.document import markdown, show_diff, suite
from reports.diff.words import left_out, lines
from reports.output.formats import junit
from reports.requests.diff import DiffRequest
from reports.results.changes import Diff, compare
from reports.results.runs import StoredCell, StoredRun

Copy = Callable[..., Path]
Run = Callable[..., tuple[int, str]]
Make = Callable[..., StoredCell]
Group = Callable[..., StoredRun]
STEPS = (90.0, 180.0, 360.0, 720.0)


def planted(growth: float, column: str = "position_pure") -> Callable[[pd.DataFrame], None]:
    def plant(frame: pd.DataFrame) -> None:
        frame.loc[0, column] *= growth

    return plant


@pytest.fixture
def paper() -> Console:
    """A console that records what a pipe would get."""
    return Console(width=100, record=True, file=io.StringIO())


@pytest.fixture
def diff(paper: Console) -> Run:
    """The command on two folders: its exit code, and all that it says."""

    def of(old: Path, new: Path, **asked: object) -> tuple[int, str]:
        return DiffRequest(old, new, **asked).run(paper, paper), paper.export_text()

    return of


def flat(told: tuple[int, str]) -> tuple[int, str]:
    return told[0], " ".join(told[1].split())


def test_a_run_against_itself_or_with_another_comment_ends_with_0(stored: Copy, diff: Run) -> None:
    old = stored("old", text="a = 1")
    for new in (old, stored("new", text="# new\na = 1")):
        code, shown = diff(old, new, strict=True)
        assert code == 0
        assert "NOT WORSE: 0 worse, 0 better, 4 equal, 0 new, 0 missing" in shown


def test_a_planted_growth_or_end_ends_with_1_and_is_named(stored: Copy, diff: Run) -> None:
    old, new = stored("old"), stored("new", planted(1.2))
    code, shown = diff(old, new)
    assert code == 1
    assert shown.startswith("WORSE: 1 worse, 0 better, 3 equal, 0 new, 0 missing")
    (row,) = [line for line in shown.splitlines() if line.startswith("fourbar-lecture-1")]
    assert row.split()[:5] == ["fourbar-lecture-1", "mujoco", "tuned", "90", "position"]
    assert row.split()[-1] == "1.20"
    assert diff(new, old)[0] == 0
    less = stored("less", planted(1.05))
    assert [diff(old, less)[0], diff(old, less, factor=1.01)[0]] == [0, 1]
    assert diff(old, stored("rounded", planted(20.0, "drive_pure")))[0] == 0

    def diverging(frame: pd.DataFrame) -> None:
        frame.loc[2, ["status", "reason"]] = ["diverged", "came apart at 0.1 s"]

    code, shown = flat(diff(old, stored("lost", diverging)))
    assert code == 1
    assert "pymunk tuned 90 status ok diverged -" in shown
    assert "pymunk tuned: came apart at 0.1 s" in shown


@pytest.mark.parametrize(
    ("us", "cpu", "told"),
    [(4.0, "one", "mujoco tuned 2.00 x (median of 2 cells)"),
     (2.1, "one", "equal inside the noise of 10%"),
     (4.0, "another", None)],
)  # fmt: skip
def test_costs_are_only_advice(
    us: float, cpu: str, told: str | None, store: Copy, diff: Run
) -> None:
    code, shown = flat(diff(store("old"), store("new", us=us, cpu=cpu)))
    assert code == 0
    assert ("as advice" in shown) == (told is not None)
    assert told is None or told in shown


def test_versions_are_told_once_or_by_row(store: Copy, diff: Run, cell: Make, run: Group) -> None:
    store("s", version="3.6.0")
    folder = store("s", version="3.7.0")
    code, shown = diff(folder, folder, old_version="3.6.0", new_version="3.7.0")
    assert code == 0
    assert "mujoco 3.6.0 -> 3.7.0" in shown

    def made(angle: float, a: str, b: str) -> StoredRun:
        return run(cell("a", angle=angle, version=a), cell("b", angle=angle, version=b))

    for b, told in (("2", {""}), ("3", {" (1 -> 2)", " (1 -> 3)"})):
        found = lines(compare(made(1.0, "1", "1"), made(2.0, "2", b)), "worse")
        assert {line.cells["engine"] for line in found} == {f"mujoco tuned{each}" for each in told}


def test_a_scene_that_changed_is_told_and_not_compared(stored: Copy, diff: Run) -> None:
    def renamed(frame: pd.DataFrame) -> None:
        frame.loc[1:, "scene"] = "another"

    def both(frame: pd.DataFrame) -> None:
        renamed(frame)
        planted(9.0)(frame)

    old, new = stored("old", renamed, text="a = 1"), stored("new", both, text="a = 2")
    code, shown = diff(old, new)
    assert code == 0
    assert "the text of fourbar-lecture-1 changed: 1 cell not compared" in shown
    assert diff(old, new, strict=True)[0] == 1


def test_missing_cells_and_facts_are_told_and_cells_count_when_strict(
    stored: Copy, diff: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = stored("old"), stored("new", drop=(3,))
    missing = "fourbar-lecture-1, pymunk as-shipped, 90 steps a turn"
    for strict, words in ((False, missing), (True, "NOT WHOLE (--strict)")):
        code, shown = diff(old, new, strict=strict)
        assert code == strict
        assert words in shown
    assert capsys.readouterr().err == ""
    (new / "verify.json").unlink()
    for other in (old, new):  # each folder is told of once
        diff(other, new)
        assert capsys.readouterr().err.count(f"crankcheck: {new}: no verify.json") == 1


def test_junit_has_all_cells_and_markdown_a_place(stored: Copy, diff: Run, tmp_path: Path) -> None:
    path = tmp_path / "j.xml"
    old, new = stored("old", drop=(2,)), stored("new", planted(1.5), drop=(3,))
    assert diff(old, new, junit=path)[0] == 1
    (found,) = Xml.fromstring(path.read_text(encoding="utf-8"))
    assert [found.get(key) for key in ("tests", "failures", "skipped")] == ["4", "1", "2"]
    (failure,) = found.iter("failure")
    assert "mujoco tuned, 90 steps a turn, 1 turn: position" in failure.get("message", "")
    assert "ratio 1.50 (worse)" in (failure.text or "")
    diff(old, new, junit=path, strict=True)
    (found,) = Xml.fromstring(path.read_text(encoding="utf-8"))
    assert found.get("failures") == "2", "the exit code 1 of --strict is told in the file too"
    old, new, path = stored("whole"), stored("worse", planted(1.2)), tmp_path / "diff.md"
    code, printed = diff(old, new, format="md")
    assert code == 1
    assert printed.startswith("## crankcheck diff: worse\n")
    assert "| fourbar-lecture-1 | mujoco tuned | 90 | position |" in printed
    code, shown = diff(old, new, format="md", output=path)
    assert code == 1
    assert path.read_text(encoding="utf-8") == printed
    assert "WORSE: 1 worse" in shown, "the terminal then has the text"


def test_a_mistake_writes_nothing(stored: Copy, diff: Run, paper: Console, tmp_path: Path) -> None:
    old, path = stored("old"), tmp_path / "x"
    for fault, asked in {
        "none: no such folder": {"new": tmp_path / "none"},
        "--factor 0.5": {"factor": 0.5},
        "-o and --junit: both name": {"output": path},
        "-o .*: a folder": {"output": tmp_path, "junit": None},
        "--old-version 9: .* has mujoco": {"old_version": "9"},
    }.items():
        with pytest.raises(CrankcheckError, match=fault):
            diff(**{"old": old, "new": old, "junit": path, **asked})
        assert not path.exists()
        assert paper.export_text() == ""


def shown(diff: Diff, width: int = 100) -> str:
    console = Console(width=width)
    with console.capture() as captured:
        show_diff(console, diff)
    return captured.get()


@pytest.fixture(scope="module")
def large(cell: Make, run: Group) -> Diff:
    """3000 cells of 750 lines: some worse, better, new, missing, all with long names."""
    old, new = [], []
    for number in range(750):
        scene = f"{'a-long-name-' * 4}{number}"
        for steps in STEPS:
            variant = f"solref_timeconst_steps={number}, iterations=5"
            if number % 5 != 3:
                old.append(cell(scene, variant, steps, angle=1e-3))
            if number % 5 != 4:
                growth = (2.0, 0.5, 1.0, 1.0, 1.0)[number % 5]
                new.append(cell(scene, variant, steps, angle=1e-3 * growth))
    return compare(run(*old), run(*new))


def test_a_large_diff_is_not_ninety_screens_and_its_markdown_fits_a_comment(large: Diff) -> None:
    text = shown(large)
    assert len(text.splitlines()) < 1000
    assert "600 worse, 600 better, 600 equal, 600 new, 600 missing" in text
    assert "and 140 more rows" in text, "of 150 better rows 10 are shown"
    text = markdown(large)
    assert len(text.encode()) < 60_000
    assert "more rows" in text
    assert "600 missing" in text
    assert text.count("<details>") == text.count("</details>") == 3


@pytest.mark.parametrize("width", [40, 100])
def test_lines_fit_with_whole_ratios(width: int, large: Diff, cell: Make, run: Group) -> None:
    assert max(len(line.rstrip()) for line in shown(large, width).splitlines()) <= width
    diff = compare(run(cell(angle=1e-7)), run(cell(angle=1.234e-3)))
    assert "1.23e+04" in shown(diff, width)


def test_long_remarks_fit_a_comment_and_names_break_no_output(cell: Make, run: Group) -> None:
    same = run(cell("a", status="diverged"), cell("b", angle=1e-3))
    assert "1 of the equal ones failed in both (diverged)" in shown(compare(same, same))
    names = [f"{number}" * 3000 for number in range(10, 40)]
    old = run(*(cell(name, angle=1e-3) for name in names), label="x" * 5000)
    new = run(*(cell(name, status="crashed", reason="y" * 9000) for name in names))
    assert len(markdown(compare(old, new)).encode()) < 60_000

    def grown(*names: str) -> Diff:
        return compare(run(cell(*names, angle=1e-3)), run(cell(*names, angle=2e-3)))

    text = markdown(grown("a|b", "x<b>*y*\n[z](u)"))
    (row,) = [line for line in text.splitlines() if "e-03" in line]
    assert row.startswith(r"| a\|b | mujoco x\<b\>\*y\* \[z\](u) | 720 | angle |")
    diff = grown("[red]a", "\x07<b>")
    assert "[red]a" in shown(diff)
    assert "&lt;b&gt;" in junit(suite(diff))
    assert "\x07" not in junit(suite(diff))


def test_steps_of_a_line_are_named_each(cell: Make, run: Group) -> None:
    old = run(*(cell(steps=n, angle=1e-3) for n in STEPS))
    for growths, wanted in {
        (1.0, 1.0, 2.0, 1.0): "360",
        (3.0, 1.0, 2.0, 1.0): "90 (also 360)",
        (3.0, 1.0, 2.0, 4.0): "720 (also 90, 360)",
        (2.0, 3.0, 4.0, 5.0): "720 (all 4: 90 to 720)",
    }.items():
        new = [cell(steps=n, angle=1e-3 * g) for n, g in zip(STEPS, growths, strict=True)]
        (line,) = lines(compare(old, run(*new)), "worse")
        assert line.cells["steps\na turn"] == wanted
    (told,) = left_out(reversed(old.cells.values()))
    assert told == "a, mujoco tuned, 90, 180, 360, 720 steps a turn"
