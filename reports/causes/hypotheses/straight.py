"""Readings that are a straight line of the reference: wrong unit, sign, zero or gain."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account, change, later, number
from reports.causes.cause import BROUGHT_WITHIN, CauseSize, Excerpt, levelled, within_half_a_turn
from reports.causes.inquiry import Inquiry
from reports.logs.channel import Channel
from reports.logs.kinds import TYPICAL, UNITS, si
from reports.output.numbers import listed

TURNS = (0, 1, -1, 2, -2)
"""Whole turns from which a scaled angle may count."""
LEAST_GAIN = 1e-3
"""Least gain of a signal; below it the gain is noise."""
STRAIGHT = 1e-3
"""A signal within this part of an error from a straight line is even."""
TIGHT = 0.02
"""Part that a gain and a zero may leave: any curve of another height leaves nearly as little."""
NO_GAIN = 1e-5
"""A gain nearer to 1 shows in no reading."""


@dataclass(frozen=True)
class StraightLineFault:
    """Readings as ``gain`` times the reference, plus ``zero``; ``unit`` is the other unit behind
    the gain, and ``cost`` the cost of the hypothesis."""

    name: str
    cost: float
    gain: float
    shifted: bool = False
    unit: str = ""


def straight(inquiry: Inquiry) -> Iterator[Account]:
    """Yield each line that explains a channel: by sign or unit, by zero, by gain, or by two."""
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        known = list(_known(excerpt.channel))
        zero = [line for line in known if line.name == "offset"]
        if excerpt.nought:
            yield from _accounts(inquiry, excerpt, zero)
        elif np.ptp(excerpt.expected) <= excerpt.nothing:
            # A channel that stays: a zero explains whatever is there, and is the last thing to be.
            plain = [line for line in known if not line.shifted] + _gain_of_others(inquiry, excerpt)
            yield from list(_accounts(inquiry, excerpt, plain)) or _accounts(inquiry, excerpt, zero)
        else:
            yield from _accounts(inquiry, excerpt, [*known, *_fitted(excerpt)])


def _accounts(
    inquiry: Inquiry, excerpt: Excerpt, lines: Iterable[StraightLineFault]
) -> Iterator[Account]:
    yield from filter(None, (_told(inquiry, excerpt, line) for line in lines))


def _known(channel: Channel) -> Iterator[StraightLineFault]:
    """Yield the lines whose gain is a sign or a ratio of units."""
    yield StraightLineFault("sign", CAUSE, -1.0)
    yield StraightLineFault("offset", CAUSE + NUMBER, 1.0, shifted=True)
    yield StraightLineFault("sign", CAUSE + CHOICE + NUMBER, -1.0, shifted=True)
    units = UNITS[channel.kind.dimension]
    for unit, size in TYPICAL[channel.kind.dimension].items():
        gain = units[channel.unit] / size
        if gain != 1.0:
            yield StraightLineFault("unit", CAUSE + CHOICE, gain, unit=unit)
            yield StraightLineFault("unit", CAUSE + 2 * CHOICE, -gain, unit=unit)
            yield StraightLineFault("unit", CAUSE + CHOICE + NUMBER, gain, shifted=True, unit=unit)


def _fitted(excerpt: Excerpt) -> Iterator[StraightLineFault]:
    """Yield the lines whose gain is fitted, with a zero and without."""
    even = CHOICE if _steady_rate(excerpt) else 0.0  # more likely the driver has another speed
    for gain, shifted in _gains(excerpt):
        if abs(gain) > LEAST_GAIN and abs(gain - 1.0) > NO_GAIN:
            cost = CAUSE + NUMBER * (2 if shifted else 1) + even
            yield StraightLineFault("scaled", cost, gain, shifted=shifted)


def _gain_of_others(inquiry: Inquiry, excerpt: Excerpt) -> list[StraightLineFault]:
    """Return the gain of another channel of the same dimension that one that stays has too."""
    gain = float(excerpt.values.mean() / excerpt.expected.mean())
    for other in (inquiry.excerpts[column] for column in inquiry.open):
        if other.channel.kind.dimension == excerpt.channel.kind.dimension:
            for line in _fitted(other):
                alike = abs(gain - line.gain) < TIGHT * abs(line.gain - 1.0)
                if alike and not line.shifted and other is not excerpt:
                    return [line] if _told(inquiry, other, line) else []
    return []


def _gains(excerpt: Excerpt) -> Iterable[tuple[float, bool]]:
    """Return the gain of least squares, and the gain beside a free zero."""
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


def _told(inquiry: Inquiry, excerpt: Excerpt, line: StraightLineFault) -> Account | None:
    """Return the account of a line, its zero fitted where it has one."""
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


def _correction(line: StraightLineFault, channel: Channel, zero: float) -> dict[str, object]:
    """Return the correcting map entries: a reading in SI is ``sign * (number + offset) * unit``."""
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
    line: StraightLineFault, channel: Channel, zero: float, inquiry: Inquiry, excerpt: Excerpt
) -> str:
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
    """Return the steady rate of a reference, for which a zero and a delay are the same, else 0."""
    fine = np.isfinite(excerpt.expected)
    times, signal = excerpt.instants[fine], excerpt.expected[fine]
    times, signal = times - times.mean(), signal - signal.mean()
    rate = float(times @ signal / (times @ times)) if np.any(times) else 0.0
    rest = float(np.max(np.abs(signal - rate * times), initial=0.0))
    return rate if rest < STRAIGHT * excerpt.size.largest else 0.0


def _amount(value: float, unit: str, channel: Channel) -> str:
    dimension = channel.kind.dimension
    shown = f"{value / UNITS[dimension][unit]:+.4g} {unit}"
    return shown if unit == si(dimension) else f"{shown} ({value:+.4g} {si(dimension)})"


EDGES = (-math.tau, -math.pi, 0.0)
"""Begin of the turn in which wrapped readings lie [rad]."""
EDGE = 1e-2
"""Distance from an edge within which noise may take readings over it [rad]."""
MOST_JUMPS = 12
"""Number of turns that may be lost; more are due to the way the angle is measured."""
SHOWN = 3


def turns(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of angles off by whole or half turns, or without their sign."""
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        if excerpt.channel.kind.turns:
            try:
                values, error = inquiry.whole(column)
            except CrankcheckError:
                continue
            yield _whole(inquiry, column, values, error)
            yield _half(inquiry, column, values, error)
        yield _unsigned_account(inquiry, column)


