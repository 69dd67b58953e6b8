"""Logs of scenes whose links bend."""

from collections.abc import Sequence
from dataclasses import dataclass

from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.driver import Controlled, Released
from reports.causes.cause import Cause
from reports.compare.compare import Truth
from reports.compare.elastic_truth import ElasticBeside, ElasticTruth, elastic_truth
from reports.logs.channel import Channel, OwnLog
from reports.logs.log_beside import LogBeside
from reports.own_log.drives import DriveFit
from reports.own_log.log_limits import HeldLog, LogRequest
from reports.protocol.length import Springs
from reports.ways.driven.log import DrivenLog
from sim.engine import Run

NO_CAUSE = "causes are not searched for elastic links"


def bent_truth(log: OwnLog, segments: int, springs: Springs, drive: str) -> ElasticTruth:
    """The reference of a log of so many segments.

    Raises CrankcheckError for a scene in free motion; another drive than that of the scene; times
    before 0, where its links do not come back after a period.
    """
    name, law = log.scene.name, log.scene.driver.law
    if isinstance(law, Released | Controlled):
        raise CrankcheckError(
            f"{name}: {', '.join(log.scene.elastic)} is elastic, and logs of elastic links in free "
            "motion are not judged yet; `crankcheck verify` runs engines on them"
        )
    if drive != "scene":
        raise CrankcheckError(
            f"--drive {drive}: {name} has elastic links, whose deflection depends on the speed of "
            "the scene's own driver; leave --drive out"
        )
    instants = [log.time_s, *(each.instants for each in log.readings)]
    truth = elastic_truth(log.scene, segments, springs, max(float(each[-1]) for each in instants))
    first = min(float(each[0]) for each in instants)
    if first < 0.0 and not truth.theory.is_periodic:
        raise CrankcheckError(
            f"{log.source}: its rows begin at t = {first:.6g} s, and {name} starts at 0, "
            f"{truth.theory.shape}; count the time from there on, or start it periodic"
        )
    return truth


@dataclass(frozen=True)
class ElasticLogBeside(LogBeside, ElasticBeside):
    """A log whose elastic links had the number of segments that the user states."""

    @property
    def has_crank(self) -> bool:
        return False


class ElasticLog(DrivenLog):
    """Logs of driven scenes with elastic links."""

    truth_name = "beam"

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        return log, bent_truth(log, request.segments, request.springs, request.drive), None

    def beside(self, log: OwnLog, truth: Truth, run: Run) -> LogBeside:
        assert isinstance(truth, ElasticTruth)
        assert run.motion is not None
        return ElasticLogBeside(truth, run, run.motion, step_s=run.dt_s, elastic=truth)

    def judged_as(self, scene: Scene, channel: Channel) -> tuple[str, ...]:
        bent = channel.kind.quantity == "deflection"
        return ("deflection", "segments") if bent else super().judged_as(scene, channel)

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        return (), (NO_CAUSE,) if held.out else ()


LOG = ElasticLog()
