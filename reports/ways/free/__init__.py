"""Scenes in free motion, with rigid links."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from analytic.free.loosened import loosened
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.forces import Forces
from models.motion import Motion, State
from models.released import LONGEST_S
from models.scene import Scene
from reports.compare.beside import Truth
from reports.compare.free.kept_motion import kept_motion, released_state
from reports.judge.tolerance import FREE
from reports.plan.free import refuse_unreleased, under_control
from reports.plan.steps import counted_free
from reports.way.length import LEAST_STEPS, GivenAs, Length, Planned
from reports.way.way import StudyLengths, Way
from sim.engine import Drive

if TYPE_CHECKING:
    from reports.own_log.log_kind import LogKind
    from reports.requests.solving import Solving
    from reports.verify.cell_table import CellTable


class FreeWay(Way):
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

    def note(self, scene: Scene, duration_s: float) -> str:
        return ""

    def truth(self, run: Planned) -> Truth:
        from reports.compare.free.free_truth import free_truth  # slow to import

        return free_truth(run.scene, run.steps, run.dt_s, run.tolerance)

    drives: tuple[Drive, ...] = ("free",)
    lengths_by: tuple[str, ...] = ("--duration",)
    over = "in free motion"
    tolerances: Collection[str] = FREE
    least_judged = LEAST_STEPS

    def refuse_length(self, option: str) -> NoReturn:
        raise CrankcheckError(
            f"{option}: what is let go has no turns; give --dt and --duration, in seconds"
        )

    def step(self, scene: Scene, dt_s: float) -> str:
        return f"dt {dt_s:g} s"

    def long(self, scene: Scene, dt_s: float, steps: int) -> str:
        return f"{steps} steps, {steps * dt_s:.6g} s"

    def released(self, scene: Scene) -> Scene:
        return loosened(under_control(scene))

    def opened(self, scene: Scene) -> tuple[Scene, State]:
        try:
            return scene, solve(scene, np.zeros(1)).state()
        except CrankcheckError:
            return scene, released_state(scene)  # of several freedoms there is no closed form

    def launch(self, run: Planned) -> Truth | None:
        return None

    def refuse_made(self, run: Planned) -> None:
        refuse_unreleased(run.scene, run.duration_s)

    def motion(self, scene: Scene, time_s: Array) -> Motion:
        return kept_motion(scene, float(np.max(time_s))).at(time_s, bound=False)

    def drawn_forces(self, scene: Scene, time_s: Array) -> Forces:
        raise CrankcheckError(
            f"{scene.name}: let go, it is drawn without its forces; leave them out"
        )

    def drawn_s(self, most_s: float) -> float:
        return most_s

    def latest_s(self, scene: Scene) -> float:
        return LONGEST_S


WAY = FreeWay()
