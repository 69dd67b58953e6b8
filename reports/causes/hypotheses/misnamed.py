"""Readings of another quantity than stated: another body or kind, or relative to another link."""

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account
from reports.causes.cause import EXPLAINED, CauseSize, Excerpt, levelled
from reports.causes.inquiry import Inquiry
from reports.logs.channel import Channel
from reports.logs.kinds import KINDS, UNITS, Kind


@dataclass(frozen=True)
class OtherMeaning:
    """Other meaning of a column; ``any_zero`` where its zero is anywhere."""

    name: str
    cost: float
    channel: Channel
    any_zero: bool = False


def misnamed(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of other meanings of the readings of a channel."""
    motions: dict[bytes, Motion] = {}
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        key = excerpt.instants.tobytes()
        if key not in motions:
            try:
                motions[key] = inquiry.world.at(
                    excerpt.instants, _of_all_bodies(inquiry, excerpt.channel)
                )
            except CrankcheckError:
                return
        for other in _meanings(inquiry, excerpt.channel):
            yield _account_of_meaning(inquiry, excerpt, other, motions[key])


def _bodies_by_kind(inquiry: Inquiry) -> dict[str, tuple[str, ...]]:
    scene = inquiry.world.scene
    return {
        "link": tuple(scene.links),
        "point": tuple(scene.pins),
        "slider": tuple(scene.sliders),
        "elastic": tuple(scene.elastic),
    }


def _of_all_bodies(inquiry: Inquiry, channel: Channel) -> Iterator[Channel]:
    for body_kind, names in _bodies_by_kind(inquiry).items():
        kind = next(kind for kind in KINDS.values() if kind.body_kind == body_kind)
        yield from (replace(channel, kind=kind, of=name, relative_to="") for name in names)


def _meanings(inquiry: Inquiry, channel: Channel) -> Iterator[OtherMeaning]:
    """Yield the meanings of a channel: other bodies, relative to other links, and other kinds."""
    bodies = _bodies_by_kind(inquiry)
    if channel.kind.body_kind == "link":
        yield from _relative(channel, bodies["link"])
    for kind in (each for each in KINDS.values() if each == channel.kind or not each.is_size):
        same = kind == channel.kind
        for body in bodies[kind.body_kind]:
            if same and body == channel.of:
                continue
            unit = unit_of(channel, kind)
            if unit is None:
                continue
            cost = CAUSE + CHOICE * (1 if same else 2)
            other = replace(channel, of=body, kind=kind, relative_to="", unit=unit)
            yield OtherMeaning("misnamed" if same else "kind", cost, other)


def _relative(channel: Channel, links: tuple[str, ...]) -> Iterator[OtherMeaning]:
    """Yield the same link relative to others, with either sign, and its zero free or not."""
    for link in ("", *links):
        if link in (channel.of, channel.relative_to):
            continue
        for sign in (channel.sign, -channel.sign):
            other = replace(channel, relative_to=link, sign=sign)
            cost = CAUSE + CHOICE * (1 if sign == channel.sign else 2)
            yield OtherMeaning("relative", cost, other)
            if channel.kind.turns:
                yield OtherMeaning("relative", cost + NUMBER, other, any_zero=True)


def _account_of_meaning(
    inquiry: Inquiry, excerpt: Excerpt, other: OtherMeaning, motion: Motion
) -> Account | None:
    own, channel = excerpt.channel, other.channel
    expected = channel.expected(motion)
    moves = np.ptp(expected) > 1e-9 * np.max(np.abs(expected))
    if CauseSize.of(expected).largest <= excerpt.nothing or (
        other.name != "misnamed" and not moves
    ):
        return None  # a number that stays is in many places
    values = excerpt.values * (own.sign * channel.sign)
    error = channel.error(values, expected)
    zero = 0.0
    if other.any_zero:
        zero, error = levelled(error, channel)
    if CauseSize.of(error).largest > EXPLAINED * excerpt.size_beside(expected).largest:
        return None
    size = UNITS[channel.kind.dimension][channel.unit]
    instead = replace(channel, offset=own.offset - channel.sign * zero / size)
    phrase = _phrase(own, other, zero)
    errors = {own.column: error}
    return inquiry.account(
        other.name,
        other.cost,
        errors,
        phrase,
        corrections={own.column: meaning(own, instead)},
        expected={own.column: expected},
    )


def _phrase(own: Channel, other: OtherMeaning, zero: float) -> str:
    channel = other.channel
    if other.name != "relative":
        return f"{{who}} {{has}} the readings of {channel.name}"
    against = f"relative to {channel.relative_to}" if channel.relative_to else "absolute"
    sign = " and {has} the other sign" if channel.sign != own.sign else ""
    off = f" and {{is}} off by {math.degrees(zero):+.4g} deg all along" if other.any_zero else ""
    return f"{{who}} {{is}} {against}{sign}{off}"


LONGEST = 4
"""Largest number of channels in a ring that have each other's readings."""


def swapped(inquiry: Inquiry) -> Iterator[Account]:
    """Yield accounts of channels that have each other's readings, in pairs or in rings."""
    holds = {column: dict(_held(inquiry, column)) for column in inquiry.open}
    for first in holds:
        for ring in _rings(holds, (first,)):
            pairs = list(pairwise((*ring, first)))
            held = {column: holds[column][other] for column, other in pairs}
            each = ", ".join(f"{inquiry.channel(other).name} in {c}" for c, other in pairs)
            told = inquiry.account(
                "swapped",
                CAUSE + CHOICE,
                {column: error for column, (_, error) in held.items()},
                "{who} have each other's readings" + (f": {each}" if len(pairs) > 2 else ""),
                corrections={c: meaning(inquiry.channel(c), held[c][0]) for c in ring},
                expected={column: inquiry.excerpts[other].expected for column, other in pairs},
            )
            if told is not None and len(told.columns) == len(ring):
                yield told


def meaning(channel: Channel, instead: Channel) -> dict[str, object]:
    """Return the map entries by which another channel differs from this one."""
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
    """Return the unit of another kind that reads the same numbers alike; None where it has none."""
    if kind.dimension == channel.kind.dimension:
        return channel.unit
    size = UNITS[channel.kind.dimension][channel.unit]
    same = (unit for unit, each in UNITS[kind.dimension].items() if each == size)
    return next(same, None)


def _rings(
    holds: Mapping[str, Collection[str]], path: tuple[str, ...]
) -> Iterator[tuple[str, ...]]:
    """Yield the rings of columns, each with the readings of the next; the least comes first."""
    for column in holds[path[-1]]:
        if column == path[0]:
            yield path
        elif column > path[0] and column not in path and len(path) < LONGEST:
            yield from _rings(holds, (*path, column))


def _held(inquiry: Inquiry, column: str) -> Iterator[tuple[str, tuple[Channel, Array]]]:
    """Yield the other open columns whose readings a column holds, each with the actual channel of
    the column and the remaining error."""
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
            if CauseSize.of(error).largest <= enough:
                yield other, (channel, error)
                break


def _read_as(values: Array, own: Channel, other: Channel) -> Iterator[tuple[Channel, Array]]:
    """Yield a column as another channel: as read, and with its numbers read as the other's."""
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
