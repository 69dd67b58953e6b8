"""A clock that differs from the scene's: another unit of time, another pace, uneven stamps.

A slow clock and a fast driver are the same where only positions are logged; rates distinguish them,
if they were not taken over the log's own time.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene.laws import ConstantSpeed
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account, change, fitted, later, number
from reports.causes.cause import BROUGHT_WITHIN, Rows, picked
from reports.causes.inquiry import WELL, Inquiry
from reports.causes.world import World
from reports.logs.kinds import TYPICAL, UNITS
from reports.output.numbers import duration

MOST_FITS = 4
"""Channels to which a clock is fitted, one after another."""
FIRST, GROWTH, LEAST_ROWS = 0.02, 2.5, 12
"""First stretch of a fit, in periods from the beginning of the log; the growth of each next
stretch; and the rows of the shortest."""
SCANNED = 0.5
"""Stretch, in periods, in which other starts are searched."""
SCAN = 24
ROWS = 200
"""Rows of a stretch to which a clock is fitted."""
UNLIKE = 3.0
"""Of two explanations of a drift, the one that leaves so many times as much is ruled out."""
FASTEST = 1e3
"""Largest factor by which a clock may be slow or fast."""


@dataclass(frozen=True)
class ClockFault:
    """Clock that maps a stamp t [s] of the log to t + start + gain (t - first); ``paced`` where the
    rates are taken over its time."""

    first_s: float
    start_s: float
    gain: float
    paced: bool = False

    def __call__(self, stamps: Array) -> Array:
        return stamps + (self.start_s + self.gain * (stamps - self.first_s))

    @property
    def runs(self) -> bool:
        """True if the clock runs forward, at a plausible pace."""
        return 1.0 / FASTEST < 1.0 + self.gain < FASTEST

    def world(self, world: World) -> World:
        """Return the world by this clock."""
        pace = world.pace * (1.0 + self.gain) if self.paced else world.pace
        return replace(world.stamped(self), pace=pace)


def time_unit(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of times in another unit than the map states."""
    column, told = inquiry.case.log.stamp
    size = UNITS["time"].get(told, 1.0)
    for unit, other in TYPICAL["time"].items():
        ratio = other / size
        if ratio == 1.0 or inquiry.world.drive is not None:
            continue
        world = inquiry.world.stamped(lambda stamps, ratio=ratio: ratio * stamps)  # type: ignore[misc]
        times = f"the times (column {column})" if column else "the times"
        phrase = (
            f'{times} are in {unit}, not in {told or "s"}: unit = "{unit}" under [time] of the map'
        )
        yield inquiry.account_of_world("time unit", CAUSE + CHOICE, world, phrase)


def drift(inquiry: Inquiry) -> Iterator[Account]:
    """Yield clocks of another pace, fitted to one channel after another until one explains all."""
    if inquiry.world.drive is not None:
        return
    needy = sorted(inquiry.unexplained, key=lambda column: inquiry.channel(column).kind.order)
    for column in needy[:MOST_FITS]:
        for paced in (False, True) if inquiry.channel(column).kind.order else (False,):
            clock = _fitted(inquiry, column, paced=paced)
            if clock is None:
                continue
            told = list(_told(inquiry, column, clock))
            yield from told
            for account in told:
                if all(account.rests.get(each, 1.0) < WELL for each in inquiry.unexplained):
                    return  # nothing is left that needs a drift


def _fitted(inquiry: Inquiry, column: str, *, paced: bool) -> ClockFault | None:
    """Return the clock of one channel: fitted to its beginning, then to ever longer stretches, so
    that it is never off by much of a turn."""
    reading = inquiry.excerpts[column].reading
    first_s = float(reading.instants[0])
    ages, period = reading.instants - first_s, inquiry.period_s
    least = float(ages[min(LEAST_ROWS, ages.size) - 1])
    near = ClockFault(first_s, 0.0, 0.0, paced)
    clock = _grown(inquiry, column, near, max(FIRST * period, least))
    if clock is not None:
        return clock
    width = max(SCANNED * period, least)
    starts = np.arange(1, SCAN) / SCAN * period
    clocks = [replace(near, start_s=float(start)) for start in starts]
    there = inquiry.into(column, _first_rows(ages, width))
    best = min(clocks, key=lambda each: _rest(there, column, each))
    return _grown(inquiry, column, best, width)


def _first_rows(ages: Array, width: float) -> Rows:
    return picked(int(np.searchsorted(ages, width, side="right")), most=ROWS)


def _grown(inquiry: Inquiry, column: str, clock: ClockFault, width: float) -> ClockFault | None:
    """Return the clock near another, fitted to the beginning of a channel, then to all of it."""
    ages = inquiry.excerpts[column].reading.instants - clock.first_s
    while True:
        there = inquiry.into(column, _first_rows(ages, width))
        near = _nearest(there, column, clock)
        if near is None or not near.runs:
            return None
        clock = near
        if width >= ages[-1]:
            return clock if _rest(there, column, clock) < BROUGHT_WITHIN else None
        width *= GROWTH


def _nearest(there: Inquiry, column: str, clock: ClockFault) -> ClockFault | None:
    """Return the clock near another with the least residual of a channel at some rows."""

    def tried(numbers: Array) -> ClockFault:
        return replace(clock, start_s=float(numbers[0]), gain=float(numbers[1]))

    def residual(numbers: Array) -> Array:
        return there.errors(tried(numbers).world(there.world))[column]

    found = fitted(residual, (clock.start_s, clock.gain), (1e-6 * there.period_s, 1e-6))
    return None if found is None else tried(found)


