"""Readings that are smooth and late beyond any one simple filter: so many that the width and the
delay of what they went through are all that is told of it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from models.array import Array
from reports.causes.account import CAUSE, NUMBER, Account
from reports.causes.excerpt import Excerpt
from reports.causes.fit import fitted
from reports.causes.inquiry import Inquiry
from reports.causes.words import later
from reports.output.numbers import duration

NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(7)
LEAST = 1.5
"""Samples that anything is smoothed over at least."""


def smoothed(inquiry: Inquiry) -> Iterator[Account]:
    """Channels that nothing else explains well, smoothed evenly to both sides or late as well."""
    for column in inquiry.unexplained:
        for delayed in (False, True):
            told = _told(inquiry, column, delayed=delayed)
            if told is not None:
                yield told


def _told(inquiry: Inquiry, column: str, *, delayed: bool) -> Account | None:
    """The account of smoothing over a width that is fitted, with a delay or without."""
    period = inquiry.period_s
    excerpt = inquiry.thin.excerpts[column]

    def residual(numbers: Array) -> Array:
        by_s = float(numbers[1]) if delayed else 0.0
        return excerpt.beside(_smooth(inquiry, excerpt, abs(float(numbers[0])), by_s))

    start, delta = [0.02 * period, 0.0], [1e-5 * period, 1e-6 * period]
    count = 2 if delayed else 1
    found = fitted(residual, start[:count], delta[:count])
    if found is None or not abs(found[0]) < period:
        return None
    spread, by_s = abs(float(found[0])), float(found[1]) if delayed else 0.0
    whole = inquiry.excerpts[column]
    errors = {column: whole.beside(_smooth(inquiry, whole, spread, by_s))}
    width = math.sqrt(12.0) * spread
    if width < LEAST * inquiry.step_s:
        return None
    phrase = (
        f"{{who}} {{is}} smoothed as by a mean over {duration(width)} "
        f"({width / inquiry.step_s:.3g} samples)"
    )
    if delayed:
        phrase += f", and {{belongs}} {later(by_s, inquiry.step_s)}"
    return inquiry.account("smoothed", CAUSE + NUMBER * count, errors, phrase)


def _smooth(inquiry: Inquiry, excerpt: Excerpt, spread_s: float, by_s: float) -> Array:
    """What is expected that much later, as a mean over a bell of that spread; it raises
    CrankcheckError where there is no mechanism."""
    total = np.zeros(excerpt.rows.size)
    for node, weight in zip(NODES, WEIGHTS / WEIGHTS.sum(), strict=True):
        instants = excerpt.instants + (by_s + spread_s * node)
        motion = inquiry.world.at(instants, [excerpt.channel])
        total += weight * excerpt.channel.expected(motion)
    return total
