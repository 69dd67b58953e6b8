"""`solve`: the closed form alone, at one place of the driver or over time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Console

from analytic import kinematics
from analytic.mechanism.cycle import Along
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError, suggestion
from models.files.reading import find_scene, load_scene
from models.motion import Motion
from models.scene import Scene, laws
from reports.describe.facts import MOST_DEG, driver_at
from reports.describe.with_forces import with_forces
from reports.figures.layout import laid_out
from reports.output.formats import ENDINGS
from reports.output.write import check_file
from reports.requests import solving
from reports.requests.arguments import SceneLike, is_true, scene_of, told_at_the_call
from reports.requests.options import FAMILY, LIVE_SHEET, SolveOptions, given, named
from reports.requests.solution import Solution, show_solution

if TYPE_CHECKING:
    from reports.figures.force_turn import ForceTurn
    from reports.figures.style import FigureSet

SAMPLES = 361
"""Instants of a period, both ends included, by default: as in a file of the command."""


@told_at_the_call
def solve(
    scene: SceneLike,
    time_s: ArrayLike | None = None,
    *,
    links: solving.Names = None,
    points: solving.Names = None,
    sliders: solving.Names = None,
    bound: bool = True,
    forces: bool = False,
    modes: int | None = None,
    axial_modes: int | None = None,
    elements: int | None = None,
    shape: str | None = None,
    linear: bool = False,
) -> Solution:
    """Solve the motion of a scene at some times, in closed form; free motion is integrated
    (`FreeSolution`); elastic links bend (`ElasticSolution`).

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    time_s : ArrayLike or None
        Times [s], shape (T,), in any order; 361 over a period of the driver for None.
    links, points, sliders : str, Iterable[str] or None
        Bodies to return, by one name or several; None is all, () is none.
    bound : bool
        Carry error bounds (about three times the work).
    forces : bool
        Solve the reactions and the driving torque as well; NaN in dead points of the driver. Free
        motion has no driving torque: it is 0, and in no table.
    modes, axial_modes, elements : int or None
        Of elastic links: sines across and along each, or beam elements.
    shape : str or None
        Start of elastic links: ``periodic``, ``quasi-static`` or ``straight``; None: the scene's
        own.
    linear : bool
        Leave out that a bent link is shorter.

    Raises
    ------
    CrankcheckError
        An invalid scene, time or name; a StructureError for a mechanism without a closed form, a
        ReachError for a driver angle that it can not be assembled in. Of forces: a scene without
        mass and load, no instant outside of dead points, or free motion with redundant links.
    """
    scene = scene_of(scene)
    choice = solving.ElasticChoice(modes, axial_modes, elements, shape, linear)
    if time_s is None:
        time_s = np.linspace(0.0, scene.driver.law.period_s, SAMPLES)
    asked = solving.Asked(time_s, (links, points, sliders), choice, bound, forces)
    return solving.solving_of(scene).solution(scene, asked)


def _refuse_far(scene: Scene, motion: Motion) -> None:
    far_s = float(np.max(np.abs(motion.time_s), initial=0.0))
    turns = far_s / scene.driver.law.period_s
    if turns > laws.MOST_TURNS:
        raise CrankcheckError(
            f"time_s: t = {far_s:.6g} s is {turns:.3g} turns of {scene.name}; beyond "
            f"{laws.MOST_TURNS:g} the rounding of a turn is too large; give times in seconds"
        )


@told_at_the_call
def solve_driven(
    scene: SceneLike,
    theta: ArrayLike,
    omega: ArrayLike,
    alpha: ArrayLike,
    time_s: ArrayLike | None = None,
    *,
    links: solving.Names = None,
    points: solving.Names = None,
    sliders: solving.Names = None,
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
        As in `solve`; forces need the whole motion.

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
    return _with_forces(scene, motion, forces=forces, by_law=False, bound=bound)


@dataclass(frozen=True)
class SolveRequest(SolveOptions):
    @laid_out
    def run(self, console: Console, progress: Console) -> int:
        """Show or write the reference. Raises CrankcheckError for a faulty request."""
        endings = (*ENDINGS, solving.PAGE) if self.family is None else solving.FAMILY_ENDINGS
        check_file(self.output, "-o", endings, inputs=[find_scene(self.scene)])
        scene = load_scene(self.scene)
        if self.family is not None:
            named(FAMILY)(scene, self, console)
        else:
            solving.solving_of(scene).run(scene, self, solving.elastic_choice(self), console)
        return 0


class DrivenSolving(solving.Solving):
    """Solving of driven scenes with rigid links: in closed form, also at one place."""

    def solution(self, scene: Scene, asked: solving.Asked) -> Solution:
        asked.choice.refuse_of_rigid(scene)
        names = dict(zip(("links", "points", "sliders"), asked.wanted, strict=True))
        # Whatever the times are, they are looked at there.
        times, bound = cast(Array, asked.time_s), is_true(asked.bound, "bound")
        motion = kinematics.solve(scene, times, **names, bound=bound)
        _refuse_far(scene, motion)
        return _with_forces(scene, motion, forces=asked.forces, bound=bound)

    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        solving.elastic_choice(request).refuse_of_rigid(scene)
        solving.refuse_times(scene, request)
        place, is_drawn = request.at_place, request.figures is not None
        if place and (request.turns or request.steps_per_turn):
            raise CrankcheckError(
                f"{place} with --turns or --steps-per-turn: a single position, and a motion; give "
                "one of them"
            )
        if request.clockwise and not place:
            raise CrankcheckError("--clockwise: for one position; give --at-deg, such as 90")
        if is_drawn and not request.forces:
            raise CrankcheckError("--figures: draws forces over a turn; give --forces as well")
        if is_drawn and place:
            why = "they belong to a turn; leave one of them out"
            raise CrankcheckError(f"--figures with {place}: {why}")
        whole = [*given(request, "at_deg", "at_m", "turns", "steps_per_turn")]
        if solving.is_page(request) and whole:
            raise CrankcheckError(
                f"-o {request.output}: a page shows a turn; leave out --at-deg, --at-m, --turns "
                "and --steps-per-turn"
            )

    def answer(
        self, scene: Scene, request: SolveOptions, choice: solving.ElasticChoice
    ) -> Solution:
        for text in request.along:
            _along(scene, text)
        analyse(scene)  # which refuses whatever is no mechanism
        if by_law := not request.at_place:
            motion = kinematics.solve(scene, solving.instants_of(scene, request))
        else:  # moving as the law of the driver moves it there
            state = driver_at(scene, request.at_deg, request.at_m, clockwise=request.clockwise)
            motion = kinematics.solve_driven(scene, *(np.array([each]) for each in state))
        return _with_forces(scene, motion, forces=request.forces, by_law=by_law)

    def show(self, console: Console, solution: Solution, request: SolveOptions) -> None:
        along = [_along(solution.scene, text) for text in request.along]
        few = None if request.at_place else solution
        more = "" if request.at_place else "Points, and more digits: -o out.csv, .parquet or .xlsx"
        show_solution(console, solution, few, more=more, along=along, clockwise=request.clockwise)

    def figures(self) -> FigureSet[Any]:
        from reports.figures.force_figures import FORCE_FIGURES

        return FORCE_FIGURES

    def course(self, solution: Solution) -> ForceTurn:
        from reports.figures.force_turn import force_turn

        return force_turn(solution.scene)

    def page(self, solution: Solution) -> tuple[str, str]:
        from reports.page.scene_page import scene_page

        scene, acting = solution.scene, solution.forces is not None
        pictures = self.figures().pictures(self.course(solution)) if acting else None
        return scene_page(scene, pictures), f"{scene.name} over one turn"

    def more(
        self, solution: Solution, columns: list[str], request: SolveOptions
    ) -> solving.WorkbookExtras:
        if request.at_place:
            return "", None
        extras: solving.WorkbookExtras = named(LIVE_SHEET)(solution.scene, solution.time_s, columns)
        return extras


def _with_forces(
    scene: Scene, motion: Motion, *, forces: bool, by_law: bool = True, bound: bool = True
) -> Solution:
    if is_true(forces, "forces"):
        motion = with_forces(scene, motion, by_law=by_law, bound=bound)
    return Solution(**vars(motion), scene=scene)


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