def _rest(there: Inquiry, column: str, clock: ClockFault) -> float:
    """Return the remaining part of the error of a column; infinite where there is no mechanism."""
    try:
        errors = there.errors(clock.world(there.world))
    except CrankcheckError:
        return math.inf
    return there.excerpts[column].rest(errors[column])


def _told(inquiry: Inquiry, column: str, clock: ClockFault) -> Iterator[Account]:
    """Yield the accounts of a clock, and of a clock with the scene's start if that fits too."""
    thin = inquiry.thin
    excerpt = thin.excerpts[column]

    def same_start(numbers: Array) -> ClockFault:
        return ClockFault(clock.first_s, 0.0, float(numbers[0]))

    def residual(numbers: Array) -> Array:
        return thin.errors(same_start(numbers).world(thin.world), [column])[column]

    clocks = [(clock, 2)]
    if excerpt.channel.kind.order == 0:
        found = fitted(residual, [clock.gain], [1e-7])
        if found is not None and same_start(found).runs:
            clocks.append((same_start(found), 1))
    for each, numbers in clocks:
        told = _either(inquiry, column, each, CAUSE + NUMBER * numbers)
        if told is not None and inquiry.no_chance(told):
            yield told


def _either(inquiry: Inquiry, column: str, clock: ClockFault, cost: float) -> Account | None:
    """Return the account of a clock or of a driver of another pace, whichever leaves less; it names
    both where nothing distinguishes them."""
    time = inquiry.channel(column).time
    among = [c for c in inquiry.excerpts if inquiry.channel(c).time == time]
    worlds = [replace(clock, paced=paced).world(inquiry.world) for paced in (False, True)]
    plain, fast = (inquiry.account_of_world("drift", cost, each, "", among) for each in worlds)
    of_clock, of_driver = _clock_and_driver_text(inquiry, clock)
    if plain is None or (fast is not None and UNLIKE * _left(fast, plain) < _left(plain, fast)):
        words = f"{of_driver}, or {of_clock} and the rates are taken over its time"
        return fast and replace(fast, phrase=words)
    if fast is None or UNLIKE * _left(plain, fast) < _left(fast, plain):
        return replace(plain, phrase=f"{of_clock}; the rates say that the driver is right")
    return replace(plain, phrase=f"{of_clock}, or {of_driver}")


def _left(account: Account, other: Account) -> float:
    """Return the remaining part in the worst channel that either account explains."""
    return max(account.rests.get(column, 1.0) for column in (*account.rests, *other.rests))


def _clock_and_driver_text(inquiry: Inquiry, clock: ClockFault) -> tuple[str, str]:
    law, pace = inquiry.world.scene.driver.law, 1.0 + clock.gain
    slow = "slow" if clock.gain > 0.0 else "fast"
    of_clock = f"the clock of the log runs {change(1.0 / pace, 1.0).lstrip('+-')} {slow}"
    of_driver = f"the driver turns {change(pace, 1.0).lstrip('+-')} "
    of_driver += "fast" if clock.gain > 0.0 else "slow"
    if isinstance(law, ConstantSpeed):
        speed = law.speed_rad_s
        of_driver += f" ({number(speed * pace, 6)} rad/s, not {number(speed, 6)} rad/s)"
    if clock.start_s:
        of_clock += f", its first sample belongs {later(clock.start_s, inquiry.step_s)}"
    return of_clock, of_driver


FARTHEST = 0.55
"""Largest offset of a time from the even grid, in intervals."""
EVEN_STAMPS = 1e-9
"""Offset below which times count as even, in intervals."""
DECIMALS = range(10)
ON_GRID = 1e-3
"""Distance within which a number is on its decimal grid, in steps of the last decimal."""


def stamps(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of rounded or jittered times, for samples that in fact are evenly spaced."""
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
        f"{_stamps_text(inquiry)}, off by up to {duration(shaken)}: the samples are even, "
        f"{interval:.6g} s apart"
    )
    for each in (world, _aligned(inquiry, world, middle, shaken)):
        if each:
            yield inquiry.account_of_world("time stamps", CAUSE + CHOICE, each, phrase)


def _aligned(inquiry: Inquiry, world: World, middle: float, shaken: float) -> World | None:
    """Return the world of even samples, moved and stretched within the offsets of the times, as the
    line through uneven times is not quite the samples' own."""
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
        return thin.misfit(aligned(numbers), columns)

    found = fitted(residual, (0.0, 0.0), (1e-4, 1e-4))
    return None if found is None or np.max(np.abs(found)) > 1.0 else aligned(found)


def _stamps_text(inquiry: Inquiry) -> str:
    log = inquiry.case.log
    column, unit = log.stamp
    size = UNITS["time"].get(unit, 1.0)
    numbers = log.time_s / size  # less the first of them, where the map says so
    times = f"the times (column {column})" if column else "the times"
    for decimals in DECIMALS:
        steps = numbers * 10.0**decimals
        if np.max(np.abs(steps - np.round(steps))) < ON_GRID:
            return f"{times} are rounded to {decimals} decimals ({unit or 's'})"
    return f"{times} are uneven"
