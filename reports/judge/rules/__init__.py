"""The rules, by ID. A verdict on a cell consists of their findings alone.

CC101, 109, 115, 117, 119, 124 and 126 stand in `log`, CC110, 118 and 125 in `steps`, CC111, 112 and
134 in `reference`, CC116 in `limits`, CC135 in `loops`, CC136 and 137 in `worlds`; all others with
their quantity, in `reports.quantities`.
"""

from collections.abc import Iterable
from dataclasses import replace

from reports.judge.rules import log
from reports.judge.rules.limits import LIMITS, StartWithin
from reports.judge.rules.loops import LoopsHold
from reports.judge.rules.reference import ReferenceCertain, TruthEnds, TwoComputations
from reports.judge.rules.rule import Evidence, Finding, Rule
from reports.judge.rules.steps import ErrorShrinks, ErrorSmooth, ForcesShrink
from reports.judge.rules.worlds import AsAlone, OwnMotion

_ALL: tuple[Rule, ...] = (
    log.StatusOk(),
    *LIMITS,
    log.ValuesFinite(),
    ErrorShrinks(),
    TwoComputations(),
    ReferenceCertain(),
    log.LogComplete(),
    StartWithin(),
    log.AsAsked(),
    ErrorSmooth(),
    log.Required(),
    log.PinsBalance(),
    ForcesShrink(),
    log.NothingContradicts(),
    TruthEnds(),
    LoopsHold(),
    OwnMotion(),
    AsAlone(),
)
RULES: dict[str, Rule] = {rule.id: rule for rule in _ALL}
PLACES, RATES = ("CC103", "CC104", "CC105", "CC113"), ("CC106", "CC107", "CC108", "CC114", "CC116")
ELASTIC = ("CC131", "CC132", "CC133")
FORCES = ("CC120", "CC121", "CC122", "CC123")
BATCHES = ("CC136", "CC137")
TUNABLE = ("CC101", "CC110", *PLACES)
"""Failures due to an engine's settings; failures of rates and forces follow from them."""


def judge(evidence: Evidence, rules: Iterable[Rule] | None = None) -> tuple[Finding, ...]:
    """Return the findings of every rule, or some, that applies to a cell, with their cures."""
    chosen = RULES.values() if rules is None else rules
    findings = (rule.check(evidence) for rule in chosen)
    return tuple(
        finding if finding.level == "pass" else replace(finding, cure=_cure(finding, evidence))
        for finding in findings
        if finding is not None
    )


def _cure(finding: Finding, evidence: Evidence) -> str:
    """Return the cure of a rule for this profile, with the result of a trial. Where a run did not
    end well only the status needs a cure: the rest follows from it."""
    if evidence.status != "ok" and finding.rule not in ("CC101", "CC135"):
        return ""
    cure = RULES[finding.rule].cure
    if evidence.errors is not None:
        cure = cure.replace("--steps-per-turn)", f"{evidence.errors.of_motion.step_option})")
    if evidence.remedy and finding.level == "fail" and finding.rule in (*TUNABLE, *RATES, *FORCES):
        return evidence.remedy
    if finding.rule not in TUNABLE or evidence.status in ("unsupported", "branch-changed"):
        return cure
    if evidence.profile not in ("", "tuned"):
        return f"{cure} Or use profile tuned."
    return cure


def titled(findings: Iterable[Finding]) -> list[tuple[str, str]]:
    """Return rules and texts of findings, each text behind the title of its rule."""
    return [(each.rule, f"{RULES[each.rule].title}: {each.text}") for each in findings]
