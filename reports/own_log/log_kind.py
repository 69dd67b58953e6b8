"""What is particular to logs of a kind of scene: their truth, and what explains one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, cast

from models.scene import Scene
from reports.causes.cause import Cause
from reports.compare.beside import Truth
from reports.compare.errors import Errors
from reports.judge.rules.rule import Evidence
from reports.logs.channel import OwnLog
from reports.own_log.drives import DriveFit, LogDrive
from reports.way.length import SEGMENTS, Springs
from reports.way.way import way_of


@dataclass(frozen=True)
class LogRequest:
    """How a log is to be judged: pure numbers by quantity (`EVERY` for all others), or the step
    [s] that a budget follows from; what has to be in it; and what its elastic links were given
    as."""

    target: Mapping[str, float] = field(default_factory=dict)
    step_s: float = 0.0
    drive: LogDrive = "scene"
    require: Sequence[str] = ()
    segments: int = SEGMENTS
    springs: Springs = "plain"


@dataclass(frozen=True)
class HeldLog:
    """A log with the truth that it was compared with, and the drive that was fitted; ``out`` says
    that it is out of tolerance."""

    log: OwnLog
    truth: Truth
    fit: DriveFit | None
    evidence: Evidence
    errors: Errors
    out: bool


class LogKind(Protocol):
    """How logs of a kind of scene are judged."""

    truth_name: str
    no_cause: str
    """The sentence about columns, at {}, that are out of tolerance and have no cause."""
    driver_angle: str
    """The quantity that the angle of the driven link is judged as."""

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        """The log as far as its truth is known, the truth, and the drive that was fitted. Raises
        CrankcheckError."""
        ...

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        """The causes of what is out of tolerance or late, and what else is worth knowing."""
        ...


def log_kind(scene: Scene) -> LogKind:
    """That of the scene."""
    return cast(LogKind, way_of(scene).part("log"))
