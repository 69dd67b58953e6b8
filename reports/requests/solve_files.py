"""The files of `solve`: a motion, a page, figures."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.motion import Motion
from models.scene import Scene
from reports.describe.frame import motion_frame
from reports.output.console import say_whole
from reports.output.frame_file import write_frame
from reports.output.write import check_folder, write
from reports.requests.named import LIVE_SHEET, named
from reports.requests.solve_lengths import (
    PAGE,
    WORKBOOK,
)
from reports.requests.solve_options import SolveOptions


def tell_written(console: Console, scene: Scene, motion: Motion, request: SolveOptions) -> None:
    """Write what was asked for, and say so."""
    told = []
    if request.figures is not None:
        from reports.figures.forces.writing import written_figures

        told.append(written_figures(scene, request.figures))
    if request.output is not None:
        told.append(_write(request.output, scene, motion, is_turn=not request.at_place))
    for each in told:
        say_whole(console, harmless(each))


def check_page(request: SolveOptions) -> None:
    """Refuse a page of a single position, or of other than a turn."""
    given = [request.at_deg, request.at_m, request.turns, request.steps_per_turn]
    is_page = request.output is not None and request.output.suffix.lower() == PAGE
    if is_page and any(each is not None for each in given):
        raise CrankcheckError(
            f"-o {request.output}: a page shows a turn; leave out --at-deg, --at-m, --turns and "
            "--steps-per-turn"
        )


def check_figures(request: SolveOptions) -> None:
    """Refuse figures of what is not asked for, before anything is worked out."""
    if request.figures is None:
        return
    if not request.forces:
        raise CrankcheckError("--figures: it draws forces; give --forces as well")
    if request.at_place:
        raise CrankcheckError(
            f"--figures with {request.at_place}: they are of a turn; leave one of them out"
        )
    from reports.figures.forces.writing import figure_files

    check_folder(request.figures, "--figures", figure_files())


def _write(path: Path, scene: Scene, motion: Motion, *, is_turn: bool) -> str:
    """The motion as a file of the kind that the ending says; returns what was written, in a
    line."""
    if path.suffix.lower() == PAGE:
        from reports.requests.scene_report import page_of

        write(path, page_of(scene, with_forces=motion.forces is not None))
        return f"{path}: {scene.name} over one turn"
    origin = {"scene": scene.name, "source": scene.source}
    frame, more, told = motion_frame(motion), None, ""
    if path.suffix.lower() == WORKBOOK and is_turn:
        told, more = named(LIVE_SHEET)(scene, motion.time_s, list(frame.columns))
    write_frame(path, frame, "motion", origin, more)
    return f"{path}: {motion.time_s.size} samples of {scene.name}{told}"
