"""`solve`: the closed form alone, at one place of the driver or over time."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Console

from analytic import kinematics
from analytic.mechanism.cycle import Along
from analytic.result import Selection
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError, suggestion
from models.files import find_scene, load_scene
from models.laws import MOST_TURNS
from models.motion import Motion
from models.samples import samples
from models.scene import Scene
from reports.describe.facts import speed_facts
from reports.describe.law import MOST_DEG, driver_at
from reports.describe.with_forces import with_forces
from reports.output.console import say
from reports.output.frame_file import ENDINGS
from reports.output.write import check_file
from reports.requests.arguments import SceneLike, is_true, scene_of
from reports.requests.elastic_choice import ElasticChoice
from reports.requests.named import FAMILY, named
from reports.requests.solution import Solution
from reports.requests.solution_text import (
    show_friction,
    show_heading,
    show_largest,
    show_motion,
    show_notes,
    show_position,
)
from reports.requests.solve_files import check_figures, check_page, tell_written
from reports.requests.solve_lengths import (
    FAMILY_ENDINGS,
    PAGE,
    elastic_choice,
    instants_of,
    refuse_times,
)
from reports.requests.solve_options import SolveOptions
from reports.requests.told import told_at_the_call

SAMPLES = 361
"""Instants of a period, both ends included, where none are given: as in a file of the command."""
Names = str | Iterable[str] | None


@told_at_the_call
def solve(
    scene: SceneLike,
    time_s: ArrayLike | None = None,
    *,
    links: Names = None,
    points: Names = None,
    sliders: Names = None,
    bound: bool = True,
    forces: bool = False,
    modes: int | None = None,
    axial_modes: int | None = None,
    elements: int | None = None,
    shape: str | None = None,
    linear: bool = False,
) -> Solution:
    """The motion of a scene at some times, in closed form; of one that is let go, its free motion,
    integrated (`FreeSolution`); of one with elastic links, how these bend (`ElasticSolution`).

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    time_s : ArrayLike or None
        Times [s], shape (T,), in any order; 361 over a period of the driver for None.
    links, points, sliders : str, Iterable[str] or None
        What to return, by one name or several; None is all, () is none.
    bound : bool
        Carry error bounds (about three times the work).
    forces : bool
        Have the reactions and the driving torque as well; NaN in dead points of the driver.
    modes, axial_modes, elements : int or None
        Of elastic links: sines across and along each, or beam elements.
    shape : str or None
        What elastic links start with: ``periodic``, ``quasi-static`` or ``straight``; None is what
        the scene says.
    linear : bool
        Leave out that a bent link is shorter.

    Raises
    ------
    CrankcheckError
        A scene, times or names that are none; a StructureError for a mechanism without a closed
        form, a ReachError for a driver angle that it can not be assembled in. Of forces: a scene
        without mass and load, or no instant outside of dead points.
    """
    scene = scene_of(scene)
    asked = ElasticChoice(modes, axial_modes, elements, shape, linear)
    if not scene.elastic:
        asked.refuse_of_rigid(scene)
    if time_s is None:
        time_s = np.linspace(0.0, scene.driver.law.period_s, SAMPLES)
    if scene.elastic:
        return _elastic_solution(scene, time_s, links, points, sliders, asked, forces=forces)
    if scene.is_free:
        return _free_solution(scene, time_s, links, points, sliders, bound=bound, forces=forces)
    # Whatever the times are, they are looked at there.
    motion = kinematics.solve(
        scene,
        cast(Array, time_s),
        links=links,
        points=points,
        sliders=sliders,
        bound=is_true(bound, "bound"),
    )
    _refuse_far(scene, motion)
    if is_true(forces, "forces"):
        motion = with_forces(scene, motion, bound=bound)
    return Solution(**vars(motion), scene=scene)


def _free_solution(
    scene: Scene,
    time_s: ArrayLike,
    links: Names,
    points: Names,
    sliders: Names,
    *,
    bound: bool,
    forces: bool,
) -> Solution:
    """The free motion of a scene. Raises CrankcheckError."""
    from reports.requests.free_solution import free_solution  # slow to import

    if is_true(forces, "forces"):
        raise CrankcheckError(f"forces=True: {scene.name} is let go, and has no driving torque")
    wanted = Selection.of(scene, links, points, sliders)
    instants = samples(time_s, "time_s")
    return free_solution(scene, instants, wanted, bound=is_true(bound, "bound"))


def _elastic_solution(
    scene: Scene,
    time_s: ArrayLike,
    links: Names,
    points: Names,
    sliders: Names,
    asked: ElasticChoice,
    *,
    forces: bool,
) -> Solution:
    """The motion of a scene with elastic links. Raises CrankcheckError."""
    from reports.requests.elastic_solution import elastic_solution  # slow to import

    if is_true(forces, "forces") and scene.is_free:
        raise CrankcheckError(f"forces=True: {scene.name} is let go, and has no driving torque")
    wanted = Selection.of(scene, links, points, sliders)
    return elastic_solution(scene, samples(time_s, "time_s"), wanted, asked, forces=forces)


def _refuse_far(scene: Scene, motion: Motion) -> None:
    """Refuse times so late that the place within a turn is lost. Raises CrankcheckError."""
    far_s = float(np.max(np.abs(motion.time_s), initial=0.0))
    turns = far_s / scene.driver.law.period_s
    if turns > MOST_TURNS:
        raise CrankcheckError(
            f"time_s: t = {far_s:.6g} s is {turns:.3g} turns of {scene.name}, and at most "
            f"{MOST_TURNS:g} leave the digits that tell where in a turn it is; "
            "give times in seconds"
        )


@told_at_the_call
def solve_driven(
    scene: SceneLike,
    theta: ArrayLike,
    omega: ArrayLike,
    alpha: ArrayLike,
    time_s: ArrayLike | None = None,
    *,
    links: Names = None,
    points: Names = None,
    sliders: Names = None,
    bound: bool = True,
    forces: bool = False,
) -> Solution:
    """The motion of a scene whose driver has given angles, rates and accelerations.

    Parameters
    ----------
    theta, omega, alpha : ArrayLike
        Angles [rad], rates [rad/s] and accelerations [rad/s^2] of the driver, shape (T,), taken as
        exact; one rate, or one acceleration, counts for all samples.
    time_s : ArrayLike or None
        Times [s] that label the samples, and nothing else.
    scene, links, points, sliders, bound, forces
        As of `solve`; forces need the whole motion.

    Raises
    ------
    CrankcheckError
        As `solve`.
    """
    scene = scene_of(scene)
    motion = kinematics.solve_driven(
        scene,
        cast(Array, theta),
        cast(Array, omega),
        cast(Array, alpha),
        cast(Array | None, time_s),
        links=links,
        points=points,
        sliders=sliders,
        bound=is_true(bound, "bound"),
    )
    if is_true(forces, "forces"):
        motion = with_forces(scene, motion, by_law=False, bound=bound)
    return Solution(**vars(motion), scene=scene)


@dataclass(frozen=True)
class SolveRequest(SolveOptions):
    """What `solve` was asked for, as given."""

    def run(self, console: Console, progress: Console) -> int:
        """Show or write the reference. Raises CrankcheckError for what can not be asked."""
        if self.output is not None:
            endings = (*ENDINGS, PAGE) if self.family is None else FAMILY_ENDINGS
            check_file(self.output, "-o", endings, inputs=[find_scene(self.scene)])
        scene = load_scene(self.scene)
        asked = elastic_choice(self)
        if self.family is not None:
            named(FAMILY)(scene, self, console)
            return 0
        if scene.elastic:
            from reports.requests.solve_elastic import run_solve_elastic  # slow to import

            run_solve_elastic(scene, self, asked, console)
            return 0
        asked.refuse_of_rigid(scene)
        if scene.is_free:
            from reports.requests.solve_free import run_solve_free  # slow to import

            run_solve_free(scene, self, console)
            return 0
        _check_driven(scene, self)
        along = [_along(scene, text) for text in self.along]
        structure = analyse(scene)
        motion = _over(scene, self) if not self.at_place else _at(scene, self)
        if self.forces:
            motion = with_forces(scene, motion, by_law=not self.at_place)
        if self.output is not None or self.figures is not None:
            tell_written(console, scene, motion, self)
            return 0
        speeds = speed_facts(scene, along, clockwise=self.clockwise)
        show_heading(console, scene, structure, along, speeds)
        _show(console, scene, motion, self)
        show_notes(console, scene, motion)
        return 0


def _check_driven(scene: Scene, request: SolveOptions) -> None:
    """Refuse what can not be asked of a scene that is driven. Raises CrankcheckError."""
    refuse_times(scene, request)
    if request.at_place and (request.turns or request.steps_per_turn):
        raise CrankcheckError(
            f"{request.at_place} with --turns or --steps-per-turn: one is a single "
            "position, the others a motion; give one of them"
        )
    if request.clockwise and not request.at_place:
        raise CrankcheckError("--clockwise: it is of one position; give --at-deg, such as 90")
    check_figures(request)
    check_page(request)


def _show(console: Console, scene: Scene, motion: Motion, request: SolveOptions) -> None:
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
    say(console, "Points, and more digits: -o out.csv, .parquet or .xlsx", "dim")


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


def _at(scene: Scene, request: SolveOptions) -> Motion:
    """The mechanism with its driver at a place, moving as its law moves it there."""
    theta, omega, alpha = driver_at(
        scene, request.at_deg, request.at_m, clockwise=request.clockwise
    )
    return kinematics.solve_driven(scene, np.array([theta]), np.array([omega]), np.array([alpha]))


def _over(scene: Scene, request: SolveOptions) -> Motion:
    """The motion over whole turns, the last sample included."""
    return kinematics.solve(scene, instants_of(scene, request))
