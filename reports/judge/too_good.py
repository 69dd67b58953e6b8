"""Which bodies are nearer to the reference than an engine can come: they were taken from it.

An engine whose places are integrated is off by a multiple of step^order at every body that does
not move evenly with the driver (`reports.compare.uneven`): in its places, total and geometric, in
its rates, in the widest gap of its joints, and in the worst of its forces. On every shipped scene
and 150 random ones, at 45 to 5760 steps a turn, the least was 9e-4 of that times how unevenly the
body moves. What was taken from the reference, however it was rounded afterwards, is off by nothing,
or by no more than the crank is.

An engine that solves its joints in each step may have places that are exact. Its rates are numbers
of their own nevertheless: over a whole run some of them are rounded in another way. Its
forces go with its accelerations: where these are off, so are those, by at least 0.1 of what all
masses make of that, at 90 to 720 steps a turn on every shipped scene.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

from reports.compare.errors import Error, Errors, largest
from reports.quantities import named
from reports.quantities.quantity import BodyKind
from sim.engine import Placing

LEAST = 5e-5
"""A nineteenth of the least multiple that was seen."""
PLACES, RATES = named("place"), named("derived")
FORCES = tuple(name for name in named("force") if name != "moment")
"""A block that is pinned at its point bears no moment, in an engine as in the reference."""
WHOLE = ("total", "geometric")
"""Errors of the run, but for its start and change points, where an engine may have hardly moved."""
ROUNDING = sys.float_info.epsilon
"""A rate that is off by this share of its scale, at most, is the next number or the same."""

BENT = ("deflection", "segments")
SAME_BEND = 1e-11
"""Of the largest deflection: rounding; the nearest engine was off by 5e-7."""
STRAIGHT = 1e8
"""The longest link over the largest deflection, of links that do not bend for anybody."""
UNROUNDED = 1e-9
"""An acceleration that is off by more is so by more than rounding."""


def too_good(errors: Errors, placing: Placing, order: int) -> list[Error]:
    """The errors that are too small for their body and step, the smallest first."""
    found = _nearer(errors, order) if placing == "integrated" else _the_same(errors)
    return sorted([*found, *_bent_the_same(errors)], key=lambda row: row.pure)


def highest_order(errors: Errors, order: int) -> int:
    """Of the step, what an engine of some ``order`` may be off by."""
    return max(order, errors.of_motion.least_order)


def _nearer(errors: Errors, order: int) -> Iterator[Error]:
    """Errors that no step of that size leaves of what is integrated; of gaps the widest alone, as
    an engine may hold some of its joints exactly."""
    scene = errors.of_scene
    least = LEAST * scene.step_rad ** highest_order(errors, order)
    for row in errors.rows:
        body = row.body_kind, row.body
        place = row.quantity in PLACES
        rate = row.quantity in RATES and row.source == "reported" and body in scene.uneven_rates
        if (place or rate) and row.kind in WHOLE and row.pure <= least * scene.uneven.get(body, -1):
            yield row
    gap = largest(row for row in errors.rows if row.quantity in named("closure"))
    borne = largest(row for row in errors.rows if row.quantity in FORCES)
    for widest in (gap, borne):
        if widest and widest.pure <= least * max(scene.uneven.values(), default=-1):
            yield widest


def _bent_the_same(errors: Errors) -> Iterator[Error]:
    """Deflections that are those of a theory to rounding: no engine's steps and joints are."""
    if errors.of_links.slender >= STRAIGHT:
        return
    for row in errors.rows:
        if row.quantity in BENT and row.kind in WHOLE and row.pure <= SAME_BEND:
            yield row


def _the_same(errors: Errors) -> Iterator[Error]:
    """The largest error of the rates of each body that has them all from the reference."""
    borne = largest(row for row in errors.rows if row.quantity in FORCES)
    moved = errors.worst("acceleration")
    off = moved.pure if moved and moved.pure > UNROUNDED else 0.0
    least = max(ROUNDING, LEAST * off * errors.of_forces.inertia_share)
    if borne and errors.of_scene.uneven and borne.pure <= least:
        yield borne
    rates: dict[tuple[BodyKind, str], list[Error]] = {}
    for row in errors.rows:
        if row.quantity in RATES and row.source == "reported" and row.finite:
            rates.setdefault((row.body_kind, row.body), []).append(row)
    for body, own in rates.items():
        if body in errors.of_scene.uneven and all(row.pure <= ROUNDING for row in own):
            yield max(own, key=lambda row: row.pure)
