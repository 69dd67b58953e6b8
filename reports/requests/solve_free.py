"""`crankcheck solve` of a scene that is let go: its free motion over time."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from rich.console import Console

from analytic.free.release import release
from models.array import Array
from models.errors import CrankcheckError, harmless
from models.scene import Scene
from reports.describe.frame import motion_frame
from reports.describe.free_motion import free_columns
from reports.output.console import say, say_whole
from reports.output.frame_file import SHEET_ROWS, write_frame
from reports.output.write import check_folder, write
from reports.requests.free_text import show_free
from reports.requests.options import given
from reports.requests.solve_options import SolveOptions

PAGE = ".html"
ON_SCREEN, IN_A_FILE, MOST_SAMPLES = 12, 1000, 1_000_000


def run_solve_free(scene: Scene, request: SolveOptions, console: Console) -> None:
    """Show or write the free motion. Raises CrankcheckError for what can not be asked of it."""
    refuse_turns(scene, request)
    is_page = request.output is not None and request.output.suffix.lower() == PAGE
    if is_page and request.steps is not None:
        raise CrankcheckError(f"-o {request.output}: a page has its own samples; leave out --steps")
    time_s = free_instants(scene, request)
    if request.figures is not None:
        from reports.figures.free.writing import free_figure_files, written_free_figures

        check_folder(request.figures, "--figures", free_figure_files())
    free = release(scene, float(time_s[-1]))
    told = []
    if request.figures is not None:
        told.append(written_free_figures(free, request.figures))
    if is_page:
        from reports.requests.scene_report import free_page_of

        assert request.output is not None
        write(request.output, free_page_of(free))
        told.append(f"{request.output}: the free motion of {scene.name} over {time_s[-1]:g} s")
    elif request.output is not None:
        motion = free.at(time_s)
        frame = motion_frame(motion).assign(**free_columns(free, time_s))
        origin = {"scene": scene.name, "source": scene.source}
        write_frame(request.output, frame, "motion", origin)
        told.append(f"{request.output}: {time_s.size} samples of {scene.name}")
    for line in told:
        say_whole(console, harmless(line))
    if not told:
        show_free(console, free, free.at(time_s))
        more = "Points, and more digits: -o out.csv, .parquet or .xlsx; figures: -o out.html"
        say(console, more, "dim")


def refuse_turns(scene: Scene, request: SolveOptions) -> None:
    """Refuse what is asked of a driver that follows a law. Raises CrankcheckError."""
    of_driver = "at_deg at_m turns steps_per_turn clockwise along forces"
    for option in given(request, *of_driver.split()):
        raise CrankcheckError(
            f"{option}: {scene.name} is let go, and moves over time as masses and forces have "
            f"it; leave {option} out, and give --duration and --steps"
        )


def free_instants(scene: Scene, request: SolveOptions) -> Array:
    """From 0 to the end, both included [s]. Raises CrankcheckError."""
    until_s = scene.driver.law.period_s if request.duration is None else request.duration
    if not (math.isfinite(until_s) and until_s > 0.0):
        raise CrankcheckError(f"--duration {until_s:g}: give seconds above 0")
    steps = request.steps
    if steps is None:
        steps = ON_SCREEN if request.output is None else IN_A_FILE
    if steps < 1:
        raise CrankcheckError(f"--steps {steps}: give at least 1")
    most = _most_samples(request.output)
    if steps >= most:
        raise CrankcheckError(f"--steps {steps}: {steps + 1:.7g} samples; at most {most}")
    return np.linspace(0.0, until_s, steps + 1)


def _most_samples(path: Path | None) -> int:
    """That a file of its kind has room for."""
    is_workbook = path is not None and path.suffix.lower() == ".xlsx"
    return SHEET_ROWS if is_workbook else MOST_SAMPLES
