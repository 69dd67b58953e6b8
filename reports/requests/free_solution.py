"""`solve` of free motion, with the bound of its error, and of elastic links, beside rigid ones."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from rich.console import Console

from analytic.elastic import elastic_motion, released
from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from analytic.free.solved_motion import OPEN
from analytic.result import Selection
from analytic.structure.mobility import analyse
from models.array import Array, samples
from models.errors import CrankcheckError, StructureError
from models.motion import Bound, Motion
from models.scene import Scene
from reports.describe import elastic_course, elastic_words, force_tables, free_motion, with_forces
from reports.describe.facts import describe_law
from reports.output.console import print_each, say, say_each
from reports.plan.singular import continued_note
from reports.requests import solving
from reports.requests.arguments import is_true
from reports.requests.options import SolveOptions, given
from reports.requests.solution import ROWS, Solution, drawn, heading, thinned

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
        return super().frame().assign(**free_motion.free_columns(self.free, self.time_s))

    def _drawn(self) -> str:
        return drawn(self.scene)

    def show(self, console: Console) -> None:
        acting = self.forces and with_forces.undriven_shown(self.forces)
        few = thinned(replace(self, forces=acting), ROWS)
        show_free(console, self.free, few)
        if left := self._left_out(few):
            say(console, left, "dim")


def free_solution(
    scene: Scene, time_s: Array, wanted: Selection, *, bound: bool, forces: bool = False
) -> FreeSolution:
    """The free motion of a scene at times [s] from 0 on; the bodies of ``wanted`` alone, with all
    reactions if requested. Raises CrankcheckError for times before the start, reactions that are
    open, and as `analytic.free.release.release`."""
    law = scene.driver.law
    free = release(scene, float(np.max(time_s)) if np.max(time_s) > 0.0 else law.period_s)
    motion = free.at(time_s, bound=bound)
    motion = of_bodies(
        with_forces.with_reactions(free, motion, bound=bound) if forces else motion, wanted
    )
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
    shown = free_motion.cleaned(motion)
    tables = free_motion.motion_tables(scene, shown, console.width)
    if scene.driver.link in motion.links:
        tables = [*free_motion.free_tables(whole, shown, console.width), *tables]
    notes = [
        *free_motion.free_notes(whole, float(np.max(motion.time_s))),
        continued_note(scene, motion),
    ]
    if motion.forces is not None:
        acting = with_forces.undriven_shown(motion.forces)
        tables += force_tables.motion_force_tables(scene, shown, acting, console.width)
        fine = with_forces.finely_loaded(whole)
        assert fine.forces is not None
        tables.append(force_tables.largest_table(scene, fine, fine.forces, "over the motion"))
        notes += [
            with_forces.force_certainty(scene, motion.forces),
            *with_forces.left_out_notes(scene, motion),
        ]
    print_each(console, tables)
    say_each(console, filter(None, notes), "yellow")


class LetGo(solving.Solving):
    """Solving of free motion, with rigid links or elastic ones."""

    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        of_driver = "at_deg at_m turns steps_per_turn clockwise along"
        for option in given(request, *of_driver.split()):
            raise CrankcheckError(
                f"{option}: {scene.name} is in free motion, over time; leave {option} out, and "
                "give --duration and --steps"
            )
        solving.refuse_samples(request)

    def instants(self, scene: Scene, request: SolveOptions) -> Array:
        """Times from 0 to the end, both included [s]. Raises CrankcheckError."""
        until_s = scene.driver.law.period_s if request.duration is None else request.duration
        if not (math.isfinite(until_s) and until_s > 0.0):
            raise CrankcheckError(f"--duration {until_s:g}: give seconds above 0")
        steps = request.steps
        if steps is None:
            steps = solving.ON_SCREEN if request.output is None else LONG_FILE
        if steps < 1:
            raise CrankcheckError(f"--steps {steps}: give at least 1")
        most = solving.most_samples(request)
        if steps >= most:
            raise CrankcheckError(f"--steps {steps}: {steps + 1:.7g} samples; at most {most}")
        return np.linspace(0.0, until_s, steps + 1)


class FreeSolving(LetGo):
    """Solving of free motion, with rigid links."""

    def solution(self, scene: Scene, asked: solving.Asked) -> FreeSolution:
        asked.choice.refuse_of_rigid(scene)
        chosen = Selection.of(scene, *asked.wanted)
        bound, forces = is_true(asked.bound, "bound"), is_true(asked.forces, "forces")
        instants = samples(asked.time_s, "time_s")
        return free_solution(scene, instants, chosen, bound=bound, forces=forces)

    def show(self, console: Console, solution: FreeSolution, request: SolveOptions) -> None:
        show_free(console, solution.free, solution)
        more = "Points, and more digits: -o out.csv, .parquet or .xlsx; figures: -o out.html"
        say(console, more, "dim")

    def figures(self) -> FigureSet[Any]:
        from reports.figures.free_figures import FREE_FIGURES

        return FREE_FIGURES

    def course(self, solution: FreeSolution) -> FreeCourse:
        from reports.figures.free_figures import free_course

        return free_course(solution.free, with_forces=solution.forces is not None)

    def page(self, solution: FreeSolution) -> tuple[str, str]:
        from reports.page.scene_page import free_page

        words = f"the free motion of {solution.scene.name} over {solution.time_s[-1]:g} s"
        pictures = self.figures().pictures(self.course(solution))
        return free_page(solution.free, pictures, acting=solution.forces is not None), words


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ElasticSolution(Solution):
    """The motion of a scene with elastic links.

    As `Solution`, with ``elastic``: deflection of each elastic link at its middle, and extension
    [m]. Its bound is None: `certainty` says how far it is to be trusted. ``vibration`` is the whole
    motion (`analytic.elastic.elastic_motion.DrivenElasticMotion`, or `ReleasedElasticMotion`).
    """

    vibration: elastic_motion.ElasticHistory

    @cached_property
    def rigid(self) -> Motion:
        """The same scene with rigid links, at the same instants."""
        return self._course(self.time_s).rigid

    @cached_property
    def certainty(self) -> list[str]:
        """Possible errors of the motion, in sentences."""
        return elastic_words.beam_certainty(self.vibration)

    def frame(self) -> pd.DataFrame:
        """Table of `Solution`, with ``coupler_deflection_m`` and ``coupler_extension_m`` of elastic
        links, rigid angles, ``rocker_theta_rigid_rad``, and the energies of free motion."""
        rigid = self.rigid if self.forces is not None else replace(self.rigid, forces=None)
        energy = elastic_course.energy_columns(self.vibration, self.time_s)
        return super().frame().assign(**elastic_course.rigid_columns(rigid), **energy)

    def show(self, console: Console) -> None:
        few = thinned(self, ROWS)
        self.show_at(console, np.sort(few.time_s))
        if left := self._left_out(few):
            say(console, left, "dim")

    def show_at(self, console: Console, time_s: Array) -> None:
        """Print it at times [s], in ascending order."""
        motion, scene = self.vibration, self.scene
        fine = self._course(elastic_course.closely_sampled(scene, motion.until_s))
        shown = self._course(time_s)
        facts = elastic_words.elastic_facts(scene, motion.by, stiffened=motion.stiffened)
        say(console, _heading(scene) + "\n".join(facts) + "\n")
        tables = elastic_course.elastic_tables(shown, console.width)
        acting = None if self.forces is None else shown.motion.forces
        if acting is not None:
            if scene.is_free:
                acting = with_forces.undriven_shown(with_forces.undriven(scene, acting))
            own = free_motion.cleaned(shown.motion)
            tables += force_tables.motion_force_tables(scene, own, acting, console.width)
        extremes = elastic_course.extremes_table(scene, elastic_course.extremes(fine))
        print_each(console, [*tables, extremes])
        start = elastic_words.start_words(scene, elastic_course.start_of(motion))
        say_each(console, (start, *self.certainty), "")
        largest = elastic_course.largest_deflections(fine)
        say_each(console, elastic_words.elastic_warnings(scene, largest), "yellow")

    def _course(self, time_s: Array) -> elastic_course.ElasticCourse:
        return elastic_course.elastic_course(self.vibration, time_s)

    def _drawn(self) -> str:
        return drawn(self.scene)


def elastic_solution(
    scene: Scene, time_s: Array, wanted: Selection, choice: solving.ElasticChoice, *, forces: bool
) -> ElasticSolution:
    """The motion of a scene with elastic links at times [s] from 0 on; ``wanted`` bodies alone.

    Raises CrankcheckError for times before the start, choices that `ElasticChoice` refuses, motions
    that are not found.
    """
    until_s = max(float(np.max(time_s)), 0.0) or scene.driver.law.period_s
    vibration = choice.motion(scene, until_s)
    if float(np.min(time_s)) < 0.0 and elastic_course.start_of(vibration) != "periodic":
        raise CrankcheckError(
            f"time_s: t = {float(np.min(time_s)):g} s, and {scene.name} starts at 0, "
            f"{elastic_course.start_of(vibration)}; give times from there on, or --shape periodic"
        )
    whole = elastic_motion.sampled(vibration, time_s)
    acting = whole.forces
    if forces and acting is not None and isinstance(vibration, released.ReleasedElasticMotion):
        redundant = vibration.dynamics.redundant
        acting = replace(acting, undetermined=OPEN) if redundant else acting
        acting = with_forces.undriven(scene, acting) if scene.is_free else acting
    motion = replace(
        of_bodies(whole, wanted),
        elastic={name: x for name, x in whole.elastic.items() if name in wanted.links},
        forces=acting if forces else None,
    )
    return ElasticSolution(**vars(motion), scene=scene, vibration=vibration)


def _heading(scene: Scene) -> str:
    """Heading of the mechanism; with more freedoms than one, or without dyads, its start alone."""
    try:
        return heading(scene, analyse(scene))
    except StructureError:
        return f"{scene.name}: {scene.source}\ndriver {scene.driver.link}, {describe_law(scene)}\n"


class ElasticSolving(solving.Solving):
    """Solving of scenes whose driver follows a law, with links that bend."""

    of_links = " with elastic links"

    def solution(self, scene: Scene, asked: solving.Asked) -> ElasticSolution:
        forces, wanted = is_true(asked.forces, "forces"), Selection.of(scene, *asked.wanted)
        time_s = samples(asked.time_s, "time_s")
        return elastic_solution(scene, time_s, wanted, asked.choice, forces=forces)

    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        solving.refuse_times(scene, request)
        for option in given(request, "at_deg", "at_m", "clockwise", "along"):
            raise CrankcheckError(
                f"{option}: {scene.name} has elastic links ({', '.join(scene.elastic)}), whose "
                f"places depend on their history; leave {option} out, and give --turns and "
                "--steps-per-turn"
            )
        solving.refuse_samples(request)

    def show(self, console: Console, solution: ElasticSolution, request: SolveOptions) -> None:
        solution.show_at(console, solution.time_s)
        more = "Points, and more digits: -o out.csv, .parquet or .xlsx; moving: -o out.html"
        say(console, more, "dim")

    def figures(self) -> FigureSet[Any]:
        from reports.figures.elastic_figures import ELASTIC_FIGURES

        return ELASTIC_FIGURES

    def course(self, solution: ElasticSolution) -> elastic_course.ElasticCourse:
        motion = solution.vibration
        return elastic_course.drawn_course(
            motion, elastic_course.closely_sampled(motion.scene, motion.until_s)
        )

    def page(self, solution: ElasticSolution) -> tuple[str, str]:
        from reports.page.scene_page import elastic_page

        motion, course = solution.vibration, self.course(solution)
        words = f"{motion.scene.name}{self.of_links} over {motion.until_s:.6g} s"
        return elastic_page(motion, course, self.figures().pictures(course)), words


class ReleasedElasticSolving(LetGo, ElasticSolving):
    """Solving of free motion, with links that bend."""
