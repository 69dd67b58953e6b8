"""Scenes whose driver follows a law, with rigid links."""

import math
from collections.abc import Collection, Mapping, Sequence, Set
from typing import Any, NoReturn

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, Motion, State
from models.scene import Same, Scene
from models.scene.laws import MOST_TURNS
from reports.compare.compare import Truth, truth_of
from reports.compare.errors import DRIVEN
from reports.plan import singular
from reports.plan.steps import TURNS, counted
from reports.protocol.length import GivenAs, Length, Planned
from reports.protocol.way import ResultKind, StudyLengths, Way
from reports.quantities import MOVES, named
from reports.quantities.limits import DEFAULTS
from reports.quantities.quantity import Role, Tolerance
from sim.engine import Drive


class DrivenWay(Way):
    """The way of driven scenes with rigid links."""

    name = "driven"
    drive: Drive = "prescribed"
    kinds: Sequence[str] = ("driven",)
    closed_form = True
    limits: Mapping[str, Tolerance] = DEFAULTS
    roles: Set[Role] = frozenset(MOVES)
    placed: Sequence[str] = named("place")
    unlogged: Sequence[str] = ()
    noted = False
    no_case = "no driven case"
    units = DRIVEN.compared_with(" at the commanded time")
    over_g: Sequence[str] = ()
    results = ResultKind(
        error="An error is the largest of a whole run, compared with the closed form: the worst "
        "of all link angles, in radians, and of all places of sliders and points, over the "
        "longest link.",
        stands=0,
        leads=1,
        axis="largest error: angle [rad], place / L [-]",
        promise="place (rad, or of the longest link)",
    )

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return True

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        turns = TURNS if length.turns is None else length.turns
        step = length.dt_s, length.steps_per_turn
        return counted(scene, *step, turns, every=length.every, least=length.least)

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        return [Length(None, each, study.turns) for each in study.steps_per_turn]

    def refuse(self, run: Planned) -> None:
        singular.refuse_singular(run.scene, run.duration_s)
        if run.with_forces:
            singular.refuse_forceless(run.scene, run.duration_s)
        singular.refuse_short_tables(run.scene, run.duration_s)

    def stored(self, row: Mapping[Any, Any]) -> bool:
        return True

    def note(self, scene: Scene, duration_s: float) -> str:
        return singular.passage_note(scene, duration_s)

    def truth(self, run: Planned) -> Truth:
        return truth_of(Same(run.scene))

    drives: tuple[Drive, ...] = ("prescribed", "servo", "free")
    lengths_by: tuple[str, ...] = ("--turns", "--steps-per-turn")
    over = "over one turn"
    targets: Collection[str] = DEFAULTS
    least_judged = 0

    def refuse_length(self, option: str) -> NoReturn:
        raise CrankcheckError(
            f"{option}: this option is for free motion; add --free, or leave {option} out"
        )

    def released(self, scene: Scene) -> Scene:
        return scene

    def opened(self, scene: Scene) -> tuple[Scene, State]:
        return scene, solve(scene, np.zeros(1)).state()

    def launch(self, run: Planned) -> Truth | None:
        return self.truth(run)

    def refuse_made(self, run: Planned) -> None:
        """Do nothing: such a run was refused before it was run."""

    def motion(self, scene: Scene, time_s: Array) -> Motion:
        return solve(scene, time_s, bound=False)

    def drawn_forces(self, scene: Scene, time_s: Array) -> Forces:
        from reports.drawing.shape import clear_of_locking  # for drawings alone

        return clear_of_locking(forces(scene, time_s, bound=False, skip_dead_points=True))

    def drawn_s(self, most_s: float) -> float:
        return math.inf

    def latest_s(self, scene: Scene) -> float:
        return MOST_TURNS * self.turn_s(scene)


WAY = DrivenWay()
