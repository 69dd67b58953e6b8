"""Scenes whose driver follows a law, with rigid links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Any

from models.scene import Same, Scene
from reports.compare.beside import Truth, truth_of
from reports.compare.errors import DRIVEN
from reports.plan.forces import refuse_forceless
from reports.plan.short_tables import refuse_short_tables
from reports.plan.singular import passage_note, refuse_singular
from reports.plan.steps import TURNS, counted
from reports.quantities import DEFAULTS, named
from reports.quantities.quantity import Role, Tolerance
from reports.way.length import GivenAs, Length, Planned
from reports.way.way import Parts, StudyLengths
from sim.engine import Drive


class DrivenWay(Parts):
    """As of `Way`."""

    name = "driven"
    drive: Drive = "prescribed"
    kinds: Sequence[str] = ("driven",)
    closed_form = True
    limits: Mapping[str, Tolerance] = DEFAULTS
    roles: Set[Role] = frozenset(("drive", "place", "closure", "derived"))
    placed: Sequence[str] = named("place")
    unlogged: Sequence[str] = ()
    noted = False
    no_case = "no driven case"
    units = DRIVEN.compared_with(" at the commanded time")
    over_g: Sequence[str] = ()

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return True

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        turns = TURNS if length.turns is None else length.turns
        step = length.dt_s, length.steps_per_turn
        return counted(scene, *step, turns, every=length.every, least=length.least)

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        return [Length(None, each, study.turns) for each in study.steps_per_turn]

    def refuse(self, run: Planned) -> None:
        refuse_singular(run.scene, run.duration_s)
        if run.with_forces:
            refuse_forceless(run.scene, run.duration_s)
        refuse_short_tables(run.scene, run.duration_s)

    def roles_of(self, *, with_forces: bool) -> Set[Role]:
        return {*self.roles, *(("force",) if with_forces else ())}

    def stored(self, row: Mapping[Any, Any]) -> bool:
        return True

    def turn_s(self, scene: Scene) -> float:
        return scene.driver.law.period_s

    def every(self, steps: int, steps_per_turn: float) -> int:
        return 1

    def given(self, scene: Scene, given: GivenAs) -> Scene:
        return scene

    def moved(self, scene: Scene) -> Scene:
        return scene

    def note(self, scene: Scene, duration_s: float) -> str:
        return passage_note(scene, duration_s)

    def truth(self, run: Planned) -> Truth:
        return truth_of(Same(run.scene))


WAY = DrivenWay()
