"""A log in another frame: its plane or its points rotated, mirrored, moved or of another size."""

import cmath
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.scene.laws import ConstantSpeed
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account, change, later, number
from reports.causes.cause import ROUNDING, picked
from reports.causes.hypotheses.other_world import fitted_from_starts
from reports.causes.inquiry import FEW, Inquiry
from reports.causes.world import LogFrame
from reports.logs.channel import Channel
from reports.logs.kinds import TYPICAL, UNITS
from reports.output.numbers import listed

NEAR_UNIT = 1e-3
"""Relative distance within which a scale counts as a ratio of units."""
DOUBT = 3.0
"""Standard errors below which a fitted number is none."""
Vectors = Mapping[str, NDArray[np.complex128]]
"""Places or rates in the plane (n,), by column."""
ORDERS = ("places", "velocities", "accelerations")


def mirrored(inquiry: Inquiry) -> Iterator[Account]:
    """Yield accounts of the plane seen from behind: one axis and all angles count the other way."""
    for turn, axis in ((0.0, "y"), (math.pi, "x")):
        world = inquiry.world.framed(LogFrame(mirrored=True, turn_rad=turn))
        phrase = (
            f"the plane is seen from behind: the {axis}-axis and all angles count the other way"
        )
        told = inquiry.account_of_world("mirrored", CAUSE, world, phrase)
        if told is not None:
            changes = {c: _for_reversed_axis(inquiry.channel(c), axis) for c in told.columns}
            yield replace(told, corrections=changes)


def _for_reversed_axis(channel: Channel, axis: str) -> Mapping[str, object]:
    kind = channel.kind
    if kind.axis is not None and "xy"[kind.axis] != axis:
        return {}
    found: dict[str, object] = {"sign": -channel.sign}
    if kind.turns and axis == "x" and not channel.relative_to:
        size = UNITS[kind.dimension][channel.unit]
        found["offset"] = channel.offset - channel.sign * math.pi / size
    return found


def turned(inquiry: Inquiry) -> Iterator[Account]:
    """Yield accounts of axes rotated against the scene's, about its origin or another point."""
    for count in (1, 3):
        found = _frame(inquiry, _of(inquiry, "link", "point"), count)
        if found is None:
            continue
        phrase = (
            f"the x-axis of the log lies at {math.degrees(-found.turn_rad):.4g} deg of the scene"
        )
        if count == 3:
            phrase += f", and {_origin_text(found, ROUNDING * inquiry.world.scene.longest_m)}"
        world = inquiry.world.framed(found)
        told = inquiry.account_of_world("turned", CAUSE + NUMBER * count, world, phrase)
        if told is not None and len(told.columns) > 1:
            yield told


def _of(inquiry: Inquiry, *body_kinds: str) -> list[str]:
    """Return the columns of such bodies without an explanation free of fitted numbers; all open
    columns where these are fewer than two."""
    found = [c for c in inquiry.open if inquiry.channel(c).kind.body_kind in body_kinds]
    needy = [column for column in found if column in inquiry.unclaimed]
    return needy if len(needy) > 1 else found


def _frame(inquiry: Inquiry, columns: Sequence[str], count: int) -> LogFrame | None:
    """Return the best frame for some columns: rotated, and moved where ``count`` is 3."""
    if len(columns) < 2:
        return None
    thin, longest = inquiry.thin, inquiry.world.scene.longest_m

    def frame(numbers: Array) -> LogFrame:
        turn, x, y = (*(float(each) for each in numbers), 0.0, 0.0)[:3]
        return LogFrame(turn_rad=turn, shift_m=(x, y))

    def residual(numbers: Array) -> Array:
        return thin.misfit(thin.world.framed(frame(numbers)), columns)

    delta = (1e-6, 1e-6 * longest, 1e-6 * longest)[:count]
    best = fitted_from_starts(residual, delta)
    return None if best is None else frame(best)


