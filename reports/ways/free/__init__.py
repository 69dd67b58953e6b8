"""Scenes in free motion, with rigid links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from models.scene import Scene
from reports.compare.beside import Truth
from reports.plan.free import refuse_unreleased
from reports.plan.steps import counted_free
from reports.way.length import GivenAs, Length, Planned
from reports.way.way import StudyLengths
from sim.engine import Drive

if TYPE_CHECKING:
    from reports.own_log.log_kind import LogKind
    from reports.requests.solving import Solving
    from reports.verify.cell_table import CellTable


class FreeWay:
    """As of `Way`."""

    name = "free"
    drive: Drive = "free"
    closed_form = False

    def takes(self, scene: Scene, drive: Drive) -> bool:
        return drive == "free"

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        return counted_free(
            scene, length.dt_s, length.duration_s, every=length.every, least=length.least
        )

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        return [Length(each, duration_s=study.duration_s) for each in study.dt_s]

    def refuse(self, run: Planned) -> None:
        refuse_unreleased(run.scene, run.duration_s)

    @property
    def log(self) -> LogKind:
        from reports.ways.free.log import LOG  # for logs alone

        return LOG

    @property
    def table(self) -> CellTable:
        from reports.ways.free.table import TABLE  # what is shown is loaded when it is

        return TABLE

    @property
    def solving(self) -> Solving:
        from reports.requests.free_solution import SOLVING  # for references alone

        return SOLVING

    def turn_s(self, scene: Scene) -> float:
        return 1.0

    def every(self, steps: int, steps_per_turn: float) -> int:
        return 1

    def given(self, scene: Scene, given: GivenAs) -> Scene:
        return scene

    def note(self, scene: Scene, duration_s: float) -> str:
        return ""

    def truth(self, run: Planned) -> Truth:
        from reports.compare.free.free_truth import free_truth  # slow to import

        return free_truth(run.scene, run.steps, run.dt_s, run.tolerance)


WAY = FreeWay()
