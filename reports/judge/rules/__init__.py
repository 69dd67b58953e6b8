"""The rules, by ID. A verdict is what they say of a cell, nothing else."""

from __future__ import annotations

from dataclasses import replace

from reports.judge.rules.limits import LIMITS
from reports.judge.rules.log import AsAsked, LogComplete, StatusOk, ValuesFinite
from reports.judge.rules.reference import ReferenceCertain, TwoComputations
from reports.judge.rules.rule import Evidence, Finding, Rule
from reports.judge.rules.shrinking import ErrorShrinks
from reports.judge.rules.smooth import ErrorSmooth
from reports.judge.rules.start import StartWithin

_ALL: tuple[Rule, ...] = (
    StatusOk(),
    *LIMITS,
    ValuesFinite(),
    ErrorShrinks(),
    TwoComputations(),
    ReferenceCertain(),
    LogComplete(),
    StartWithin(),
    AsAsked(),
    ErrorSmooth(),
)
RULES: dict[str, Rule] = {rule.id: rule for rule in _ALL}
TUNABLE = ("CC101", "CC103", "CC104", "CC105", "CC110", "CC113")
"""Failures that come from what an engine is set to."""
UNEQUAL = 100.0
"""Masses of two links over each other that the solvers of engines find hard."""


def judge(evidence: Evidence) -> tuple[Finding, ...]:
    """What every rule with something to look at says of a cell, and what would help this cell."""
    findings = (rule.check(evidence) for rule in RULES.values())
    return tuple(
        finding if finding.level == "pass" else replace(finding, cure=_cure(finding, evidence))
        for finding in findings
        if finding is not None
    )


def _cure(finding: Finding, evidence: Evidence) -> str:
    """The cure of a rule for this profile and these masses.

    Where a run did not end well the status alone is to be mended: the rest follows from it.
    """
    if evidence.status != "ok" and finding.rule != "CC101":
        return ""
    cure = RULES[finding.rule].cure
    if finding.rule not in TUNABLE or evidence.status in ("unsupported", "branch-changed"):
        return cure
    if evidence.profile != "tuned":
        return f"{cure} Or use profile tuned."
    if evidence.mass_ratio > UNEQUAL:
        return (
            f"{cure} The heaviest body has {evidence.mass_ratio:.0f} times the mass of the "
            "lightest, which takes more iterations than the profile has: bring the masses nearer."
        )
    return cure
