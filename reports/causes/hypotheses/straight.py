"""Readings that are a straight line of what they should be: wrong unit, sign, zero or gain."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from reports.causes.account import CAUSE, CHOICE, NUMBER, Account
from reports.causes.excerpt import Excerpt, levelled
from reports.causes.inquiry import Inquiry
from reports.causes.words import change, later, number
from reports.logs.channel import Channel
from reports.logs.units import UNITS, si

TURNS = (0, 1, -1, 2, -2)
"""Whole turns that a scaled angle may count from elsewhere."""
LEAST_GAIN = 1e-3
"""A signal that is weaker is none, and its gain is of noise."""
STRAIGHT = 1e-3
"""A signal that leaves a straight line by less than this part of an error is even."""
TIGHT = 0.02
"""What a gain and a zero may leave together: much the same leaves any curve of another height."""
NO_GAIN = 1e-5
"""A gain that is nearer to 1 would be seen in no reading."""


@dataclass(frozen=True)
class StraightLine:
    """Readings as ``gain`` times what is expected, plus ``zero``; ``unit`` is another one of which
    the gain is made, and ``cost`` what it takes to believe."""

    name: str
    cost: float
    gain: float
    shifted: bool = False
    unit: str = ""


def straight(inquiry: Inquiry) -> Iterator[Account]:
    """Each line that explains a channel: by a sign or a unit, by a zero, by a gain, or by two."""
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        if excerpt.nought:
            yield from _each(
                inquiry, excerpt, [StraightLine("offset", CAUSE + NUMBER, 1.0, shifted=True)]
            )
        elif np.ptp(excerpt.expected) <= excerpt.nothing:
            # A channel that stays: a zero explains whatever is there, and is the last thing to be.
            plain = [line for line in _known(excerpt.channel) if not line.shifted]
            told = list(_each(inquiry, excerpt, plain))
            zero = [line for line in _known(excerpt.channel) if line.name == "offset"]
            yield from told or _each(inquiry, excerpt, zero)
        else:
            yield from _each(inquiry, excerpt, [*_known(excerpt.channel), *_fitted(excerpt)])


def _each(inquiry: Inquiry, excerpt: Excerpt, lines: Iterable[StraightLine]) -> Iterator[Account]:
    """The accounts of those lines that explain a channel."""
    for line in lines:
        told = _told(inquiry, excerpt, line)
        if told is not None:
            yield told


def _known(channel: Channel) -> Iterator[StraightLine]:
    """The lines whose gain is a sign or a ratio of units."""
    yield StraightLine("sign", CAUSE, -1.0)
    yield StraightLine("offset", CAUSE + NUMBER, 1.0, shifted=True)
    yield StraightLine("sign", CAUSE + CHOICE + NUMBER, -1.0, shifted=True)
    units = UNITS[channel.kind.dimension]
    for unit, size in units.items():
        gain = units[channel.unit] / size
        if gain != 1.0:
            yield StraightLine("unit", CAUSE + CHOICE, gain, unit=unit)
            yield StraightLine("unit", CAUSE + 2 * CHOICE, -gain, unit=unit)
            yield StraightLine("unit", CAUSE + CHOICE + NUMBER, gain, shifted=True, unit=unit)


def _fitted(excerpt: Excerpt) -> Iterator[StraightLine]:
    """The lines whose gain is fitted, with a zero and without."""
    even = CHOICE if _steady_rate(excerpt) else 0.0  # more likely the driver has another speed
    for gain, shifted in _gains(excerpt):
        if abs(gain) > LEAST_GAIN and abs(gain - 1.0) > NO_GAIN:
            cost = CAUSE + NUMBER * (2 if shifted else 1) + even
            yield StraightLine("scaled", cost, gain, shifted=shifted)


def _gains(excerpt: Excerpt) -> Iterable[tuple[float, bool]]:
    """The gain of least squares, and that beside a zero that is free."""
    expected, values = excerpt.expected, excerpt.values
    if excerpt.channel.wrapped:  # the nearest turn: as good as the error is less than half of one
        values = expected + excerpt.error
    fine = np.isfinite(expected) & np.isfinite(values)
    expected, values = expected[fine], values[fine]
    if expected.size < 3 or not np.any(expected):
        return []
    turns = TURNS if excerpt.channel.kind.turns and not excerpt.channel.wrapped else (0,)
    through = []
    for turn in turns:
        signal = expected + math.tau * turn
        gain = float(values @ signal / (signal @ signal))
        through.append((float(np.sum((values - gain * signal) ** 2)), gain))
    signal = expected - expected.mean()
    free = float(values @ signal / (signal @ signal)) if np.any(signal) else 0.0
    return [(min(through)[1], False), (free, True)]


def _told(inquiry: Inquiry, excerpt: Excerpt, line: StraightLine) -> Account | None:
    """The account of a line, its zero fitted where it has one."""
    channel = excerpt.channel
    values = excerpt.values
    if line.name == "scaled" and channel.wrapped:
        values = excerpt.expected + excerpt.error
    error = excerpt.beside(excerpt.expected, values / line.gain)
    zero = 0.0
    if line.shifted:
        zero, error = levelled(error, channel)
    errors = {channel.column: error}
    if line.name == "scaled" and line.shifted and excerpt.rest(error) > TIGHT:
        return None
    phrase = _phrase(line, channel, zero, inquiry, excerpt)
    corrections = {channel.column: _correction(line, channel, zero)}
    return inquiry.account(line.name, line.cost, errors, phrase, corrections=corrections)


def _correction(line: StraightLine, channel: Channel, zero: float) -> dict[str, object]:
    """What mends it in the map: a reading in SI is ``sign * (number + offset) * unit``."""
    if line.name == "scaled":
        return {}
    unit = line.unit or channel.unit
    sign = channel.sign if line.gain > 0.0 else -channel.sign
    found: dict[str, object] = {}
    if unit != channel.unit:
        found["unit"] = unit
    if sign != channel.sign:
        found["sign"] = sign
    if line.shifted:
        size = UNITS[channel.kind.dimension][unit]
        found["offset"] = channel.offset - sign * zero / size
    return found


def _phrase(
    line: StraightLine, channel: Channel, zero: float, inquiry: Inquiry, excerpt: Excerpt
) -> str:
    """What is wrong, in words."""
    unit = line.unit or channel.unit
    said = {
        "unit": f"{{is}} in {unit}, not in {channel.unit}",
        "sign": "",
        "offset": "",
        "scaled": f"read{{s}} {number(line.gain, 5)} times as much ({change(line.gain, 1.0)})",
    }[line.name]
    parts = [said] if said else []
    if line.gain < 0.0 and line.name != "scaled":
        parts.append("{has} the wrong sign")
    if line.shifted:
        off = zero * line.gain if line.name == "scaled" else zero
        parts.append(f"{{is}} off by {_amount(off, unit, channel)} all along")
    told = "{who} " + " and ".join(parts)
    even = line.name == "offset" and channel.kind.turns
    rate = _steady_rate(excerpt) if even else 0.0
    return told + (f", as if it belonged {later(zero / rate, inquiry.step_s)}" if rate else "")


def _steady_rate(excerpt: Excerpt) -> float:
    """The rate at which the expectation goes on evenly, of which no zero can be told from a delay;
    0 where it does not."""
    fine = np.isfinite(excerpt.expected)
    times, signal = excerpt.instants[fine], excerpt.expected[fine]
    times, signal = times - times.mean(), signal - signal.mean()
    rate = float(times @ signal / (times @ times)) if np.any(times) else 0.0
    rest = float(np.max(np.abs(signal - rate * times), initial=0.0))
    return rate if rest < STRAIGHT * excerpt.size.largest else 0.0


def _amount(value: float, unit: str, channel: Channel) -> str:
    """A number in the unit of the log, and in SI where that is another one."""
    dimension = channel.kind.dimension
    shown = f"{value / UNITS[dimension][unit]:+.4g} {unit}"
    return shown if unit == si(dimension) else f"{shown} ({value:+.4g} {si(dimension)})"
