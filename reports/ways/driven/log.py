"""Logs of scenes whose driver follows a law."""

from __future__ import annotations

from collections.abc import Sequence

from models.scene import Scene
from reports.causes.cause import Case, Cause
from reports.causes.find import causes
from reports.compare.beside import Truth
from reports.logs.channel import Channel, OwnLog
from reports.logs.log_beside import AtCrank, LogBeside
from reports.own_log.drives import DriveFit, truth_of_log
from reports.own_log.log_kind import HeldLog, LogRequest
from reports.own_log.log_limits import limits_by_column
from reports.own_log.no_cause import of_no_cause, seldom
from sim.engine import Run

NO_FIT = (
    "no speed and start of the driver were found that explain the places: errors are those beside "
    "the nearest that was tried; log the driver's angle, or use --drive scene"
)


class DrivenLog:
    """As of `LogKind`."""

    truth_name = "closed form"
    no_cause = "none that is known explains {}"
    driver_angle = "drive"

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        return log, *truth_of_log(log, request.drive)

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        assert run.motion is not None
        alone = isinstance(truth, AtCrank)
        return LogBeside(truth, run, run.motion, step_s=run.dt_s, geometry_alone=alone)

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        of_driver = (channel.kind.name, channel.of) == ("angle", scene.driver.link)
        return ("drive",) if scene.driver.is_crank and of_driver else (channel.kind.quantity,)

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        if held.fit is not None and not held.fit.explains:
            return (), (NO_FIT,)
        case = Case(held.log, held.truth, limits_by_column(held.log, held.evidence, held.errors))
        found = causes(case)
        return found, (*seldom(case), *of_no_cause(case, found, held.errors))


LOG = DrivenLog()
