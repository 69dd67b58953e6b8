"""`crankcheck solve`: the reference alone, at one driver angle or over time."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from rich.console import Console

from analytic.kinematics import solve, solve_driven
from analytic.mechanism.cycle import Along
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError, harmless, suggestion
from models.files import find_scene, load_scene
from models.motion import Motion
from models.scene import Scene
from reports.cli.showing import SolveRequest
from reports.describe.driver_at import MOST_DEG, driver_at
from reports.describe.facts import speed_facts
from reports.describe.frame import motion_frame
from reports.describe.with_forces import with_forces
from reports.face.elastic_choice import ElasticChoice
from reports.face.solution_text import (
    show_friction,
    show_heading,
    show_largest,
    show_motion,
    show_notes,
    show_position,
)
from reports.output.frame_file import ENDINGS, SHEET_ROWS, write_frame
from reports.output.write import check_file, check_folder, write

PAGE, WORKBOOK = ".html", ".xlsx"
FAMILY_ENDINGS = (WORKBOOK, PAGE, ".svg", ".pdf")
ON_SCREEN = 12
IN_A_FILE = 360
MOST_SAMPLES = 1_000_000
ENDLESS = 10**15
"""Steps beyond which a float does not count them."""


def run_solve(request: SolveRequest, console: Console) -> None:
    """Show or write the reference. Raises CrankcheckError for what can not be asked."""
    if request.output is not None:
        endings = (*ENDINGS, PAGE) if request.family is None else FAMILY_ENDINGS
        check_file(request.output, "-o", endings, inputs=[find_scene(request.scene)])
    scene = load_scene(request.scene)
    asked = elastic_choice(request)
    if request.family is not None:
        from reports.cli.commands.solve_family import run_family  # slow to import

        run_family(scene, request, console)
        return
    if scene.elastic:
        from reports.cli.commands.solve_elastic import run_solve_elastic  # slow to import

        run_solve_elastic(scene, request, asked, console)
        return
    asked.refuse_of_rigid(scene)
    if scene.is_free:
        from reports.cli.commands.solve_free import run_solve_free  # slow to import

        run_solve_free(scene, request, console)
        return
    _check_driven(scene, request)
    along = [_along(scene, text) for text in request.along]
    structure = analyse(scene)
    motion = _over(scene, request) if not request.at_place else _at(scene, request)
    if request.forces:
        motion = with_forces(scene, motion, by_law=not request.at_place)
    if request.output is not None or request.figures is not None:
        _tell_written(console, scene, motion, request)
        return
    speeds = speed_facts(scene, along, clockwise=request.clockwise)
    show_heading(console, scene, structure, along, speeds)
    _show(console, scene, motion, request)
    show_notes(console, scene, motion)


def elastic_choice(request: SolveRequest) -> ElasticChoice:
    """What was asked for of elastic links."""
    return ElasticChoice(
        request.modes, request.axial_modes, request.elements, request.shape, request.linear
    )


def _check_driven(scene: Scene, request: SolveRequest) -> None:
    """Refuse what can not be asked of a scene that is driven. Raises CrankcheckError."""
    refuse_times(scene, request)
    if request.at_place and (request.turns or request.steps_per_turn):
        raise CrankcheckError(
            f"{request.at_place} with --turns or --steps-per-turn: one is a single "
            "position, the others a motion; give one of them"
        )
    if request.clockwise and not request.at_place:
        raise CrankcheckError("--clockwise: it is of one position; give --at-deg, such as 90")
    _check_figures(request)
    _check_page(request)


def _tell_written(console: Console, scene: Scene, motion: Motion, request: SolveRequest) -> None:
    """Write what was asked for, and say so."""
    told = []
    if request.figures is not None:
        from reports.figures.forces.writing import written_figures

        told.append(written_figures(scene, request.figures))
    if request.output is not None:
        told.append(_write(request.output, scene, motion, is_turn=not request.at_place))
    for each in told:
        console.print(harmless(each), highlight=False, markup=False, soft_wrap=True)


def _show(console: Console, scene: Scene, motion: Motion, request: SolveRequest) -> None:
    """Print one position, or a motion."""
    if request.at_place:
        show_position(console, scene, motion)
        if request.forces:
            show_friction(console, scene)
        return
    show_motion(console, scene, motion)
    if request.forces:
        show_largest(console, scene)
        show_friction(console, scene)
    console.print(
        "Points, and more digits: -o out.csv, .parquet or .xlsx", style="dim", highlight=False
    )


def refuse_times(scene: Scene, request: SolveRequest) -> None:
    """Refuse what is asked of free motion alone, of a scene that is driven. Raises
    CrankcheckError."""
    for option, value in (("--duration", request.duration), ("--steps", request.steps)):
        if value is not None:
            raise CrankcheckError(
                f'{option} {value:g}: {scene.name} is driven, and not let go (law = "free"); give '
                "--turns and --steps-per-turn"
            )


def _check_page(request: SolveRequest) -> None:
    """Refuse a page of a single position, or of other than a turn."""
    given = [request.at_deg, request.at_m, request.turns, request.steps_per_turn]
    is_page = request.output is not None and request.output.suffix.lower() == PAGE
    if is_page and any(each is not None for each in given):
        raise CrankcheckError(
            f"-o {request.output}: a page shows a turn; leave out --at-deg, --at-m, --turns and "
            "--steps-per-turn"
        )


def _check_figures(request: SolveRequest) -> None:
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


def _along(scene: Scene, text: str) -> Along:
    """A point and a direction, from text such as C:30."""
    point, colon, degrees = text.partition(":")
    try:
        direction_deg = float(degrees)
    except ValueError:
        direction_deg = math.nan
    if not (colon and abs(direction_deg) <= MOST_DEG):
        raise CrankcheckError(
            f"--along {text}: write a point and a direction in degrees, such as C:30"
        )
    points = dict.fromkeys([*scene.pins, *(slider.point for slider in scene.sliders.values())])
    if point not in points:
        raise CrankcheckError(f"--along {text}: {suggestion(point, points, 'the points are')}")
    return Along(point, math.radians(direction_deg))


def _at(scene: Scene, request: SolveRequest) -> Motion:
    """The mechanism with its driver at a place, moving as its law moves it there."""
    theta, omega, alpha = driver_at(
        scene, request.at_deg, request.at_m, clockwise=request.clockwise
    )
    return solve_driven(scene, np.array([theta]), np.array([omega]), np.array([alpha]))


def _over(scene: Scene, request: SolveRequest) -> Motion:
    """The motion over whole turns, the last sample included."""
    return solve(scene, instants_of(scene, request))


def instants_of(scene: Scene, request: SolveRequest) -> Array:
    """Those of whole turns, the last sample included [s]. Raises CrankcheckError."""
    turns = 1.0 if request.turns is None else request.turns
    steps = request.steps_per_turn
    if steps is None:
        steps = ON_SCREEN if request.output is None else IN_A_FILE
    if not (math.isfinite(turns) and turns > 0.0):
        raise CrankcheckError(f"--turns {turns:g}: give a number above 0; 1 is one period")
    if steps < 1:
        raise CrankcheckError(f"--steps-per-turn {steps}: give at least 1")
    most = MOST_SAMPLES
    if request.output is not None and request.output.suffix.lower() == WORKBOOK:
        most = SHEET_ROWS
    steps = min(steps, ENDLESS)
    last = turns * steps * (1 - 1e-12)  # may be infinite
    if not last <= most - 1:
        raise CrankcheckError(
            f"--turns {turns:g} --steps-per-turn {steps}: {last + 1:.7g} samples; at most {most}: "
            "take fewer turns, or fewer steps in a turn"
        )
    samples = math.ceil(last) + 1
    step_s = scene.driver.law.period_s / steps
    return step_s * np.arange(samples, dtype=np.float64)


def _write(path: Path, scene: Scene, motion: Motion, *, is_turn: bool) -> str:
    """The motion as a file of the kind that the ending says; returns what was written, in a
    line."""
    if path.suffix.lower() == PAGE:
        from reports.face.scene_report import page_of

        write(path, page_of(scene, with_forces=motion.forces is not None))
        return f"{path}: {scene.name} over one turn"
    origin = {"scene": scene.name, "source": scene.source}
    frame, more, told = motion_frame(motion), None, ""
    if path.suffix.lower() == WORKBOOK and is_turn:
        from reports.workbook.beside_values import beside_values, left_out

        told = left_out(motion.time_s.size)
        more = beside_values(scene, motion.time_s, list(frame.columns))
    write_frame(path, frame, "motion", origin, more)
    return f"{path}: {motion.time_s.size} samples of {scene.name}{told}"
