"""A model of the user's own with its lines, and their results."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from models.errors import CrankcheckError
from models.scene import Scene
from reports.judge.cell import Checked, unfinished
from reports.judge.halving import worst_place
from reports.judge.rules import judge
from reports.judge.rules.rule import Finding
from reports.output.numbers import short
from reports.own_model.account import CheckedLine, ModelAccount, ModelLine, checked_line, told
from reports.verify.advised import HELPS
from reports.workers.isolated import Isolated, Limits, Lost

SAYS = 2.0
"""Ratio of errors from which on a line with a single change is worth reporting."""
PARTS = (1, 2, 4)
"""Divisors of the step."""


@dataclass(frozen=True)
class JointGap:
    """A joint or loop: its opening in the file's own pose, and, by line, its widest gap [m];
    ``share`` is that of the model as written over its limit, NaN where it has none."""

    name: str
    open_m: float
    gap_m: Mapping[str, float]
    share: float


@dataclass(frozen=True, kw_only=True)
class JudgedModel:
    """A model as read, and its lines: as written first, recommended last. The verdict is that on
    the model as written."""

    account: ModelAccount
    lines: Sequence[CheckedLine]

    @property
    def own(self) -> CheckedLine:
        """The model as written."""
        return self.lines[0]

    @property
    def verdict(self) -> str:
        return self.own.verdict

    @property
    def findings(self) -> tuple[Finding, ...]:
        return self.own.findings

    @property
    def failures(self) -> tuple[Finding, ...]:
        return self.own.failures

    @property
    def scene(self) -> Scene:
        return self.account.scene

    @property
    def patch(self) -> str:
        """The recommended settings as a diff of the file, or in words where that is impossible; ""
        where the file has them, or where they do not help."""
        return self.account.recommended.patch if self.account.helps else ""

    @property
    def three(self) -> list[CheckedLine]:
        """The lines as written, contacts off, recommended."""
        names = told(self.account.profiles)
        return [one for one in self.lines if one.cell.profile in names]

    @property
    def others(self) -> list[CheckedLine]:
        """The other lines worth reporting."""
        names = told(self.account.profiles)
        rest = [(one, self.gains(one)[0]) for one in self.lines if one.cell.profile not in names]
        return [
            one
            for one, factor in rest
            if one.status != self.own.status
            or (math.isfinite(factor) and not 1 / SAYS <= factor <= SAYS)
        ]

    def without(self, kind: str) -> CheckedLine | None:
        """Return the line without the disturbances of a kind, None where there is none."""
        name = f"{kind}-off"
        return next((one for one in self.lines if one.cell.profile == name), None)

    def gains(self, one: Checked) -> tuple[float, float, float]:
        """Return the error as written over that of a line, at the step, its half and its quarter;
        NaN where one of them has none."""
        own, other = errors_of(self.own), errors_of(one)
        first, second, third = (_ratio(a, b) for a, b in zip(own, other, strict=True))
        return first, second, third

    def still(self) -> Finding | None:
        """Return the worst failure of the recommended settings, as a part of its limit, if any."""
        failures = self.lines[-1].failures
        return max(failures, key=_part, default=None)

    def joints(self) -> list[JointGap]:
        """Return every joint and loop, the widest as written first."""
        limit = self.own.limits.get("gap")
        most = limit.number * (self.scene.longest_m or 1.0) if limit else math.nan
        by_line = {
            one.cell.profile: {
                row.body: row.maximum
                for row in (one.errors.rows if one.errors else ())
                if (row.quantity, row.source, row.kind) == ("gap", "reported", "total")
            }
            for one in self.three
        }
        own = by_line[self.own.cell.profile]
        found = [
            JointGap(
                name,
                open_m,
                {line: gap[name] for line, gap in by_line.items() if name in gap},
                own.get(name, math.nan) / most,
            )
            for name, open_m in self.account.open_m.items()
        ]
        return sorted(found, key=lambda joint: -own.get(joint.name, 0.0))


def errors_of(one: Checked) -> tuple[float, float, float]:
    """Return the largest position error of a line at the step, its half and its quarter, as pure
    numbers; NaN where there is none, or where the run did not end well."""
    worst = worst_place(one.errors) if one.errors else None
    if worst is None or one.status != "ok":
        return math.nan, math.nan, math.nan
    if one.convergence is None:
        return worst.pure, math.nan, math.nan
    _, half, quarter = one.convergence.error
    return worst.pure, half, quarter


def _ratio(own: float, other: float) -> float:
    if math.isnan(own) or math.isnan(other):
        return math.nan
    if own == other:
        return 1.0
    return own / other if other > 0.0 else math.inf


def judged_model(account: ModelAccount, lines: Sequence[CheckedLine]) -> JudgedModel:
    """Return a model with its lines, each with the effect of the recommended settings on it."""
    judged = JudgedModel(account=account, lines=lines)
    return replace(judged, lines=[_advised(judged, one) for one in lines])


def _advised(judged: JudgedModel, one: CheckedLine) -> CheckedLine:
    """Return a line whose cures are the recommended settings, where these help."""
    last = judged.lines[-1]
    if one is last or one.verdict == "within" or not judged.account.helps:
        return one
    error, best = errors_of(one)[0], errors_of(last)[0]
    if error < HELPS * best:
        return one
    less = f"{short(error / best)} times less error" if best > 0.0 and error > 0.0 else "it runs"
    now = "within tolerance" if last.verdict == "within" else "still out of tolerance"
    changed = replace(one, remedy=f"The recommended settings: {less}, {now}.")
    return replace(changed, findings=judge(changed))


def _part(finding: Finding) -> float:
    """Return a finding as a part of its limit; infinite without numbers: how the run ended."""
    return math.inf if math.isnan(finding.taken) else finding.taken


Run = Callable[[ModelLine], CheckedLine]


def run_lines(
    account: ModelAccount, limits: Limits, done: Callable[[CheckedLine], None] = lambda _: None
) -> JudgedModel:
    """Run all lines of an account, each in a process that is ended when it fails or hangs."""
    child: Isolated[CheckedLine] = Isolated(limits)

    def run(line: ModelLine) -> CheckedLine:
        result = child.call(checked_line, line)
        if not isinstance(result, Lost):
            return result
        if isinstance(result.error, CrankcheckError):
            raise result.error
        return CheckedLine(**vars(unfinished(line.cell, result.status, result.reason)))

    try:
        return judged_lines(account, run, done)
    finally:
        child.close()


def judged_lines(
    account: ModelAccount, run: Run, done: Callable[[CheckedLine], None]
) -> JudgedModel:
    """Return all lines, run by ``run``; the recommendation is chosen after the first."""
    lines: list[CheckedLine] = []
    for profile in account.profiles:
        if len(lines) == 1:
            account = chosen(account, lines[0], run)
        lines.append(run(ModelLine(account, profile)))
        done(lines[-1])
    return judged_model(account, lines)


def chosen(account: ModelAccount, own: CheckedLine, run: Run) -> ModelAccount:
    """Return the account with the first of its proposals that gains on the model as written;
    contacts are off only for an error `SAYS` times less. If none gains, ``helps`` is False."""
    limit = _error(own)
    quick = replace(account, request=replace(account.request, converge=False))
    lines = [
        (each, ModelLine(replace(quick, recommended=each), account.profiles[-1]))
        for each in account.proposals
    ]
    for integrator in (True, False):
        found = [
            (_error(run(line)) if each.patch else limit, each)
            for each, line in lines
            if each.advised.integrator == integrator
        ]
        kept = next(pair for pair in found if not pair[1].advised.contacts_off)
        least = min(found, key=lambda pair: pair[0])
        best = least if SAYS * least[0] < kept[0] else kept
        if best[0] < limit:
            return replace(account, recommended=best[1])
    there = [each for each in account.proposals if not each.patch]
    if there and math.isfinite(limit):
        return replace(account, recommended=there[0])
    return replace(account, helps=False)


def _error(one: CheckedLine) -> float:
    """Return the largest position error, infinite where the run did not end well."""
    error = errors_of(one)[0]
    return math.inf if math.isnan(error) else error
