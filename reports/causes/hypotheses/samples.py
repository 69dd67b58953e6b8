"""Single wrong samples: stuck, held or spikes; and the last digit of all samples."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from models.array import Array, Mask
from models.errors import CrankcheckError
from reports.causes.account import BOUNDED, CAUSE, CHOICE, Account
from reports.causes.cause import BROUGHT_WITHIN, Excerpt, Rows
from reports.causes.inquiry import Inquiry
from reports.logs.kinds import UNITS
from reports.output.numbers import listed

SHOWN = 3
"""Places that are named one by one; the others are counted."""
HELD = 0.3
"""A channel is held if more than this part of its readings repeat the one before."""
DEAD = 1e-4
"""A channel is dead if it moves by less than this part of its reference motion."""
NOTHING = 1e-15
"""Remaining part for a fault without a number: a stopped clock would explain it no better."""
FEW_RUNS = 3
"""Number of stretches that may stick singly, of any length."""
FEW, FEWEST = 0.03, 5
"""Part of the readings that may be spikes, and their number in any log."""
MINORITY = 0.2
"""Largest part of a short log that may be spikes: the others must show the right values."""
LONGEST_SPIKE = 3
"""Consecutive samples that may be one spike."""


def samples(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of channels off at samples that repeat the one before, or at a few others."""
    for column in inquiry.open:
        try:
            values, error = inquiry.whole(column)
        except CrankcheckError:
            continue
        off = np.abs(error) > inquiry.excerpts[column].limit
        for found in (_dead, _stuck, _spikes):
            yield found(inquiry, column, values, error, off)


def runs(where: Mask) -> Rows:
    """Return the first and the last place (n, 2) of each stretch that is True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]]).astype(np.int8)))
    return np.asarray(edges.reshape(-1, 2) - np.array([0, 1]))


def _dead(inquiry: Inquiry, column: str, values: Array, error: Array, off: Mask) -> Account | None:
    """Return the account of constant readings of a channel that should move."""
    excerpt = inquiry.excerpts[column]
    expected = excerpt.expected[np.isfinite(excerpt.expected)]
    if excerpt.channel.kind.turns:  # whole turns from sample to sample do not show
        expected = np.remainder(expected - expected[:1] + math.pi, math.tau)
    moves = np.ptp(expected)
    if moves <= excerpt.limit or np.ptp(values) > min(excerpt.limit, DEAD * moves):
        return None
    phrase = f"{{who}} stay{{s}} at {np.median(values):.4g} (in SI) from first to last"
    return Account("stuck", CAUSE, {column: NOTHING}, {column: NOTHING}, phrase)


def _stuck(inquiry: Inquiry, column: str, values: Array, error: Array, off: Mask) -> Account | None:
    """Return the account of readings that repeat the one before."""
    repeated = np.zeros_like(off)
    repeated[1:] = values[1:] == values[:-1]
    if not off.any() or np.any(off & ~repeated):
        return None
    stuck = runs(repeated)
    offs = np.concatenate([[0], np.cumsum(off)])
    stuck = stuck[offs[stuck[:, 1] + 1] > offs[stuck[:, 0]]]
    lengths = stuck[:, 1] - stuck[:, 0] + 1
    every = 1 + int(np.median(lengths))
    if len(stuck) > FEW_RUNS and np.mean(repeated) > HELD and np.mean(lengths == every - 1) > HELD:
        phrase = f"{{who}} {{is}} updated at every {every}th sample only, and held between"
        return _without(column, error, off, ("held", CAUSE + CHOICE, phrase))
    phrase = f"{{who}} stick{{s}}: {places_text(inquiry, stuck, 'repeat')} the one before"
    cost = CAUSE + CHOICE * min(len(stuck), 4)
    return _without(column, error, off, ("stuck", cost, phrase))


def _spikes(
    inquiry: Inquiry, column: str, values: Array, error: Array, off: Mask
) -> Account | None:
    """Return the account of single samples that are off by far more than their neighbours."""
    if not 0 < np.sum(off) <= min(max(FEWEST, FEW * off.size), MINORITY * off.size):
        return None
    spikes = runs(off)
    if np.any(spikes[:, 1] - spikes[:, 0] >= LONGEST_SPIKE):
        return None
    phrase = f"{{who}} {{is}} off at single samples: {places_text(inquiry, spikes)}"
    cost = CAUSE + CHOICE * min(1 + len(spikes), 4)
    return _without(column, error, off, ("spike", cost, phrase))


def _without(column: str, error: Array, off: Mask, said: tuple[str, float, str]) -> Account | None:
    """Return the account, by name, cost and phrase, of a fault that spares the other samples."""
    rest = float(np.max(np.abs(error[~off]), initial=0.0)) / float(np.max(np.abs(error)))
    if rest > BROUGHT_WITHIN:
        return None
    name, cost, phrase = said
    return Account(name, cost, {column: rest}, {column: rest}, phrase)


def places_text(inquiry: Inquiry, stretches: Rows, verb: str = "") -> str:
    """Return the first samples, counted from 0, with their times, and the number of the others."""
    times = inquiry.case.log.time_s
    each = []
    for first, last in stretches[:SHOWN]:
        at = f"(t = {times[first]:.6g} s)"
        one = first == last
        each.append(f"sample {first} {at}" if one else f"samples {first} to {last} {at}")
    more = len(stretches) - len(each)
    if more:
        each.append(f"{more} more")
    many = len(each) > 1 or stretches[0][0] != stretches[0][1]
    verbs = f" {verb}" + ("" if many else "s") if verb else ""
    return listed(each) + verbs


DECIMALS = range(-4, 13)
DIGITS = range(1, 10)
ON_GRID = 1e-4
"""Distance within which a number is on the grid, in steps of the grid."""
DOUBLE = 4e-16
"""Relative loss of a number by reading it and converting it to SI."""
HALF = 0.51
"""Largest change by rounding, in steps of the grid; earlier errors of the readings remain."""
MOST_PREDICTED = 0.9
"""Part of the readings that has to equal the rounded reference."""
EVEN_RMS = 12.0**-0.5
"""Root mean square of the change by rounding, in steps of the grid."""


@dataclass(frozen=True)
class RoundingGrid:
    """Grid of rounded readings: steps (n,) [SI], its words, and the width of errors in steps."""

    name: str
    step: Array
    words: str
    width: float = 1.0


def rounded(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of channels whose error is no more than the part after the last digit."""
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        yield from (_told(inquiry, excerpt, grid) for grid in _grids(excerpt))


