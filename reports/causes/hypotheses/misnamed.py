"""Readings of something else than their column says: of another body, another kind, or against
another link."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account
from reports.causes.excerpt import EXPLAINED, Excerpt, Size, levelled
from reports.causes.hypotheses.swapped import meaning, unit_of
from reports.causes.inquiry import Inquiry
from reports.logs.channel import Channel
from reports.logs.kinds import KINDS
from reports.logs.units import UNITS


@dataclass(frozen=True)
class OtherMeaning:
    """What a column may be instead; ``any_zero`` where its zero is anywhere."""

    name: str
    cost: float
    channel: Channel
    any_zero: bool = False


def misnamed(inquiry: Inquiry) -> Iterator[Account]:
    """What else the readings of a channel may be of."""
    motions: dict[bytes, Motion] = {}
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        key = excerpt.instants.tobytes()
        if key not in motions:
            try:
                motions[key] = inquiry.world.at(excerpt.instants, _all(inquiry, excerpt.channel))
            except CrankcheckError:
                return
        for other in _meanings(inquiry, excerpt.channel):
            told = _told(inquiry, excerpt, other, motions[key])
            if told is not None:
                yield told


def _bodies(inquiry: Inquiry) -> dict[str, tuple[str, ...]]:
    """The bodies of the scene by their kind."""
    scene = inquiry.world.scene
    return {
        "link": tuple(scene.links),
        "point": tuple(scene.pins),
        "slider": tuple(scene.sliders),
        "elastic": tuple(scene.elastic),
    }


def _all(inquiry: Inquiry, channel: Channel) -> Iterator[Channel]:
    """A channel of every body."""
    for body_kind, names in _bodies(inquiry).items():
        kind = next(kind for kind in KINDS.values() if kind.body_kind == body_kind)
        yield from (replace(channel, kind=kind, of=name, relative_to="") for name in names)


def _meanings(inquiry: Inquiry, channel: Channel) -> Iterator[OtherMeaning]:
    """What a channel may be: the same of other bodies, against other links, and other kinds."""
    bodies = _bodies(inquiry)
    if channel.kind.body_kind == "link":
        yield from _relative(channel, bodies["link"])
    for kind in KINDS.values():
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
    """The same link against other ones, its sign either way and its zero free or not."""
    for link in ("", *links):
        if link in (channel.of, channel.relative_to):
            continue
        for sign in (channel.sign, -channel.sign):
            other = replace(channel, relative_to=link, sign=sign)
            cost = CAUSE + CHOICE * (1 if sign == channel.sign else 2)
            yield OtherMeaning("relative", cost, other)
            if channel.kind.turns:
                yield OtherMeaning("relative", cost + NUMBER, other, any_zero=True)


def _told(
    inquiry: Inquiry, excerpt: Excerpt, other: OtherMeaning, motion: Motion
) -> Account | None:
    """The account of a meaning."""
    own, channel = excerpt.channel, other.channel
    expected = channel.expected(motion)
    if Size.of(expected).largest <= excerpt.nothing or (
        other.name != "misnamed" and not _moves(expected)
    ):
        return None  # a number that stays is in many places
    values = excerpt.values * (own.sign * channel.sign)
    error = channel.error(values, expected)
    zero = 0.0
    if other.any_zero:
        zero, error = levelled(error, channel)
    if Size.of(error).largest > EXPLAINED * excerpt.size_beside(expected).largest:
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


def _moves(expected: Array) -> bool:
    """Whether a series does more than stay."""
    return bool(np.ptp(expected) > 1e-9 * np.max(np.abs(expected)))


def _phrase(own: Channel, other: OtherMeaning, zero: float) -> str:
    """What the column is instead."""
    channel = other.channel
    if other.name != "relative":
        return f"{{who}} {{has}} the readings of {channel.name}"
    against = f"relative to {channel.relative_to}" if channel.relative_to else "absolute"
    sign = " and {has} the other sign" if channel.sign != own.sign else ""
    off = f" and {{is}} off by {math.degrees(zero):+.4g} deg all along" if other.any_zero else ""
    return f"{{who}} {{is}} {against}{sign}{off}"
