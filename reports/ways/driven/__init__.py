"""Scenes whose driver follows a law, with rigid links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from models.scene import Same, Scene
from reports.compare.beside import Truth, truth_of
from reports.plan.singular import (
    passage_note,
    refuse_forceless,
    refuse_short_tables,
    refuse_singular,
)
from reports.plan.steps import TURNS, counted
from reports.way.length import GivenAs, Length, Planned
from reports.way.way import StudyLengths
from sim.engine import Drive

if TYPE_CHECKING:
    from reports.own_log.log_kind import LogKind
    from reports.requests.solving import Solving
    from reports.verify.cell_table import CellTable


class DrivenWay:
    """As of `Way`."""

    name = "driven"
    drive: Drive = "prescribed"
    closed_form = True

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

    @property
    def log(self) -> LogKind:
        from reports.ways.driven.log import LOG  # for logs alone

        return LOG

    @property
    def table(self) -> CellTable:
        from reports.ways.driven.table import TABLE  # what is shown is loaded when it is

        return TABLE

    @property
    def solving(self) -> Solving:
        from reports.requests.solve import SOLVING  # for references alone

        return SOLVING

    def turn_s(self, scene: Scene) -> float:
        return scene.driver.law.period_s

    def every(self, steps: int, steps_per_turn: float) -> int:
        return 1

    def given(self, scene: Scene, given: GivenAs) -> Scene:
        return scene

    def note(self, scene: Scene, duration_s: float) -> str:
        return passage_note(scene, duration_s)

    def truth(self, run: Planned) -> Truth:
        return truth_of(Same(run.scene))


WAY = DrivenWay()
