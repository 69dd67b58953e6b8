"""The log of a mechanism whose links bend: what it is held to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from models.controlled import Controlled
from models.errors import CrankcheckError
from models.released import Released
from reports.logs.channel import OwnLog
from reports.way.length import Springs

if TYPE_CHECKING:
    from reports.compare.elastic.elastic_truth import ElasticTruth

NO_CAUSE = "causes are not looked for where links bend"


def bent_truth(log: OwnLog, segments: int, springs: Springs, drive: str) -> ElasticTruth:
    """The truth of a log of so many segments.

    Raises
    ------
    CrankcheckError
        A scene that is let go; another drive than that of the scene; times before 0, where its
        links do not come back after a period.
    """
    from reports.compare.elastic.elastic_truth import elastic_truth  # where links bend alone

    name, law = log.scene.name, log.scene.driver.law
    if isinstance(law, Released | Controlled):
        raise CrankcheckError(
            f"{name}: {', '.join(log.scene.elastic)} bends, and logs of elastic links that are let "
            "go are not judged yet; `crankcheck verify` runs engines on them"
        )
    if drive != "scene":
        raise CrankcheckError(
            f"--drive {drive}: {name} has elastic links, and how these bend goes by the speed of "
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
