"""Readings that belong to other instants than their stamps, all by the same delay."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.array import Array, Mask
from models.errors import CrankcheckError
from models.scene.laws import ConstantSpeed
from reports.causes.account import CAUSE, NUMBER, Account, fitted, later, number
from reports.causes.cause import EXPLAINED, CauseSize, Excerpt
from reports.causes.hypotheses.samples import resolution
from reports.causes.inquiry import Inquiry

NUDGE = 1e-6
"""Change of a delay for its slope, in periods."""
SCAN = 48
"""Number of delays, within half a period to either side, among which large ones are searched."""
SCANNED = 120
"""Rows on which they are tried."""
SAME = 0.02
"""Delays count as one if they differ by less than this part of one, or of a sample."""
MOST_PERIODS = 0.75
"""Largest delay in periods: beyond half a period there is a nearer one."""
GROUPS = 8
"""Number of delays that are distinguished."""
MOSTLY = 0.5
"""Part of the readings that a delay has to cover."""
LEAST_SAMPLES = 0.05
"""Least delay in samples that is reported for a channel within its limit."""
CLEAR = 5.0
"""Factor by which a delay has to reduce an error within its limit to be reported."""
SEEN = 20.0
"""Least ratio of such an error to the last digit of the readings."""


@dataclass(frozen=True)
class Delay:
    """Delay [s] by which the readings of a column belong later, and its uncertainty."""

    column: str
    by_s: float
    doubt_s: float


def late(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield delays that explain one or several channels; for channels within their limits, only
    those that clearly explain the small error."""
    candidates = (*inquiry.open, *_doubtful(inquiry))
    delays = [delay for delay in map(Search(inquiry).delay, candidates) if delay is not None]
    for group in _groups(delays, inquiry.step_s):
        yield _delay_account(inquiry, group)


def _doubtful(inquiry: Inquiry) -> list[str]:
    """Return the channels within their limits whose error exceeds their last digit's."""
    return [
        column
        for column, excerpt in inquiry.excerpts.items()
        if not inquiry.case.excerpts[column].out and excerpt.worst > SEEN * resolution(excerpt)
    ]


