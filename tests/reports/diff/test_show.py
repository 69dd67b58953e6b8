"""A large diff stays readable, in every form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from rich.console import Console

from reports.diff.costs import cost_text
from reports.diff.junit import suite
from reports.diff.markdown import markdown
from reports.diff.terminal import show
from reports.diff.words import left_out, lines
from reports.output.junit import junit
from reports.results.changes.changes import Diff, compare
from reports.results.changes.runs import CellCost, StoredCell, StoredRun
from tests.worlds.tiers import few

Make = Callable[..., StoredCell]
Group = Callable[..., StoredRun]
STEPS = (90.0, 180.0, 360.0, 720.0)


def shown(diff: Diff, width: int = 100) -> str:
    console = Console(width=width)
    with console.capture() as captured:
        show(console, diff)
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


def test_a_large_diff_is_not_ninety_screens(large: Diff) -> None:
    text = shown(large)
    assert len(text.splitlines()) < 1000
    assert "600 worse, 600 better, 600 equal, 600 new, 600 missing" in text
    assert "and 140 more rows" in text, "of 150 better rows 10 are shown"


@pytest.mark.parametrize(
    "width", few([40, 60, 80, 100, 200], [40, 100], "widths at which other columns give way")
)
def test_no_line_is_wider_than_the_terminal(large: Diff, width: int) -> None:
    assert max(len(line.rstrip()) for line in shown(large, width).splitlines()) <= width


def test_the_ratio_is_whole_in_a_narrow_terminal(cell: Make, run: Group) -> None:
    diff = compare(run(cell(angle=1e-7)), run(cell(angle=1.234e-3)))
    for width in (40, 80, 120):
        assert "1.23e+04" in shown(diff, width)


def test_markdown_of_a_large_diff_fits_a_comment(large: Diff) -> None:
    text = markdown(large)
    assert len(text.encode()) < 60_000
    assert "more rows" in text
    assert "600 missing" in text
    assert text.count("<details>") == text.count("</details>") == 3


def test_markdown_of_long_remarks_fits_a_comment(cell: Make, run: Group) -> None:
    names = [f"{number}" * 3000 for number in range(10, 40)]
    old = run(*(cell(name, angle=1e-3) for name in names), label="x" * 5000)
    new = run(*(cell(name, status="crashed", reason="y" * 9000) for name in names))
    assert len(markdown(compare(old, new)).encode()) < 60_000


def test_names_can_not_break_markdown(cell: Make, run: Group) -> None:
    old = run(cell("a|b", "x<b>*y*\n[z](u)", angle=1e-3))
    new = run(cell("a|b", "x<b>*y*\n[z](u)", angle=2e-3))
    (row,) = [line for line in markdown(compare(old, new)).splitlines() if "e-03" in line]
    assert row.startswith(r"| a\|b | mujoco x\<b\>\*y\* \[z\](u) | 720 | angle |")


def test_names_can_not_break_the_terminal_or_junit(cell: Make, run: Group) -> None:
    old = run(cell("[red]a", "\x07<b>", angle=1e-3))
    new = run(cell("[red]a", "\x07<b>", angle=2e-3))
    diff = compare(old, new)
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
        assert line.steps == wanted
    assert left_out(reversed(old.cells.values())) == [
        "a, mujoco tuned, 90, 180, 360, 720 steps a turn"
    ]


def test_versions_are_told_once_or_with_each_row(cell: Make, run: Group) -> None:
    old = run(cell("a", angle=1.0, version="1"), cell("b", angle=1.0, version="1"))
    one = run(cell("a", angle=2.0, version="2"), cell("b", angle=2.0, version="2"))
    two = run(cell("a", angle=2.0, version="2"), cell("b", angle=2.0, version="3"))
    assert {line.engine for line in lines(compare(old, one), "worse")} == {"mujoco tuned"}
    assert {line.engine for line in lines(compare(old, two), "worse")} == {
        "mujoco tuned (1 -> 2)",
        "mujoco tuned (1 -> 3)",
    }


def test_cells_that_failed_in_both_are_told(cell: Make, run: Group) -> None:
    same = run(cell("a", status="diverged"), cell("b", angle=1e-3))
    assert "1 of the equal ones failed in both (diverged)" in shown(compare(same, same))


@pytest.mark.parametrize(
    ("apart", "told"), [(0.01, "1.20 x (median of 1 cell)"), (0.3, "equal inside the noise of 30%")]
)
def test_costs_are_equal_inside_the_noise_of_the_runs(
    cell: Make, run: Group, apart: float, told: str
) -> None:
    old = replace(cell(angle=1e-3), cost=CellCost(2.0, apart, "abacus"))
    new = replace(cell(angle=1e-3), cost=CellCost(2.4, apart, "abacus"))
    assert told in cost_text(compare(run(old), run(new)))
