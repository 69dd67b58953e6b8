"""`solve` of free motion: integrated, with the bound of its error."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from rich.console import Console

from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from analytic.result import Selection
from analytic.structure.mobility import analyse
from models.array import Array, samples
from models.errors import CrankcheckError
from models.motion import Bound, Motion
from models.scene import Scene
from reports.describe.facts import describe_law
from reports.describe.free_motion import free_columns, free_notes, free_tables
from reports.describe.motion_tables import cleaned, motion_tables
from reports.output.console import say
from reports.plan.singular import continued_note
from reports.requests.arguments import is_true
from reports.requests.options import SolveOptions, given
from reports.requests.solution import ROWS, Solution, heading, thinned
from reports.requests.solving import ON_SCREEN, Asked, Solving, most_samples, refuse_samples

if TYPE_CHECKING:
    import pandas as pd

    from reports.figures.free_figures import FreeCourse
    from reports.figures.style import FigureSet

LONG_FILE = 1000
"""Samples in a file."""
Bodies = TypeVar("Bodies", Motion, Bound)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class FreeSolution(Solution):
    """The free motion of a scene, with a bound of its own error at every sample.

    As `Solution`; ``free`` is the whole motion, dense (`analytic.free.free_motion.FreeMotion`).
    """

    free: FreeMotion

    @property
    def sensitivity(self) -> Array:
        """Growth of a small change of the start by each sample, (T,)."""
        return self.free.sensitivity(self.time_s)

    @property
    def error_rad(self) -> Array:
        """Bound of the error of the driver's angle at each sample [rad], (T,)."""
        return self.free.error_rad(self.time_s)

    def frame(self) -> pd.DataFrame:
        """Table of `Solution`, with the energies, the sensitivity and the error beside."""
        return super().frame().assign(**free_columns(self.free, self.time_s))

    def show(self, console: Console) -> None:
        few = thinned(self, ROWS)
        show_free(console, self.free, few)
        if left := self._left_out(few):
            say(console, left, "dim")


def free_solution(scene: Scene, time_s: Array, wanted: Selection, *, bound: bool) -> FreeSolution:
    """The free motion of a scene at times [s] from 0 on; the bodies of ``wanted`` alone. Raises
    CrankcheckError for times before the start, and as `analytic.free.release.release`."""
    law = scene.driver.law
    free = release(scene, float(np.max(time_s)) if np.max(time_s) > 0.0 else law.period_s)
    motion = of_bodies(free.at(time_s, bound=bound), wanted)
    if motion.bound is not None:
        motion = replace(motion, bound=of_bodies(motion.bound, wanted))
    return FreeSolution(**vars(motion), scene=scene, free=free)


def of_bodies(of: Bodies, wanted: Selection) -> Bodies:
    """The wanted links, points and sliders."""
    return replace(
        of,
        links={name: of.links[name] for name in wanted.links},
        points={name: of.points[name] for name in wanted.points},
        sliders={name: of.sliders[name] for name in wanted.sliders},
    )


def show_free(console: Console, whole: FreeMotion, motion: Motion) -> None:
    """Print the mechanism, every sample of its motion, and the notes."""
    scene = whole.scene
    if whole.by_dyads:
        say(console, heading(scene, analyse(scene)))
    else:
        say(
            console,
            f"{scene.name}: {scene.source}\nmobility {whole.freedoms}; driver {scene.driver.link}, "
            f"{describe_law(scene)}; by the equations of motion of all bodies\n",
        )
    shown = cleaned(motion)
    tables = motion_tables(scene, shown, console.width)
    if scene.driver.link in motion.links:
        tables = [*free_tables(whole, shown, console.width), *tables]
    for table in tables:
        console.print(table, "")
    notes = [*free_notes(whole, float(np.max(motion.time_s))), continued_note(scene, motion)]
    for note in filter(None, notes):
        say(console, note, "yellow")


class LetGo(Solving):
    """Solving of free motion, with rigid links or elastic ones."""

    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        of_driver = "at_deg at_m turns steps_per_turn clockwise along forces"
        for option in given(request, *of_driver.split()):
            raise CrankcheckError(
                f"{option}: {scene.name} is let go, and moves over time as masses and forces have "
                f"it; leave {option} out, and give --duration and --steps"
            )
        refuse_samples(request)

    def instants(self, scene: Scene, request: SolveOptions) -> Array:
        """Times from 0 to the end, both included [s]. Raises CrankcheckError."""
        until_s = scene.driver.law.period_s if request.duration is None else request.duration
        if not (math.isfinite(until_s) and until_s > 0.0):
            raise CrankcheckError(f"--duration {until_s:g}: give seconds above 0")
        steps = request.steps
        if steps is None:
            steps = ON_SCREEN if request.output is None else LONG_FILE
        if steps < 1:
            raise CrankcheckError(f"--steps {steps}: give at least 1")
        most = most_samples(request)
        if steps >= most:
            raise CrankcheckError(f"--steps {steps}: {steps + 1:.7g} samples; at most {most}")
        return np.linspace(0.0, until_s, steps + 1)

    def refuse_forces(self, scene: Scene, asked: Asked) -> None:
        """Refuse forces, which need a driving torque. Raises CrankcheckError."""
        if is_true(asked.forces, "forces"):
            raise CrankcheckError(f"forces=True: {scene.name} is let go, and has no driving torque")


class FreeSolving(LetGo):
    """Solving of free motion, with rigid links."""

    def solution(self, scene: Scene, asked: Asked) -> FreeSolution:
        asked.choice.refuse_of_rigid(scene)
        self.refuse_forces(scene, asked)
        chosen = Selection.of(scene, *asked.wanted)
        instants = samples(asked.time_s, "time_s")
        return free_solution(scene, instants, chosen, bound=is_true(asked.bound, "bound"))

    def show(self, console: Console, solution: FreeSolution, request: SolveOptions) -> None:
        show_free(console, solution.free, solution)
        more = "Points, and more digits: -o out.csv, .parquet or .xlsx; figures: -o out.html"
        say(console, more, "dim")

    def figures(self) -> FigureSet[Any]:
        from reports.figures.free_figures import FREE_FIGURES

        return FREE_FIGURES

    def course(self, solution: FreeSolution) -> FreeCourse:
        from reports.figures.free_figures import free_course

        return free_course(solution.free)

    def page(self, solution: FreeSolution) -> tuple[str, str]:
        from reports.page.scene_page import free_page

        words = f"the free motion of {solution.scene.name} over {solution.time_s[-1]:g} s"
        pictures = self.figures().pictures(self.course(solution))
        return free_page(solution.free, pictures), words
