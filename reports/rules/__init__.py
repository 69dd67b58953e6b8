"""The rules, by ID. A verdict is what they say of a cell, nothing else."""

from __future__ import annotations

from reports.rules.acceleration import AccelerationDifferenced, AccelerationReported
from reports.rules.angle import AngleWithin
from reports.rules.base import Evidence, Finding, Rule
from reports.rules.certainty import ReferenceCertain
from reports.rules.complete import LogComplete
from reports.rules.displacement import DisplacementWithin
from reports.rules.drive import DriveWithin
from reports.rules.finite import ValuesFinite
from reports.rules.gap import GapWithin
from reports.rules.independence import TwoComputations
from reports.rules.position import PositionWithin
from reports.rules.shrinking import ErrorShrinks
from reports.rules.start import StartWithin
from reports.rules.status import StatusOk
from reports.rules.velocity import VelocityDifferenced, VelocityReported

_ALL: tuple[Rule, ...] = (
    StatusOk(),
    DriveWithin(),
    AngleWithin(),
    DisplacementWithin(),
    PositionWithin(),
    GapWithin(),
    VelocityReported(),
    VelocityDifferenced(),
    AccelerationReported(),
    AccelerationDifferenced(),
    ValuesFinite(),
    ErrorShrinks(),
    TwoComputations(),
    ReferenceCertain(),
    LogComplete(),
    StartWithin(),
)
RULES: dict[str, Rule] = {rule.id: rule for rule in _ALL}


def judge(evidence: Evidence) -> tuple[Finding, ...]:
    """What every rule with something to look at says of a cell."""
    findings = (rule.check(evidence) for rule in RULES.values())
    return tuple(finding for finding in findings if finding is not None)