def turned_points(inquiry: Inquiry) -> Iterator[Account]:
    """Yield accounts of axes of the points, or of their places or rates alone, that are rotated
    while those of the others and of angles are not; these may be moved, seen from behind, and of
    another size as well, as of a camera beside encoders."""
    kinds = {column: inquiry.channel(column).kind for column in inquiry.excerpts}
    angles = ["the angles"] * any(kind.body_kind == "link" for kind in kinds.values())
    kinds = {column: kind for column, kind in kinds.items() if kind.body_kind == "point"}
    orders = sorted({kind.order for kind in kinds.values() if kind.axis is not None})
    wrong = [column for column in _of(inquiry, "point") if kinds[column].axis is not None]
    if len(wrong) < 2:
        return
    vectors = {}
    for column, kind in kinds.items():
        channel, instants = inquiry.channel(column), inquiry.excerpts[column].instants
        point = inquiry.world.at(instants, [channel]).points[channel.of]
        vectors[column] = getattr(point, kind.field) @ np.array([1.0, 1.0j])
    sizes = range(len(orders), 0, -1)
    for some in (each for size in sizes for each in itertools.combinations(orders, size)):
        columns = [column for column in wrong if kinds[column].order in some]
        others = [*angles, *(f"the {ORDERS[order]}" for order in orders if order not in some)]
        which = f"the {listed([ORDERS[order] for order in some])} of " * (len(some) < len(orders))
        those = {c: vector for c, vector in vectors.items() if kinds[c].order in some}
        if len(columns) > 1 and others:
            yield from _frames(inquiry, columns, those, f"{which}the points", listed(others))


def _frames(
    inquiry: Inquiry, columns: Sequence[str], vectors: Vectors, these: str, others: str
) -> Iterator[Account]:
    """Yield the accounts of frames of all these vectors, fitted to some columns."""
    for count, sign in itertools.product((1, 2, 3, 4), (1.0, -1.0)):
        frame, doubt = _frame_of_points(inquiry, columns, vectors, count, sign)
        expected, turn = {}, cmath.rect(frame.size, frame.turn_rad)
        for column, vector in vectors.items():
            kind = inquiry.channel(column).kind
            seen = turn * (vector.conj() if frame.mirrored else vector)
            seen += complex(*frame.shift_m) * (kind.order == 0)
            expected[column] = {None: np.abs(seen), 0: seen.real, 1: seen.imag}[kind.axis]
        errors = {c: inquiry.excerpts[c].beside(each) for c, each in expected.items()}
        healthy = dict.fromkeys(inquiry.channel(column).of for column in inquiry.spoilt(errors))
        errors = {c: each for c, each in errors.items() if inquiry.channel(c).of not in healthy}
        those = these + f" other than {listed([*healthy])}" * bool(healthy)
        turned, sized = (abs(each) > doubt[0] for each in (frame.turn_rad, frame.size - 1.0))
        moved = np.max(np.abs(frame.shift_m)) > doubt[1]
        name, phrase = "turned", f"{those} have another frame than {others}"
        if turned:
            angle = number(math.degrees(-sign * frame.turn_rad))
            phrase = f"the x-axis of {those} lies at {angle} deg of the scene, not that of {others}"
        phrase += ", their y-axis to the other side" * frame.mirrored
        phrase += f", and {_origin_text(frame, doubt[1])}" * bool(moved)
        phrase += f", and lengths are {number(frame.size, 6)} times the scene's" * sized
        if not (turned or moved or frame.mirrored):
            if not sized or _of_units(frame.size) or these == "the points":
                continue  # all of another size is another hypothesis
            gain = f"{number(frame.size, 5)} times as much ({change(frame.size, 1.0)})"
            name, phrase = "scaled", f"{{who}} read{{s}} {gain}"
        cost = CAUSE + NUMBER * count + CHOICE * (frame.mirrored + len(healthy))
        told = inquiry.account(name, cost, errors, phrase, expected=expected)
        points = {inquiry.channel(column).of for column in told.columns} if told else set()
        if told is None or len(told.columns) < 2 or 0 < len(healthy) >= len(points):
            continue
        if count == 1 or all(inquiry.excerpts[c].told_apart(errors[c]) for c in told.columns):
            yield told if count > 1 or frame.mirrored else _or_late(inquiry, told, frame.turn_rad)


