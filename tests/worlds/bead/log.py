"""Logs of beads."""

from collections.abc import Sequence
from dataclasses import dataclass

from models.scene import Scene
from reports.causes.cause import Cause
from reports.compare.compare import Truth
from reports.logs.channel import Channel, OwnLog
from reports.logs.log_beside import LogBeside
from reports.own_log.drives import DriveFit
from reports.own_log.log_limits import HeldLog, LogRequest
from sim.engine import Run
from tests.worlds.bead.truth import BeadBeside, BeadTruth


@dataclass(frozen=True)
class BeadLogBeside(LogBeside, BeadBeside):
    """A log of a bead beside the swing."""


class BeadLog:
    """As of `LogKind`."""

    truth_name = "swing"
    no_cause = "of {}: a bead has one way to be off, which is not looked into"
    driver_angle = "phase"

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        return log, BeadTruth(log.scene), None

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        assert run.motion is not None
        return BeadLogBeside(truth, run, run.motion, step_s=run.dt_s)

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        turns = (channel.kind.name, channel.of) == ("angle", scene.driver.link)
        return ("phase", "angle") if turns else (channel.kind.quantity,)

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        return (), ()


LOG = BeadLog()
