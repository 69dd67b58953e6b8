"""The tables fit the terminal: less in them where it is narrow, nothing clipped."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from reports.cli.commands.solve import run_solve
from reports.cli.showing import SolveRequest
from reports.judge.cell import Checked, check
from reports.verify.table import show
from tests.worlds.turns import of_turns

CLIPPED = "\u2026"
NAMES = ("fourbar-lecture-1", "slider-crank-excel-350")


@pytest.fixture(scope="module")
def checked() -> list[Checked]:
    """Short and long names, large shares of a limit, and a floor."""
    limit = {"angle": 1e-7}
    return [
        check(of_turns(name, engine, profile=profile, gated=gated, tolerance=limit, converge=True))
        for name in NAMES
        for profile, gated in (("tuned", True), ("as-shipped", False))
        for engine in ("mujoco", "pymunk")
    ]


@pytest.mark.parametrize("width", [60, 72, 80, 99, 100, 140])
def test_a_verdict_is_whole_at_every_width(checked: list[Checked], width: int) -> None:
    """Scene, engine, worst and trend are there; what there is no room for is left out whole."""
    stream = io.StringIO()
    show(Console(file=stream, width=width), checked, {"crankcheck": "1"})
    text = stream.getvalue()
    lines = text.splitlines()
    table = text[text.index("profile tuned") : text.index("CC110")]
    assert max(len(line.rstrip()) for line in lines) <= width
    assert CLIPPED not in text
    for part in (*NAMES, "mujoco", "pymunk", "most of", "when dt", "shrink", "floor"):
        assert part in table
    for one in checked:
        assert f" {one.errors.worst('angle').pure:.1e} " in table
        if one.convergence and one.convergence.trend == "shrinks":
            assert one.convergence.words in table
    assert ("   gap " in text) is (width >= 80)
    assert ("accel." in text) is (width >= 100)
    # No row is torn by blank lines.
    start = next(i for i, line in enumerate(lines) if line.startswith("profile tuned"))
    end = next(i for i, line in enumerate(lines) if i > start and not line.strip())
    assert sum(any(name in line for line in lines[start:end]) for name in NAMES) == 2
    assert lines[end + 1].startswith("profile as-shipped")


@pytest.mark.parametrize("width", [60, 80, 100])
def test_a_motion_fits_as_well(width: int) -> None:
    stream = io.StringIO()
    run_solve(SolveRequest("sixbar-watt"), Console(file=stream, width=width))
    assert max(len(line.rstrip()) for line in stream.getvalue().splitlines()) <= width
    assert CLIPPED not in stream.getvalue()
