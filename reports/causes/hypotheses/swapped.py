"""Channels that have each other's readings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

from models.array import Array
from reports.causes.account import CAUSE, CHOICE, Account
from reports.causes.excerpt import EXPLAINED, Size
from reports.causes.inquiry import Inquiry
from reports.logs.channel import Channel
from reports.logs.kinds import Kind
from reports.logs.units import UNITS

LONGEST = 4
"""Channels that may stand in each other's place in a ring."""


def swapped(inquiry: Inquiry) -> Iterator[Account]:
    """Channels that have each other's readings, in pairs or in rings."""
    holds = {column: dict(_held(inquiry, column)) for column in inquiry.open}
    for first in holds:
        for ring in _rings(holds, (first,)):
            pairs = list(pairwise((*ring, first)))
            held = {column: holds[column][other] for column, other in pairs}
            told = inquiry.account(
                "swapped",
                CAUSE + CHOICE,
                {column: each.error for column, each in held.items()},
                _phrase(inquiry, pairs),
                corrections={c: meaning(inquiry.channel(c), held[c].channel) for c in ring},
                expected={column: inquiry.excerpts[other].expected for column, other in pairs},
            )
            if told is not None and len(told.columns) == len(ring):
                yield told


@dataclass(frozen=True)
class ColumnContent:
    """What a column holds: its channel as it is in truth, and the error that is left then."""

    channel: Channel
    error: Array


def _phrase(inquiry: Inquiry, pairs: list[tuple[str, str]]) -> str:
    """Which channel has which readings."""
    if len(pairs) == 2:
        return "{who} have each other's readings"
    rings = ", ".join(f"{inquiry.channel(other).name} in {column}" for column, other in pairs)
    return f"{{who}} have each other's readings: {rings}"


def meaning(channel: Channel, instead: Channel) -> dict[str, object]:
    """What to write in the map of a channel that is another one: what differs."""
    names = ("of", "unit", "sign", "offset", "relative_to", "on", "wrapped")
    found: dict[str, object] = {
        name: getattr(instead, name)
        for name in names
        if getattr(instead, name) != getattr(channel, name)
    }
    if instead.kind != channel.kind:
        found["kind"] = instead.kind.name
    return found


def unit_of(channel: Channel, kind: Kind) -> str | None:
    """The unit of another kind that reads the same numbers alike; None where it has none."""
    if kind.dimension == channel.kind.dimension:
        return channel.unit
    size = UNITS[channel.kind.dimension][channel.unit]
    same = (unit for unit, each in UNITS[kind.dimension].items() if each == size)
    return next(same, None)


def _rings(
    holds: Mapping[str, Mapping[str, ColumnContent]], path: tuple[str, ...]
) -> Iterator[tuple[str, ...]]:
    """The rings of columns each of which holds what the next one should, the least column first."""
    for column in holds[path[-1]]:
        if column == path[0]:
            yield path
        elif column > path[0] and column not in path and len(path) < LONGEST:
            yield from _rings(holds, (*path, column))


def _held(inquiry: Inquiry, column: str) -> Iterator[tuple[str, ColumnContent]]:
    """The other open columns whose readings a column holds."""
    own = inquiry.excerpts[column]
    for other in inquiry.open:
        excerpt = inquiry.excerpts[other]
        if other == column:
            continue
        enough = EXPLAINED * own.size_beside(excerpt.expected).largest
        if excerpt.nought:
            enough = min(enough, excerpt.limit)
        for channel, values in _read_as(own.values, own.channel, excerpt.channel):
            error = channel.error(values, excerpt.expected)
            if Size.of(error).largest <= enough:
                yield other, ColumnContent(channel, error)
                break


def _read_as(values: Array, own: Channel, other: Channel) -> Iterator[tuple[Channel, Array]]:
    """A column as another channel, with its readings as they are and with its numbers as the map
    reads those of the other."""
    instead = replace(
        other,
        column=own.column,
        wrapped=own.wrapped or other.wrapped,
        delay_s=own.delay_s,
        time=own.time,
    )
    unit = unit_of(own, other.kind)
    if unit is not None:
        yield replace(instead, unit=unit, sign=own.sign, offset=own.offset), values
    size, others = (UNITS[channel.kind.dimension][channel.unit] for channel in (own, other))
    if (size, own.sign, own.offset) != (others, other.sign, other.offset):
        numbers = own.sign * values / size - own.offset
        yield instead, other.sign * (numbers + other.offset) * others
