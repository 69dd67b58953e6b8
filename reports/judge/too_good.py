"""Which bodies are nearer to the reference than an engine can come: they were taken from it.

An engine whose places are integrated is off by a multiple of step^order at every body that does
not move evenly with the driver (`reports.compare.uneven`): in its places, total and geometric, in
the rates of links, and in the widest gap of its joints. (A slider may well have the right speed
where the links that it rides on turn evenly.) On every shipped scene and 150
random ones, at 45 to 5760 steps a turn, the least was 9e-4 of that times how unevenly the body
moves. What was taken from the reference, however it was rounded afterwards, is off by nothing, or
by no more than the crank is.

An engine that solves its joints in each step may have places that are exact. Its rates are numbers
of their own nevertheless: over a whole run some of them are rounded in another way.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping

from reports.compare.errors import Error, largest
from reports.quantities import named
from reports.quantities.quantity import BodyKind
from sim.engine import Placing

LEAST = 5e-5
"""A nineteenth of the least multiple that was seen."""
PLACES, RATES = named("place"), named("derived")
WHOLE = ("total", "geometric")
"""Errors of the run, but for its start and change points, where an engine may have hardly moved."""
ROUNDING = sys.float_info.epsilon
"""A rate that is off by this share of its scale, at most, is the next number or the same."""


def too_good(
    rows: Iterable[Error],
    uneven: Mapping[tuple[BodyKind, str], float],
    step_rad: float,
    placing: Placing,
    order: int,
) -> list[Error]:
    """The errors that are too small for their body and step, the smallest first."""
    if placing == "integrated":
        rows = list(rows)
        least = {body: LEAST * step_rad**order * far for body, far in uneven.items()}
        found = [
            row
            for row in rows
            if row.kind in WHOLE
            and (row.quantity in PLACES or (row.quantity in RATES and _turns(row)))
            and row.pure <= least.get((row.body_kind, row.body), -1.0)
        ]
        gap = largest(row for row in rows if row.quantity in named("closure"))
        found += [gap] if gap and gap.pure <= max(least.values(), default=-1.0) else []
    else:
        rates: dict[tuple[BodyKind, str], list[Error]] = {}
        for row in rows:
            if row.quantity in RATES and row.source == "reported" and row.finite:
                rates.setdefault((row.body_kind, row.body), []).append(row)
        found = [
            max(own, key=lambda row: row.pure)
            for body, own in rates.items()
            if body in uneven and all(row.pure <= ROUNDING for row in own)
        ]
    return sorted(found, key=lambda row: row.pure)


def _turns(row: Error) -> bool:
    """Whether it is a rate of a link, as the engine reports it."""
    return row.body_kind == "link" and row.source == "reported"
