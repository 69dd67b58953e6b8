"""A log that has the whole plane another way: seen from behind, turned, moved, or scaled."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.array import Array
from reports.causes.account import CAUSE, NUMBER, Account
from reports.causes.fit import fitted
from reports.causes.inquiry import Inquiry
from reports.causes.words import change, number
from reports.causes.world import LogFrame
from reports.logs.channel import Channel
from reports.logs.units import UNITS

QUARTERS = (0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)
"""Turns of the plane that a fit starts from."""
NEAR_UNIT = 1e-3
"""A scale that is as near to a ratio of units is one."""


def mirrored(inquiry: Inquiry) -> Iterator[Account]:
    """The plane seen from behind, so that one axis and all angles count the other way."""
    for turn, axis in ((0.0, "y"), (math.pi, "x")):
        world = inquiry.world.framed(LogFrame(mirrored=True, turn_rad=turn))
        phrase = (
            f"the plane is seen from behind: the {axis}-axis and all angles count the other way"
        )
        told = inquiry.account_of_world("mirrored", CAUSE, world, phrase)
        if told is not None:
            changes = {c: _turned_round(inquiry.channel(c), axis) for c in told.columns}
            yield replace(told, corrections=changes)


def _turned_round(channel: Channel, axis: str) -> Mapping[str, object]:
    """What to write in the map of a channel where an axis is turned round."""
    kind = channel.kind
    if kind.axis is not None and "xy"[kind.axis] != axis:
        return {}
    found: dict[str, object] = {"sign": -channel.sign}
    if kind.turns and axis == "x" and not channel.relative_to:
        size = UNITS[kind.dimension][channel.unit]
        found["offset"] = channel.offset - channel.sign * math.pi / size
    return found


def turned(inquiry: Inquiry) -> Iterator[Account]:
    """The axes of the log turned against those of the scene, about its origin or another point."""
    for count in (1, 3):
        found = _frame(inquiry, _of(inquiry, "link", "point"), count)
        if found is None:
            continue
        phrase = (
            f"the x-axis of the log lies at {math.degrees(-found.turn_rad):.4g} deg of the scene"
        )
        if count == 3:
            phrase += f", and {_origin(found)}"
        world = inquiry.world.framed(found)
        told = inquiry.account_of_world("turned", CAUSE + NUMBER * count, world, phrase)
        if told is not None and len(told.columns) > 1:
            yield told


def _of(inquiry: Inquiry, *body_kinds: str) -> list[str]:
    """The columns that are to be explained, and measure such bodies: those that nothing without a
    number explains, but where these are not two, all."""
    found = [c for c in inquiry.open if inquiry.channel(c).kind.body_kind in body_kinds]
    needy = [column for column in found if column in inquiry.unclaimed]
    return needy if len(needy) > 1 else found


def _frame(inquiry: Inquiry, columns: Sequence[str], count: int) -> LogFrame | None:
    """The frame that tells some columns best: turned, and moved where ``count`` is 3."""
    if len(columns) < 2:
        return None
    thin, longest = inquiry.thin, inquiry.world.scene.longest_m
    sizes = {column: thin.excerpts[column].size.rms for column in columns}

    def frame(numbers: Array) -> LogFrame:
        turn, x, y = (*(float(each) for each in numbers), 0.0, 0.0)[:3]
        return LogFrame(turn_rad=turn, shift_m=(x, y))

    def residual(numbers: Array) -> Array:
        errors = thin.errors(thin.world.framed(frame(numbers)), columns)
        return np.concatenate([errors[column] / sizes[column] for column in columns])

    delta = (1e-6, 1e-6 * longest, 1e-6 * longest)[:count]
    starts = ((turn, 0.0, 0.0)[:count] for turn in QUARTERS)
    tried = (fitted(residual, start, delta) for start in starts)
    found = [each for each in tried if each is not None]
    best = min(found, key=lambda each: float(np.sum(residual(each) ** 2)), default=None)
    return None if best is None else frame(best)


def moved(inquiry: Inquiry) -> Iterator[Account]:
    """The origin of the log at another point than the scene's."""
    shifts = [_shift(inquiry, axis) for axis in (0, 1)]
    for axes in ((0,), (1,), (0, 1)):
        x, y = (shifts[axis] if axis in axes else 0.0 for axis in (0, 1))
        if not all(shifts[axis] for axis in axes):
            continue
        frame = LogFrame(shift_m=(x, y))
        cost = CAUSE + NUMBER * len(axes)
        world = inquiry.world.framed(frame)
        told = inquiry.account_of_world("moved", cost, world, _origin(frame))
        if told is not None and len(told.columns) > 1:
            yield told


def _shift(inquiry: Inquiry, axis: int) -> float:
    """The median offset [m] of the coordinates of points along an axis; 0 where there is none."""
    coordinates = [
        inquiry.excerpts[column].error
        for column in _of(inquiry, "point")
        if (inquiry.channel(column).kind.order, inquiry.channel(column).kind.axis) == (0, axis)
    ]
    return float(np.median([error.mean() for error in coordinates])) if coordinates else 0.0


def _origin(frame: LogFrame) -> str:
    """Where the origin of the log is."""
    cos, sin = math.cos(frame.turn_rad), math.sin(frame.turn_rad)
    x, y = frame.shift_m
    place = ", ".join(number(each) for each in (-x * cos - y * sin, x * sin - y * cos))
    return f"the origin of the log lies at ({place}) m of the scene"


def sized(inquiry: Inquiry) -> Iterator[Account]:
    """All lengths in one ratio to the scene's, while the angles are right."""
    ratios = []
    for column in _of(inquiry, "point", "slider"):
        excerpt = inquiry.excerpts[column]
        expected, values = excerpt.expected, excerpt.values
        fine = np.isfinite(expected) & np.isfinite(values)
        if np.any(expected[fine]):
            ratios.append(float(values[fine] @ expected[fine] / np.sum(expected[fine] ** 2)))
    if len(ratios) < 2:
        return
    size = float(np.median(ratios))
    lengths = UNITS["length"].values()
    units = [one / other for one in lengths for other in lengths]
    if not size > 0.0 or any(abs(size / unit - 1.0) < NEAR_UNIT for unit in units if unit != 1.0):
        return
    world = inquiry.world.framed(LogFrame(size=size))
    phrase = f"every length is {number(size, 6)} times the scene's ({change(size, 1.0)})"
    told = inquiry.account_of_world("size", CAUSE + NUMBER, world, phrase, missing=0.0)
    if told is not None and len(told.columns) > 1:
        yield told