def resolution(excerpt: Excerpt) -> float:
    """Return the last digit of the readings [SI], as far as it shows."""
    steps = [float(np.max(grid.step)) for grid in _grids(excerpt)]
    return max([DOUBLE * float(np.max(np.abs(excerpt.values), initial=0.0)), *steps])


def _grids(excerpt: Excerpt) -> Iterator[RoundingGrid]:
    """Yield the grids on which all readings lie, the coarsest of each kind."""
    channel = excerpt.channel
    size = UNITS[channel.kind.dimension][channel.unit]
    numbers = channel.sign * excerpt.values / size - channel.offset
    if not np.all(np.isfinite(numbers)) or np.ptp(numbers) == 0.0:
        return
    lost, written = DOUBLE * (np.abs(numbers) + abs(channel.offset)), 0.0
    for decimals in DECIMALS:
        step = np.full(numbers.shape, 10.0**-decimals)
        if _on(numbers, step, lost):
            words = f"{decimals} decimals" if decimals > 0 else f"{10**-decimals:.0f}"
            written = 10.0**-decimals
            yield RoundingGrid("rounded", step * size, f"{words} ({channel.unit})")
            break
    exponent = np.floor(np.log10(np.maximum(np.abs(numbers), 1e-300)))
    for digits in DIGITS:
        step = 10.0 ** (exponent - digits + 1)
        if _on(numbers, step, lost):
            yield RoundingGrid(
                "rounded", step * size, f"{digits} significant digits ({channel.unit})"
            )
            break
    for name, kind, words in BINARY:
        for unit, other in UNITS[channel.kind.dimension].items() if not channel.offset else ():
            ratio = size / other  # not 1 where the readings were converted since
            width = _binary(numbers * ratio, kind, 4.0 * lost * ratio, written * ratio)
            if width:
                step = np.spacing(np.abs(numbers * ratio).astype(kind)).astype(float) * other
                yield RoundingGrid(name, step, words + f" of {unit}" * (ratio != 1.0), width)
    for off in (0.0, 0.5 * written):
        common = common_step(np.append(numbers, numbers[0] * (channel.kind.order == 0)), off)
        if common <= 1.5 * written and off and channel.kind.turns:  # too few digits for Euclid
            common = _part_of_turn(numbers, math.tau / size, off)
        if common > 1.5 * written:
            yield _counts(excerpt, common, 1.0 + written / common)
            break


BINARY = (
    ("float16", np.float16, "half precision (float16)"),
    ("float32", np.float32, "single precision (float32)"),
)
COARSE, LEVELS = 8.0, 3
"""Least ratio of a step to the doubt of the numbers; and the fewest levels that show a step."""
DIFFERENCED = 1e-9
"""Part of the largest number that differences of counts may have lost."""
SURE = 1e-3
"""Part of an error that counts as left by a common step: repeated readings may look held."""
WHOLE, MOST_STEPS = 0.02, 1e6
"""Largest distance of a number of steps a turn from a whole number, and the most that are named."""


def _binary(numbers: Array, kind: type[np.floating[Any]], lost: Array, written: float) -> float:
    """Return the width of errors, in steps, of numbers of few binary digits, known but for the last
    decimal ``written`` if any: 1; of the shortest decimals that say such numbers: 2; of others: 0.
    """
    near = numbers.astype(kind)
    coarse = np.spacing(np.abs(near)).astype(float) > COARSE * written
    if np.mean(coarse) > 0.5 and np.all((abs(numbers - near) <= lost + 0.5 * written)[coarse]):
        return 1.0
    for few in (8, None):  # texts take their time
        if np.any(np.abs(numbers[:few] - near[:few].astype(str).astype(float)) > lost[:few]):
            return 0.0
    return 2.0


