"""What changed from one version of an engine to the next."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from reports.history.measured import QUANTITIES, Found, Outcome, Quantity
from reports.judge.tolerance import ROUNDING

STANDS_OUT = 2.0
"""The factor from which on an error that changed is told of in words."""
SAME = 1.01
"""Factors up to this one are no change."""


@dataclass(frozen=True)
class Change:
    """One error in two versions that follow each other."""

    before: str
    after: str
    scene: str
    profile: str
    quantity: Quantity
    was: float
    now: float

    @property
    def ratio(self) -> float:
        """How many times better the later version is; under 1 it is worse.

        What rounding explains counts as nothing: two errors below it are the same.
        """
        was, now = (max(error, ROUNDING) for error in (self.was, self.now))
        if math.isinf(was) and math.isinf(now):
            return 1.0
        return was / now if math.isfinite(now) else 0.0

    @property
    def factor(self) -> float:
        """By how many times the two differ, whichever is better; at least 1."""
        ratio = self.ratio
        return math.inf if ratio == 0.0 else max(ratio, 1.0 / ratio)

    @property
    def word(self) -> str:
        return "better" if self.ratio > 1.0 else "worse"


@dataclass(frozen=True)
class Turn:
    """A cell that ended in another way, or was judged otherwise, than in the version before."""

    before: str
    after: str
    was: Found
    now: Found

    @property
    def good(self) -> bool:
        return (self.now.status == "ok", self.now.verdict == "within") > (
            self.was.status == "ok",
            self.was.verdict == "within",
        )


@dataclass(frozen=True)
class Headline:
    """One line of what stands out, and whether it is good news."""

    text: str
    good: bool | None


def steps(outcomes: Sequence[Outcome]) -> list[tuple[Outcome, Outcome]]:
    """Each version that has a result with the one before it that has."""
    return list(pairwise(outcome for outcome in outcomes if outcome.cells))


def changes(before: Outcome, after: Outcome) -> list[Change]:
    """Every error that both versions have."""
    return [
        Change(before.version, after.version, now.scene, now.profile, quantity, *pair)
        for was, now in _pairs(before, after)
        for quantity in QUANTITIES
        if (pair := _both(was, now, quantity))
    ]


def turns(before: Outcome, after: Outcome) -> list[Turn]:
    """Every cell that ended or was judged otherwise."""
    return [
        Turn(before.version, after.version, was, now)
        for was, now in _pairs(before, after)
        if (was.status, was.verdict) != (now.status, now.verdict)
    ]


def other_settings(before: Outcome, after: Outcome) -> list[str]:
    """The settings that the engine held otherwise in some cell: not the version alone changed."""
    found = set()
    for was, now in _pairs(before, after):
        if not was.errors or not now.errors:  # what never ran holds what it was given
            continue
        for name in was.settings.keys() & now.settings.keys():
            if json.dumps(was.settings[name]) != json.dumps(now.settings[name]):
                found.add(name)
    return sorted(found)


def headlines(before: Outcome, after: Outcome) -> list[Headline]:
    """What stands out of one step, the worst first; one line where nothing does."""
    lines = [
        *_ended(turns(before, after)),
        *_judged(turns(before, after)),
        *_factors(changes(before, after)),
    ]
    lines.sort(key=lambda line: line.good is True)  # stable: bad news, then the good
    if not lines:
        lines = [Headline(_calm(before, after), None)]
    if held := other_settings(before, after):
        text = f"{after.version} holds other settings than {before.version}: {', '.join(held)}"
        lines.append(Headline(text, None))
    return lines


def _calm(before: Outcome, after: Outcome) -> str:
    """That nothing stands out, and how much the two differ all the same."""
    factors = [one.factor for one in changes(before, after)]
    if not factors:
        return f"{after.version} and {before.version} have no error in common to compare"
    if max(factors) <= SAME:
        return f"{after.version} differs from {before.version} in no error"
    most = times(max(factors))
    return f"{after.version} differs from {before.version} by {most} times at most in any error"


def largest(found: Iterable[Change]) -> Change | None:
    """The change by the largest factor; of two alike the worse one."""
    return max(found, key=lambda one: (one.factor, one.ratio < 1.0), default=None)


def _pairs(before: Outcome, after: Outcome) -> list[tuple[Found, Found]]:
    """The cells that both versions were asked for."""
    known = {(cell.scene, cell.profile): cell for cell in before.cells}
    found = [(known.get((cell.scene, cell.profile)), cell) for cell in after.cells]
    return [(was, now) for was, now in found if was is not None]


def _both(was: Found, now: Found, quantity: Quantity) -> tuple[float, float] | None:
    """The errors of a quantity in both, where both have it."""
    if quantity.name not in was.errors or quantity.name not in now.errors:
        return None
    return was.errors[quantity.name], now.errors[quantity.name]


def _ended(found: Sequence[Turn]) -> list[Headline]:
    """Runs that end in another way: by profile and by how they end, one line each."""
    groups: dict[tuple[str, str, str], list[Turn]] = {}
    for turn in found:
        if turn.was.status != turn.now.status:
            key = (turn.now.profile, turn.was.status, turn.now.status)
            groups.setdefault(key, []).append(turn)
    lines = []
    for (profile, was, now), members in groups.items():
        first = members[0]
        more = f" and {_count(len(members) - 1, 'more scene')}" if len(members) > 1 else ""
        why = f": {first.now.reason[:120]}" if first.now.reason else ""
        lines.append(
            Headline(
                f"{first.after} ends as {now}, {first.before} as {was}, in {first.now.scene}{more} "
                f"{called(profile)}{why}",
                first.good,
            )
        )
    return lines


def _judged(found: Sequence[Turn]) -> list[Headline]:
    """Cells that come within tolerance, or leave it: one line for each profile and direction."""
    groups: dict[tuple[str, str], list[Turn]] = {}
    for turn in found:
        if turn.was.status == turn.now.status == "ok":
            groups.setdefault((turn.now.profile, turn.now.verdict), []).append(turn)
    words = {"within": ("within", "out of it"), "out": ("out of", "within it")}
    return [
        Headline(
            f"{members[0].after} is {words[verdict][0]} tolerance where {members[0].before} was "
            f"{words[verdict][1]}: {_scenes(members)} {called(profile)}",
            verdict == "within",
        )
        for (profile, verdict), members in groups.items()
    ]


def _scenes(members: Sequence[Turn]) -> str:
    """One scene by its name, several by their number."""
    return members[0].now.scene if len(members) == 1 else _count(len(members), "scene")


def _factors(found: Sequence[Change]) -> list[Headline]:
    """The largest change of each quantity that stands out, by profile and direction.

    Rates are told of only where no place tells it: they follow from the places.
    """
    groups: dict[tuple[str, str], list[Change]] = {}
    for one in found:
        if one.factor >= STANDS_OUT:
            groups.setdefault((one.profile, one.word), []).append(one)
    lines: list[tuple[bool, float, Headline]] = []
    for (profile, word), members in groups.items():
        shown = [one for one in members if not one.quantity.rate] or members
        for quantity in QUANTITIES:
            alike = [one for one in shown if one.quantity is quantity]
            if top := largest(alike):
                every = [o for o in found if o.profile == profile and o.quantity is quantity]
                able = sum(max(one.was, one.now) > ROUNDING for one in every)
                line = Headline(_told(top, len(alike), able), word == "better")
                lines.append((profile != "as-shipped", -top.factor, line))
    # The settings as shipped are what most users run: theirs come first.
    return [line for *_, line in sorted(lines, key=lambda entry: entry[:2])]


def _told(top: Change, alike: int, scenes: int) -> str:
    """The largest change of a quantity in words, and how many scenes share it."""
    share = ""
    if scenes > 1:
        share = f"; by {STANDS_OUT:g} or more in {alike} of {scenes} scenes"
    return (
        f"{top.after} is {top.word} than {top.before} by {times(top.factor)} times on the "
        f"{top.quantity.name} of {top.scene} {called(top.profile)} "
        f"({top.was:.1e} to {top.now:.1e} {top.quantity.unit}{share})"
    )


def called(profile: str) -> str:
    """A profile in a sentence."""
    return "as shipped" if profile == "as-shipped" else f"with profile {profile}"


def times(factor: float) -> str:
    """A factor in as many digits as it deserves."""
    if math.isinf(factor):
        return "infinitely many"
    return f"{float(f'{factor:.3g}'):.0f}" if factor >= 10.0 else f"{factor:.2g}"


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}" + ("" if number == 1 else "s")