def _frame_of_points(
    inquiry: Inquiry, columns: Sequence[str], vectors: Vectors, count: int, sign: float
) -> tuple[LogFrame, tuple[float, float]]:
    """Return the frame of least squares: rotated, with 2 numbers of any size instead, with 3 moved
    as well, with 4 all three; and the doubt of its angle [rad] or size, and of its origin [m]."""
    rows, readings, thin = [], [], picked(inquiry.rows, most=FEW)
    for column in columns:
        excerpt = inquiry.thin.excerpts[column]
        kind, rms = excerpt.channel.kind, excerpt.size.rms
        z = vectors[column][thin].conj() if sign < 0.0 else vectors[column][thin]
        one = np.full(z.shape, float(kind.order == 0 and count > 2))
        basis = np.stack([z, 1j * z * (count != 2), one, 1j * one]) / rms
        rows.append(basis.imag if kind.axis else basis.real)
        readings.append((excerpt.expected + excerpt.error) / rms)
    factors, wanted = np.hstack(rows).T, np.concatenate(readings)
    numbers = np.linalg.lstsq(factors, wanted)[0]
    left = float(np.sqrt(np.mean((factors @ numbers - wanted) ** 2)))
    doubts = DOUBT * left * np.sqrt(np.diag(np.linalg.pinv(factors.T @ factors)))
    cos, sin, *moved = numbers.tolist()
    size, rounding_m = math.hypot(cos, sin), ROUNDING * inquiry.world.scene.longest_m
    frame = LogFrame(sign < 0.0, math.atan2(sin, cos), tuple(moved), 1.0 if count % 2 else size)
    return frame, (max(math.hypot(*doubts[:2]) / size, ROUNDING), max(*doubts[2:], rounding_m))


def _or_late(inquiry: Inquiry, told: Account, turn_rad: float) -> Account:
    """Return the account of rotated points, with the delay that is the same where all of them go
    round the origin evenly: the crank's pin."""
    law = inquiry.world.scene.driver.law
    if inquiry.world.drive is not None or not isinstance(law, ConstantSpeed):
        return told
    by_s = turn_rad / law.speed_rad_s
    late = inquiry.errors(inquiry.world.later(by_s), told.columns)
    if not all(inquiry.excerpts[column].explained(error) for column, error in late.items()):
        return told
    delays = {c: {"delay_s": inquiry.channel(c).delay_s + by_s} for c in told.columns}
    words = f"{told.phrase}, or {{who}} {{belongs}} {later(by_s, inquiry.step_s)}"
    return replace(told, phrase=words, corrections=delays)


def moved(inquiry: Inquiry) -> Iterator[Account]:
    """Yield accounts of an origin of the log at another point than the scene's."""
    shifts = [_shift(inquiry, axis) for axis in (0, 1)]
    for axes in ((0,), (1,), (0, 1)):
        x, y = (shifts[axis] if axis in axes else 0.0 for axis in (0, 1))
        if not all(shifts[axis] for axis in axes):
            continue
        frame = LogFrame(shift_m=(x, y))
        cost = CAUSE + NUMBER * len(axes)
        world = inquiry.world.framed(frame)
        told = inquiry.account_of_world("moved", cost, world, _origin_text(frame, 0.0))
        if told is not None and len(told.columns) > 1:
            yield told


def _shift(inquiry: Inquiry, axis: int) -> float:
    """Return the median offset [m] of the coordinates of points along an axis; 0 without any."""
    coordinates = [
        inquiry.excerpts[column].error
        for column in _of(inquiry, "point")
        if (inquiry.channel(column).kind.order, inquiry.channel(column).kind.axis) == (0, axis)
    ]
    return float(np.median([error.mean() for error in coordinates])) if coordinates else 0.0


def _origin_text(frame: LogFrame, doubt_m: float) -> str:
    origin = -complex(*frame.shift_m) * cmath.rect(1.0 / frame.size, -frame.turn_rad)
    y = -origin.imag if frame.mirrored else origin.imag
    place = ", ".join(number(each if abs(each) > doubt_m else 0.0) for each in (origin.real, y))
    return f"the origin of the log lies at ({place}) m of the scene"


def sized(inquiry: Inquiry) -> Iterator[Account]:
    """Yield the account of all lengths in one ratio to the scene's, with right angles unchanged."""
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
    if not size > 0.0 or _of_units(size):
        return
    world = inquiry.world.framed(LogFrame(size=size))
    phrase = f"every length is {number(size, 6)} times the scene's ({change(size, 1.0)})"
    told = inquiry.account_of_world("size", CAUSE + NUMBER, world, phrase, missing=0.0)
    if told is not None and len(told.columns) > 1:
        yield told


_LENGTHS = TYPICAL["length"].values()
RATIOS = [one / two for one in _LENGTHS for two in _LENGTHS]


def _of_units(size: float) -> bool:
    """True if a ratio is that of two units of length."""
    return any(abs(size / unit - 1.0) < NEAR_UNIT for unit in RATIOS if unit != 1.0)