def common_step(numbers: Array, doubt: float) -> float:
    """Return the largest step of which all numbers, each known to within ``doubt``, differ by whole
    multiples, by Euclid's algorithm; 0 where there is none well above the doubt."""
    levels, doubt = np.unique(numbers), max(doubt, DIFFERENCED * float(np.max(np.abs(numbers))))
    left, step = (gaps := np.diff(levels)), 0.0
    while np.any(left > 2.0 * doubt):
        step = float(left[left > 2.0 * doubt].min())
        if step <= COARSE * doubt:
            return 0.0
        left = np.abs(gaps - np.round(gaps / step) * step)
        left = left[left > 2.0 * doubt * (1.0 + np.round(gaps / step))]
    counts = np.concatenate([[0.0], np.cumsum(np.round(gaps / (step or np.inf)))])
    if np.unique(counts).size < LEVELS:
        return 0.0
    step, zero = np.polyfit(counts, levels, 1).tolist()
    return step if np.all(np.abs(levels - zero - step * counts) <= 2.0 * doubt) else 0.0


def _part_of_turn(numbers: Array, turn: float, doubt: float) -> float:
    """Return the largest step, of so many bits a turn, on whose grid numbers lie; 0 for none."""
    for step in turn * 0.5 ** np.arange(4.0, 24.0):
        off = np.remainder(numbers - numbers[0] + 0.5 * step, step)
        if step > COARSE * doubt and np.ptp(off) <= 2.1 * doubt:
            return float(step)
    return 0.0


def _counts(excerpt: Excerpt, step: float, width: float) -> RoundingGrid:
    """Return the grid of the counts of an encoder or converter; of angular velocities that are
    differences of an encoder's counts, two of which each are off by a step."""
    channel = excerpt.channel
    size = UNITS[channel.kind.dimension][channel.unit]
    words = f"steps of {step:.4g} {channel.unit}"
    spans = {"angle": 1.0, "angular velocity": float(np.median(np.diff(excerpt.reading.instants)))}
    turn = math.tau / (step * size * spans.get(channel.kind.dimension, math.inf))
    count = round(turn)
    if 1 < count < MOST_STEPS and abs(turn - count) < WHOLE:
        bits = f" ({count.bit_length() - 1} bits)" if count & (count - 1) == 0 else ""
        words += f", {count} a turn{bits}"
        words += " counted over one interval or half as many over two" * channel.kind.order
        width += channel.kind.order
    return RoundingGrid("quantised", np.full(excerpt.values.shape, step * size), words, width)


def _on(numbers: Array, step: Array, lost: Array) -> bool:
    """True if numbers are whole steps, and the steps exceed the loss in reading."""
    off = np.abs(numbers / step - np.round(numbers / step)) * step
    steps = np.ptp(numbers) > 0.5 * np.max(step)  # values within one step are on every grid
    return bool(steps and np.all(off <= ON_GRID * step + lost) and np.all(step > 1e3 * lost))


def _told(inquiry: Inquiry, excerpt: Excerpt, grid: RoundingGrid) -> Account | None:
    """Return the account of rounding to a grid, or truncation at it, for an error of that size."""
    half, sign = 0.5 * grid.step, np.sign(excerpt.values)
    tried: list[tuple[str, Array | float]] = [("rounded", 0.0), ("cut", half), ("cut", sign * half)]
    if grid.name == "quantised":  # from a zero within half a step of any
        middle = 0.5 * (np.max(excerpt.error) + np.min(excerpt.error)) * (grid.width < 2.0)
        tried = [("quantised", -np.clip(middle, -half, half))]
    for verb, zero in tried:
        error = excerpt.error + zero
        off = np.abs(error) > HALF * grid.width * grid.step + excerpt.limit
        rms = float(np.sqrt(np.sum((error / grid.step)[~off] ** 2) / error.size / grid.width))
        likely = 0.5 * EVEN_RMS < rms < 1.25 * EVEN_RMS or _predicted(excerpt, grid)
        if likely and np.sum(off) <= 2.0 * (grid.width >= 2.0):  # differences are others at ends
            phrase = f"{{who}} {{is}} {verb} to {grid.words}"
            share = SURE if grid.name == "quantised" else BOUNDED
            errors = {excerpt.channel.column: share * excerpt.error}
            return inquiry.account(grid.name, CAUSE, errors, phrase)
    return None


def _predicted(excerpt: Excerpt, grid: RoundingGrid) -> bool:
    """True if most readings equal the reference rounded to the grid; for a sequence of steps, with
    errors of few values, this shows more than their size."""
    zero = excerpt.channel.offset * UNITS[excerpt.channel.kind.dimension][excerpt.channel.unit]
    expected = excerpt.values - excerpt.error + zero
    off = np.round(expected / grid.step) * grid.step - zero - excerpt.values
    return bool(np.mean(np.abs(off) < 0.5 * grid.step) > MOST_PREDICTED)