def _whole(inquiry: Inquiry, column: str, values: Array, error: Array) -> Account | None:
    """Return the account of whole turns: an angle that is wrapped, or lost some."""
    if inquiry.channel(column).wrapped:
        return None
    turn = np.round(error / math.tau)
    jumps = np.flatnonzero(np.diff(turn)) + 1
    if not jumps.size:
        return None
    left = error - math.tau * turn
    if _wrapped(values, values - left):
        phrase = "{who} {is} wrapped into one turn"
        return _told_of_turns(inquiry, column, left, ("wrapped", CAUSE, phrase), {"wrapped": True})
    if jumps.size > MOST_JUMPS:
        return None
    times = inquiry.case.log.time_s
    each = [
        f"{int(turn[place] - turn[place - 1]):+d} at sample {place} (t = {times[place]:.6g} s)"
        for place in jumps
    ]
    more = [f"{len(each) - SHOWN} more"] if len(each) > SHOWN else []
    phrase = f"{{who}} lose{{s}} whole turns: {listed([*each[:SHOWN], *more])}"
    cost = CAUSE + CHOICE * min(jumps.size, 4)
    return _told_of_turns(inquiry, column, left, ("lost turn", cost, phrase), {})


def _wrapped(values: Array, angle: Array) -> bool:
    """True if readings are an angle, known up to whole turns, within one turn of a usual beginning;
    noise may take some over its edges."""
    for edge in EDGES:
        from_edge = np.remainder(angle - edge, math.tau)
        inside = np.minimum(from_edge, math.tau - from_edge) > EDGE
        if np.all(np.abs(edge + from_edge - values)[inside] < math.pi) and inside.any():
            return True
    return False


def _folded(values: Array) -> bool:
    """True if readings lie in half a turn that begins as an arc tangent's does."""
    least, most = float(np.min(values)), float(np.max(values))
    begins = (-0.5 * math.pi, 0.0)
    return any(each - EDGE < least and most < each + math.pi + EDGE for each in begins)


def _half(inquiry: Inquiry, column: str, values: Array, error: Array) -> Account | None:
    """Return the account of an angle known up to half turns, as from an arc tangent."""
    half = np.round(error / math.pi)
    if not np.any(half % 2.0) or not _folded(values):
        return None
    phrase = "{who} {is} folded into half a turn, as an arc tangent of one number does"
    left = error - math.pi * half
    return _told_of_turns(inquiry, column, left, ("half turns", CAUSE + CHOICE, phrase), {})


def _told_of_turns(
    inquiry: Inquiry,
    column: str,
    left: Array,
    said: tuple[str, float, str],
    correction: dict[str, object],
) -> Account | None:
    """Return the account, by name, cost and phrase, with this residual over the whole log."""
    excerpt = inquiry.excerpts[column]
    rest = float(np.max(np.abs(left))) / math.tau
    if rest > BROUGHT_WITHIN or (rest > 0.1 and np.max(np.abs(left)) > excerpt.limit):
        return None
    name, cost, phrase = said
    over = float(np.max(np.abs(left))) / CauseSize.of(excerpt.error).largest
    return Account(name, cost, {column: rest}, {column: over}, phrase, {column: correction})


def _unsigned_account(inquiry: Inquiry, column: str) -> Account | None:
    excerpt = inquiry.excerpts[column]
    expected = excerpt.expected
    if excerpt.channel.kind.turns:
        expected = within_half_a_turn(expected)
    if np.any(excerpt.values < 0.0) or not np.any(expected < 0.0):
        return None
    errors = {column: excerpt.values - np.abs(expected)}
    phrase = "{who} {has} no sign: {is} the magnitude"
    return inquiry.account("unsigned", CAUSE + CHOICE, errors, phrase)
