"""The last digit of readings: decimals, significant digits, single precision."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array
from reports.causes.account import BOUNDED, CAUSE, Account
from reports.causes.excerpt import Excerpt
from reports.causes.inquiry import Inquiry
from reports.logs.units import UNITS

DECIMALS = range(-4, 13)
DIGITS = range(1, 10)
ON_GRID = 1e-4
"""A number is on the grid where it is so near to it, in steps of the grid."""
DOUBLE = 4e-16
"""What a number loses as it is read and turned into SI, over itself."""
HALF = 0.51
"""What is taken off at most, in steps of the grid; what the readings were off before, they are."""
MOST_PREDICTED = 0.9
"""The part of the readings that has to be what is expected, rounded."""
EVEN_RMS = 12.0**-0.5
"""The root mean square of what rounding takes off, in steps of the grid."""


@dataclass(frozen=True)
class RoundingGrid:
    """What the readings are rounded to: steps (n,) [SI], and what is said of them."""

    name: str
    step: Array
    words: str


def rounded(inquiry: Inquiry) -> Iterator[Account]:
    """Channels whose error is no more than what is cut off behind their last digit."""
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        for grid in _grids(excerpt):
            told = _told(inquiry, excerpt, grid)
            if told is not None:
                yield told


def resolution(excerpt: Excerpt) -> float:
    """The last digit of the readings [SI], as far as it shows."""
    steps = [float(np.max(grid.step)) for grid in _grids(excerpt)]
    return max([DOUBLE * float(np.max(np.abs(excerpt.values), initial=0.0)), *steps])


def _grids(excerpt: Excerpt) -> Iterator[RoundingGrid]:
    """The grids that all readings lie on, the coarsest of each kind."""
    channel = excerpt.channel
    size = UNITS[channel.kind.dimension][channel.unit]
    numbers = channel.sign * excerpt.values / size - channel.offset
    if not np.all(np.isfinite(numbers)) or np.ptp(numbers) == 0.0:
        return
    lost = DOUBLE * (np.abs(numbers) + abs(channel.offset))
    for decimals in DECIMALS:
        step = np.full(numbers.shape, 10.0**-decimals)
        if _on(numbers, step, lost):
            words = f"{decimals} decimals" if decimals > 0 else f"{10**-decimals:.0f}"
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
    step = np.spacing(np.abs(numbers).astype(np.float32)).astype(float)
    if np.all(np.abs(numbers - numbers.astype(np.float32)) <= lost):
        yield RoundingGrid("float32", step * size, "single precision (float32)")


def _on(numbers: Array, step: Array, lost: Array) -> bool:
    """Whether numbers are whole steps, and the steps are longer than what was lost in reading."""
    off = np.abs(numbers / step - np.round(numbers / step)) * step
    steps = np.ptp(numbers) > 0.5 * np.max(step)  # what is less than one step is on every grid
    return bool(steps and np.all(off <= ON_GRID * step + lost) and np.all(step > 1e3 * lost))


def _told(inquiry: Inquiry, excerpt: Excerpt, grid: RoundingGrid) -> Account | None:
    """The account of a grid, rounded to or cut off at, where the error is of that size."""
    sign = np.sign(excerpt.values)
    for verb, error in (
        ("rounded", excerpt.error),
        ("cut", excerpt.error + 0.5 * grid.step),
        ("cut", excerpt.error + 0.5 * sign * grid.step),
    ):
        rms = float(np.sqrt(np.mean((error / grid.step) ** 2)))
        likely = 0.5 * EVEN_RMS < rms < 1.2 * EVEN_RMS or _predicted(excerpt, grid)
        if likely and np.all(np.abs(error) <= HALF * grid.step + excerpt.limit):
            phrase = f"{{who}} {{is}} {verb} to {grid.words}"
            errors = {excerpt.channel.column: BOUNDED * excerpt.error}
            return inquiry.account(grid.name, CAUSE, errors, phrase)
    return None


def _predicted(excerpt: Excerpt, grid: RoundingGrid) -> bool:
    """Whether most readings are what is expected, rounded to the grid; of a sequence of steps, of
    which the errors may be few numbers, that tells more than their size."""
    zero = excerpt.channel.offset * UNITS[excerpt.channel.kind.dimension][excerpt.channel.unit]
    expected = excerpt.values - excerpt.error + zero
    off = np.round(expected / grid.step) * grid.step - zero - excerpt.values
    return bool(np.mean(np.abs(off) < 0.5 * grid.step) > MOST_PREDICTED)
