"""The tables fit the terminal: less in them where it is narrow, nothing clipped."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from models.files import load_scene
from reports.cli.commands.solve import run_solve
from reports.cli.showing import SolveRequest
from reports.judge.cell import Cell, Checked, check
from reports.verify.table import show

NAMES = ("fourbar-lecture-1", "slider-crank-excel-350")


@pytest.fixture(scope="module")
def checked() -> list[Checked]:
    """Short and long names, large shares of a limit, and a floor."""
    cells = [
        Cell(
            scene=scene,
            engine=engine,
            profile=profile,
            dt_s=scene.driver.law.period_s / 360,
            steps=360,
            gated=profile == "tuned",
            tolerance={"angle": 1e-7},
        )
        for scene in map(load_scene, NAMES)
        for profile in ("tuned", "as-shipped")
        for engine in ("mujoco", "pymunk")
    ]
    return [check(cell) for cell in cells]


def printed(checked: list[Checked], width: int) -> list[str]:
    stream = io.StringIO()
    show(Console(file=stream, width=width), checked, {"crankcheck": "1"})
    return stream.getvalue().splitlines()


@pytest.mark.parametrize("width", [60, 72, 80, 99, 100, 140])
def test_verdict_scene_engine_worst_and_trend_are_whole_at_every_width(
    checked: list[Checked], width: int
) -> None:
    lines = printed(checked, width)
    text = "\n".join(lines)
    table = text[text.index("profile tuned") : text.index("CC110")]
    assert max(len(line.rstrip()) for line in lines) <= width
    assert "\u2026" not in text  # the mark of what was clipped
    for part in (*NAMES, "mujoco", "pymunk", "most of", "when dt", "shrink", "floor"):
        assert part in table
    for one in checked:
        angle = one.errors.worst("angle")
        assert f" {angle.pure:.1e} " in table
        if one.convergence and one.convergence.trend == "shrinks":
            assert one.convergence.words in table


@pytest.mark.parametrize("width", [60, 80, 100])
def test_no_row_is_torn_by_blank_lines(checked: list[Checked], width: int) -> None:
    lines = printed(checked, width)
    start = next(i for i, line in enumerate(lines) if line.startswith("profile tuned"))
    end = next(i for i, line in enumerate(lines) if i > start and not line.strip())
    assert sum(any(name in line for line in lines[start:end]) for name in NAMES) == 2
    assert lines[end + 1].startswith("profile as-shipped")


@pytest.mark.parametrize(("width", "gap"), [(60, False), (80, True), (100, True)])
def test_what_there_is_no_room_for_is_left_out_whole(
    checked: list[Checked], width: int, gap: bool
) -> None:
    text = "\n".join(printed(checked, width))
    assert ("   gap " in text) is gap
    assert ("accel." in text) is (width == 100)


@pytest.mark.parametrize("width", [60, 80, 100])
def test_a_motion_fits_as_well(width: int) -> None:
    stream = io.StringIO()
    request = SolveRequest("sixbar-watt")
    run_solve(request, Console(file=stream, width=width))
    lines = stream.getvalue().splitlines()
    assert max(len(line.rstrip()) for line in lines) <= width
    assert "\u2026" not in stream.getvalue()
