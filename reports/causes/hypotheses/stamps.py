"""Samples that are even, while the times that are printed beside them are not."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from models.array import Array
from reports.causes.account import CAUSE, CHOICE, Account
from reports.causes.fit import fitted
from reports.causes.inquiry import Inquiry
from reports.causes.world import World
from reports.logs.units import UNITS
from reports.output.numbers import duration

FARTHEST = 0.55
"""In intervals, the most that a time is off the even ones."""
EVEN_STAMPS = 1e-9
"""In intervals, times that are even as they are."""
DECIMALS = range(10)
ON_GRID = 1e-3
"""In steps of its last decimal, how near a printed number is to it."""


def stamps(inquiry: Inquiry) -> Iterator[Account]:
    """Times that were rounded, or shaken, where the samples are as far apart as they can be."""
    time_s = inquiry.case.log.time_s
    if time_s.size < 3 or inquiry.world.drive is not None:
        return
    row = np.arange(time_s.size) - 0.5 * (time_s.size - 1)
    interval = float(row @ (time_s - time_s.mean()) / (row @ row))
    middle = float(time_s.mean())
    off = time_s - (middle + interval * row)
    if not EVEN_STAMPS * interval < np.max(np.abs(off)) < FARTHEST * interval:
        return
    half = 0.5 * ((time_s.size - 1) % 2)  # rows are whole numbers from the middle, or halves

    def even(stamped: Array) -> Array:
        return middle + interval * (np.round((stamped - middle) / interval - half) + half)

    world = inquiry.world.stamped(even)
    shaken = float(np.max(np.abs(off)))
    phrase = (
        f"{_printed(inquiry)}, off by up to {duration(shaken)}: the samples are even, "
        f"{interval:.6g} s apart"
    )
    for each in (world, _aligned(inquiry, world, middle, shaken)):
        told = each and inquiry.account_of_world("time stamps", CAUSE + CHOICE, each, phrase)
        if told:
            yield told


def _aligned(inquiry: Inquiry, world: World, middle: float, shaken: float) -> World | None:
    """The world of even samples, moved and stretched within what the times are off, as the line
    through uneven times is not quite that of the samples."""
    thin, columns = inquiry.thin, inquiry.unclaimed
    if not columns:
        return None
    length = float(np.ptp(inquiry.case.log.time_s))

    def aligned(numbers: Array) -> World:
        start, gain = (shaken * float(each) for each in numbers)
        return inquiry.world.stamped(
            lambda stamped: stamped + start + gain * (stamped - middle) / length
        ).stamped(world.stamps[-1])

    def residual(numbers: Array) -> Array:
        errors = thin.errors(aligned(numbers), columns)
        return np.concatenate([errors[c] / thin.excerpts[c].size.rms for c in columns])

    found = fitted(residual, (0.0, 0.0), (1e-4, 1e-4))
    return None if found is None or np.max(np.abs(found)) > 1.0 else aligned(found)


def _printed(inquiry: Inquiry) -> str:
    """How the times are printed."""
    log = inquiry.case.log
    column, unit = log.stamp
    size = UNITS["time"].get(unit, 1.0)
    numbers = (log.time_s + log.zero_s) / size
    times = f"the times (column {column})" if column else "the times"
    for decimals in DECIMALS:
        steps = numbers * 10.0**decimals
        if np.max(np.abs(steps - np.round(steps))) < ON_GRID:
            return f"{times} are rounded to {decimals} decimals ({unit or 's'})"
    return f"{times} are uneven"