class Search:
    """Delays of columns, fitted to few rows; scans are kept for all columns."""

    def __init__(self, inquiry: Inquiry) -> None:
        self.inquiry, self.thin = inquiry, inquiry.thin
        step = max(1, self.thin.rows // SCANNED)
        self.few = self.thin.part(np.arange(0, self.thin.rows, step))

    def delay(self, column: str) -> Delay | None:
        """Return the delay of the readings of a column; None where it cannot be determined."""
        excerpt = self.thin.excerpts[column]
        delta = NUDGE * self.inquiry.period_s

        def residual(by: Array) -> Array:
            return self._error(excerpt, float(by[0]))

        def rest(by: Array) -> float:
            return excerpt.rest(residual(by))

        near = fitted(residual, [0.0], [delta])
        if near is None:
            return None
        if rest(near) > EXPLAINED and column in self.inquiry.open:  # if it is a delay, a large one
            tried = [fitted(residual, [start], [delta]) for start in self._scan(column)]
            near = min((near, *(each for each in tried if each is not None)), key=rest)
        found = float(near[0])
        if not found or abs(found) > MOST_PERIODS * self.inquiry.period_s:
            return None
        rate = (residual(np.array([found + delta])) - residual(near)) / delta
        left = CauseSize.of(residual(near)).rms
        moving = CauseSize.of(rate).rms
        if not moving:
            return None
        return Delay(column, found, left / moving / math.sqrt(excerpt.rows.size))

    def _error(self, excerpt: Excerpt, by_s: float) -> Array:
        """Return the error of readings that belong ``by_s`` later. Raises CrankcheckError."""
        channel, world = excerpt.channel, self.inquiry.world.later(by_s)
        error = excerpt.beside(channel.expected(world.at(excerpt.instants, [channel])))
        return np.where(_logged(self.inquiry, excerpt, by_s), error, 0.0)

    def _scan(self, column: str) -> Sequence[float]:
        """Return the two delays within half a period that leave least of an error."""
        lefts = [(float(errors[column] @ errors[column]), by_s) for by_s, errors in self._scans]
        rests = np.array([left for left, _ in lefts])
        least = (rests <= np.roll(rests, 1)) & (rests <= np.roll(rests, -1))
        near = sorted(each for each, good in zip(lefts, least, strict=True) if good)
        return [by_s for _, by_s in near[:2]]

    @cached_property
    def _scans(self) -> Sequence[tuple[float, Mapping[str, Array]]]:
        """The errors of all columns at each of the delays; none where there is no mechanism."""
        found = []
        for by_s in (np.linspace(-0.5, 0.5, SCAN + 1)[:-1] * self.inquiry.period_s).tolist():
            try:
                found.append((by_s, self.few.errors(self.inquiry.world.later(by_s))))
            except CrankcheckError:
                return ()
        return found


def _logged(inquiry: Inquiry, excerpt: Excerpt, by_s: float) -> Mask:
    """Return a mask of readings that belong, ``by_s`` later, to an instant of the log. A shifted
    channel lacks the others: it repeats a reading there, or takes it from the other end. All True
    where the mask would drop most. The slack keeps readings that a nudge of the delay moves beyond
    an end: a fit that lost a sample by it would mistake that for the slope."""
    instants, slack = excerpt.instants + by_s, 2.0 * NUDGE * inquiry.period_s
    first, last = excerpt.instants[0] - slack, excerpt.instants[-1] + slack
    there = (instants >= first) & (instants <= last)
    return there if np.mean(there) >= MOSTLY else np.ones_like(there)


def _groups(delays: Sequence[Delay], step_s: float) -> list[list[Delay]]:
    """Return groups of delays that may be one, each around its surest."""
    groups: list[list[Delay]] = []
    for delay in sorted(delays, key=lambda each: each.doubt_s):
        for group in groups:
            near = max(SAME * abs(group[0].by_s), SAME * step_s, 3.0 * delay.doubt_s)
            if abs(delay.by_s - group[0].by_s) <= near:
                group.append(delay)
                break
        else:
            groups.append([delay])
    return sorted(groups, key=len, reverse=True)[:GROUPS]


def _delay_account(inquiry: Inquiry, group: Sequence[Delay]) -> Account | None:
    weights = np.array([1.0 / max(each.doubt_s, 1e-9 * inquiry.step_s) ** 2 for each in group])
    by_s = float(weights @ np.array([each.by_s for each in group]) / weights.sum())
    world = inquiry.world.later(by_s)
    try:
        expected = inquiry.expected(world)
    except CrankcheckError:
        return None
    errors = {
        column: np.where(_logged(inquiry, excerpt, by_s), excerpt.beside(expected[column]), 0.0)
        for column, excerpt in inquiry.excerpts.items()
    }
    doubtful = _doubtful(inquiry) if abs(by_s) >= LEAST_SAMPLES * inquiry.step_s else ()
    advised = [
        column
        for column in doubtful
        if CLEAR * inquiry.excerpts[column].rest(errors[column]) <= 1.0
        and inquiry.excerpts[column].moves(expected[column])
    ]
    instants, timed = later(by_s, inquiry.step_s), inquiry.case.log.timed
    if not timed:
        driver = inquiry.world.scene.driver
        angle = math.degrees(abs(by_s) * driver.law.peak_speed_rad_s)
        instants = f"{angle:.4g} deg of {driver.link} {instants.split()[-1]}, or its angles are off"
    told = inquiry.account(
        "delay",
        CAUSE + NUMBER,
        errors,
        f"{{who}} {{belongs}} {instants}",
        corrections={c: {"delay_s": inquiry.channel(c).delay_s + by_s} for c in errors if timed},
        expected=expected,
        besides=advised,
    )
    if told is None or not _is_everything(inquiry, told.columns, expected, errors):
        return told
    phrase = f"all that is logged belongs {instants}: {_start_text(inquiry, by_s)}"
    return replace(told, name="start", phrase=phrase, world=world)


def _is_everything(
    inquiry: Inquiry,
    explained: Sequence[str],
    expected: Mapping[str, Array],
    errors: Mapping[str, Array],
) -> bool:
    """True if most channels that would show a delay have it, including a position. False where the
    log itself drives the scene, as it then has no start."""
    if inquiry.world.drive is not None:
        return False
    shown = [c for c, each in inquiry.excerpts.items() if each.moves(expected[c], each.limit)]
    late = [column for column in shown if column in explained]
    places = [column for column in late if inquiry.channel(column).kind.order == 0]
    most = len(late) > 1 and 2 * len(late) >= len(shown)
    return bool(most and places and not inquiry.spoilt(errors))


def _start_text(inquiry: Inquiry, by_s: float) -> str:
    law = inquiry.world.scene.driver.law
    clock = "the clock of the log starts elsewhere"
    if not isinstance(law, ConstantSpeed):
        return clock
    now, before = (math.degrees(law.start_rad + law.speed_rad_s * each) for each in (by_s, 0.0))
    return f"{clock}, or the driver starts at {number(now, 5)} deg, not at {before:.5g} deg"
