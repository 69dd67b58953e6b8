"""Changes from one version of an engine to the next."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from reports.history.verification import FOLLOWED, FollowedError, VersionResult, errors_of
from reports.output.numbers import count
from reports.results.changes import CellPair, Diff, ErrorChange, compare, floor, other_settings
from reports.results.runs import CellName, grouped

STANDS_OUT = 2.0
"""Factor from which on a changed error is described in words."""


@dataclass(frozen=True)
class FollowedChange(ErrorChange):
    """One error of a cell in two versions that follow each other."""

    cell: CellName
    before: str
    after: str

    @property
    def about(self) -> FollowedError:
        return FOLLOWED[self.quantity]

    @property
    def times_better(self) -> float:
        """Ratio by which the later version is better; under 1 it is worse."""
        return 1.0 / self.growth if self.growth else math.inf

    @property
    def stands_out(self) -> bool:
        return self.changed and self.factor >= STANDS_OUT


@dataclass(frozen=True)
class Headline:
    """One line on a change that stands out, and whether it is good news."""

    text: str
    good: bool | None


@dataclass(frozen=True)
class VersionStep:
    """A version that has a result, with the one before it that has."""

    before: VersionResult
    after: VersionResult

    @cached_property
    def diff(self) -> Diff:
        return compare(self.before.run, self.after.run)

    @cached_property
    def changes(self) -> tuple[FollowedChange, ...]:
        """Every followed error, of the cells that ended well in both versions."""
        return tuple(change for pair in self.diff.pairs for change in self._followed(pair))

    def _followed(self, pair: CellPair) -> Iterator[FollowedChange]:
        if not (pair.old.ok and pair.new.ok):
            return
        was, now = errors_of(pair.old), errors_of(pair.new)
        for name, error in FOLLOWED.items():
            if name in was or name in now:
                yield FollowedChange(
                    quantity=name,
                    old=was.get(name, math.inf),
                    new=now.get(name, math.inf),
                    floor=floor(error.tolerance, pair.name.steps_per_turn),
                    cell=pair.name,
                    before=self.before.version,
                    after=self.after.version,
                )


def steps(results: Sequence[VersionResult]) -> list[VersionStep]:
    """Return the steps from version to version."""
    return [VersionStep(*pair) for pair in pairwise(each for each in results if each.cells)]


def headlines(step: VersionStep) -> list[Headline]:
    """Return the headlines of one step, the worst first; one line where nothing stands out."""
    before, after = step.before.version, step.after.version
    lines = [*_ended(step), *_judged(step), *_factors(step.changes)]
    lines.sort(key=lambda line: line.good is True)  # stable: bad news, then the good
    if not lines:
        lines = [Headline(_calm(step), None)]
    # A cell that never ran has the settings that it was given.
    others = other_settings(pair for pair in step.diff.pairs if pair.changes)
    if names := sorted({name for settings in others.values() for name in settings}):
        text = f"{after} holds other settings than {before}: {', '.join(names)}"
        lines.append(Headline(text, None))
    return lines


def _calm(step: VersionStep) -> str:
    """Say that nothing stands out, and how much the two differ all the same."""
    before, after = step.before.version, step.after.version
    if not step.changes:
        return f"{after} and {before} have no error in common to compare"
    factors = [change.factor for change in step.changes if change.changed]
    if not factors:
        return f"no error of {after} differs from that of {before} by more than a tenth"
    return f"errors of {after} differ from those of {before} by {times(max(factors))} times at most"


def largest(changes: Iterable[FollowedChange]) -> FollowedChange | None:
    """Return the change by the largest factor; of two alike the worse one."""
    return max(
        changes, key=lambda each: (each.changed, each.factor, each.growth > 1.0), default=None
    )


def _ended(step: VersionStep) -> list[Headline]:
    """Return runs that end well in one version alone: a line per profile and ending."""
    groups = grouped(
        ((pair.name.variant, pair.old.status, pair.new.status), pair)
        for pair in step.diff.pairs
        if pair.turned
    )
    lines = []
    for (profile, was, now), (first, *others) in groups.items():
        more = f" and {count(len(others), 'more scene')}" if others else ""
        why = f": {first.new.reason[:120]}" if first.new.reason else ""
        text = (
            f"{step.after.version} ends as {now}, {step.before.version} as {was}, in "
            f"{first.name.scene}{more} {called(profile)}{why}"
        )
        lines.append(Headline(text, first.word == "better"))
    return lines


def _judged(step: VersionStep) -> list[Headline]:
    """Return cells that come within tolerance, or leave it: a line per profile and direction."""
    groups = grouped(
        ((pair.name.variant, "within" if pair.new.passes else "out"), pair)
        for pair in step.diff.pairs
        if pair.old.ok and pair.new.ok
        if pair.old.passes != pair.new.passes
    )
    words = {"within": ("within", "out of it"), "out": ("out of", "within it")}
    return [
        Headline(
            f"{step.after.version} is {words[verdict][0]} tolerance where {step.before.version} "
            f"was {words[verdict][1]}: {_scenes(members)} {called(profile)}",
            verdict == "within",
        )
        for (profile, verdict), members in groups.items()
    ]


def _scenes(members: Sequence[CellPair]) -> str:
    """Return one scene by its name, several by their number."""
    return members[0].name.scene if len(members) == 1 else count(len(members), "scene")


def _factors(changes: Sequence[FollowedChange]) -> list[Headline]:
    """Return the largest change of each quantity that stands out, by profile and direction.

    Rates are included only where no place stands out: they follow from the places.
    """
    groups = grouped(
        ((change.cell.variant, change.word()), change) for change in changes if change.stands_out
    )
    lines: list[tuple[bool, float, Headline]] = []
    for (profile, word), members in groups.items():
        shown = [change for change in members if not change.about.rate] or members
        for quantity in FOLLOWED:
            alike = [change for change in shown if change.quantity == quantity]
            if top := largest(alike):
                every = [c for c in changes if (c.cell.variant, c.quantity) == (profile, quantity)]
                able = sum(max(change.old, change.new) > change.floor for change in every)
                line = Headline(_told(top, len(alike), able), word == "better")
                lines.append((profile != "as-shipped", -top.factor, line))
    # Most users run the settings as shipped: these come first.
    return [line for *_, line in sorted(lines, key=lambda entry: entry[:2])]


def _told(top: FollowedChange, alike: int, scenes: int) -> str:
    """Return the largest change of a quantity in words, and how many scenes share it."""
    share = ""
    if scenes > 1:
        share = f"; by {STANDS_OUT:g} or more in {alike} of {scenes} scenes"
    return (
        f"{top.after} is {top.word()} than {top.before} by {times(top.factor)} times on the "
        f"{top.quantity} of {top.cell.scene} {called(top.cell.variant)} "
        f"({top.old:.1e} to {top.new:.1e} {top.about.unit}{share})"
    )


def called(profile: str) -> str:
    """Return a profile in a sentence."""
    return "as shipped" if profile == "as-shipped" else f"with profile {profile}"


def times(factor: float) -> str:
    """Return a factor in as many digits as it deserves."""
    if math.isinf(factor):
        return "infinitely many"
    return f"{float(f'{factor:.3g}'):.0f}" if factor >= 10.0 else f"{factor:.2g}"


def by_cell(results: Sequence[VersionResult]) -> dict[tuple[str, CellName], list[FollowedChange]]:
    """Return the changes of each version against the one before it, cell by cell."""
    changes = (change for step in steps(results) for change in step.changes)
    return grouped(((change.after, change.cell), change) for change in changes)
