"""`solve` of a scene with elastic links: their bending, beside rigid links."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Console

from analytic.elastic.elastic_motion import ElasticHistory, sampled
from analytic.result import Selection
from analytic.structure.mobility import analyse
from models.array import Array, samples
from models.errors import CrankcheckError, StructureError
from models.motion import Motion
from models.scene import Scene
from reports.describe import elastic_course
from reports.describe.elastic_words import beam_certainty, elastic_facts, elastic_warnings, start_words
from reports.describe.facts import describe_law
from reports.describe.force_tables import motion_force_tables
from reports.describe.motion_tables import cleaned
from reports.output.console import say
from reports.requests.arguments import is_true
from reports.requests.free_solution import LetGo, of_bodies
from reports.requests.options import SolveOptions, given
from reports.requests.solution import ROWS, Solution, drawn, heading, thinned
from reports.requests.solving import Asked, ElasticChoice, Solving, refuse_samples, refuse_times

if TYPE_CHECKING:
    import pandas as pd

    from reports.figures.style import FigureSet


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ElasticSolution(Solution):
    """The motion of a scene with elastic links.

    As `Solution`, with ``elastic``: deflection of each elastic link at its middle, and extension
    [m]. Its bound is None: `certainty` says how far it is to be trusted. ``vibration`` is the whole
    motion (`analytic.elastic.elastic_motion.DrivenElasticMotion`, or `ReleasedElasticMotion`).
    """

    vibration: ElasticHistory

    @cached_property
    def rigid(self) -> Motion:
        """The same scene with rigid links, at the same instants."""
        return self._course(self.time_s).rigid

    @cached_property
    def certainty(self) -> list[str]:
        """Possible errors of the motion, in sentences."""
        return beam_certainty(self.vibration)

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
        fine = self._course(elastic_course.closely_sampled(self.scene, self.vibration.until_s))
        shown, forces = self._course(time_s), self.forces is not None
        _show(console, self.vibration, shown, fine, self.certainty, forces=forces)

    def _course(self, time_s: Array) -> elastic_course.ElasticCourse:
        return elastic_course.elastic_course(self.vibration, time_s)

    def _drawn(self) -> str:
        return drawn(self.scene)


def elastic_solution(
    scene: Scene, time_s: Array, wanted: Selection, choice: ElasticChoice, *, forces: bool
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
    whole = sampled(vibration, time_s)
    motion = replace(
        of_bodies(whole, wanted),
        elastic={name: x for name, x in whole.elastic.items() if name in wanted.links},
        forces=whole.forces if forces else None,
    )
    return ElasticSolution(**vars(motion), scene=scene, vibration=vibration)


def _show(
    console: Console,
    motion: ElasticHistory,
    shown: elastic_course.ElasticCourse,
    fine: elastic_course.ElasticCourse,
    certainty: Sequence[str],
    *,
    forces: bool,
) -> None:
    """Print the mechanism, the samples that are ``shown``, and the largest values of a motion
    closely sampled, ``fine``."""
    scene = motion.scene
    facts = elastic_facts(scene, motion.by, stiffened=motion.stiffened)
    say(console, _heading(scene) + "\n".join(facts) + "\n")
    for table in elastic_course.elastic_tables(shown, console.width):
        console.print(table, "")
    if forces and shown.motion.forces is not None:
        acting = shown.motion.forces
        for table in motion_force_tables(scene, cleaned(shown.motion), acting, console.width):
            console.print(table, "")
    console.print(elastic_course.extremes_table(scene, elastic_course.extremes(fine)), "")
    for line in (start_words(scene, elastic_course.start_of(motion)), *certainty):
        say(console, line)
    for line in elastic_warnings(scene, elastic_course.largest_deflections(fine)):
        say(console, line, "yellow")


def _heading(scene: Scene) -> str:
    """Heading of the mechanism; with more freedoms than one, or without dyads, its start alone."""
    try:
        return heading(scene, analyse(scene))
    except StructureError:
        return f"{scene.name}: {scene.source}\ndriver {scene.driver.link}, {describe_law(scene)}\n"


class ElasticSolving(Solving):
    """Solving of scenes whose driver follows a law, with links that bend."""

    of_links = " with elastic links"

    def solution(self, scene: Scene, asked: Asked) -> ElasticSolution:
        forces, wanted = is_true(asked.forces, "forces"), Selection.of(scene, *asked.wanted)
        time_s = samples(asked.time_s, "time_s")
        return elastic_solution(scene, time_s, wanted, asked.choice, forces=forces)

    def refuse(self, scene: Scene, request: SolveOptions) -> None:
        refuse_times(scene, request)
        for option in given(request, "at_deg", "at_m", "clockwise", "along"):
            raise CrankcheckError(
                f"{option}: {scene.name} has elastic links ({', '.join(scene.elastic)}), whose "
                f"places depend on how they came there; leave {option} out, and give --turns and "
                "--steps-per-turn"
            )
        refuse_samples(request)

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

    def solution(self, scene: Scene, asked: Asked) -> ElasticSolution:
        self.refuse_forces(scene, asked)
        return super().solution(scene, asked)
