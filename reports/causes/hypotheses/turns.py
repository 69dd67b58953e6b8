"""Angles that lose whole or half turns on the way, or are folded into a part of one."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from reports.causes.account import CAUSE, CHOICE, Account
from reports.causes.excerpt import BROUGHT_WITHIN, Rows, Size
from reports.causes.inquiry import Inquiry
from reports.output.numbers import listed

EDGES = (-math.tau, -math.pi, 0.0)
"""Where the turn begins that wrapped readings lie in [rad]."""
EDGE = 1e-2
"""How near to an edge noise may take readings over it [rad]."""
MOST_JUMPS = 12
"""Turns that may be lost; of more it is how the angle is measured."""
SHOWN = 3


def turns(inquiry: Inquiry) -> Iterator[Account]:
    """Angles whose error is whole turns, or half ones, or whose sign is lost."""
    for column in inquiry.open:
        excerpt = inquiry.excerpts[column]
        if excerpt.channel.kind.turns:
            try:
                values, error = inquiry.whole(column)
            except CrankcheckError:
                continue
            for found in (_whole, _half):
                told = found(inquiry, column, values, error)
                if told is not None:
                    yield told
        told = _unsigned(inquiry, column)
        if told is not None:
            yield told


def _whole(inquiry: Inquiry, column: str, values: Array, error: Array) -> Account | None:
    """The account of whole turns: an angle that is wrapped, or lost some."""
    if inquiry.channel(column).wrapped:
        return None
    turn = np.round(error / math.tau)
    jumps = np.flatnonzero(np.diff(turn)) + 1
    if not jumps.size:
        return None
    left = error - math.tau * turn
    if _wrapped(values, values - left):
        phrase = "{who} {is} wrapped into one turn"
        return _told(inquiry, column, left, ("wrapped", CAUSE, phrase), {"wrapped": True})
    if jumps.size > MOST_JUMPS:
        return None
    phrase = f"{{who}} lose{{s}} whole turns: {_jumps(inquiry, turn, jumps)}"
    cost = CAUSE + CHOICE * min(jumps.size, 4)
    return _told(inquiry, column, left, ("lost turn", cost, phrase), {})


def _wrapped(values: Array, angle: Array) -> bool:
    """Whether readings are an angle (known but for whole turns) within one turn that begins where
    people let one begin; beside its edges noise may take some over them."""
    for edge in EDGES:
        from_edge = np.remainder(angle - edge, math.tau)
        inside = np.minimum(from_edge, math.tau - from_edge) > EDGE
        if np.all(np.abs(edge + from_edge - values)[inside] < math.pi) and inside.any():
            return True
    return False


def _folded(values: Array) -> bool:
    """Whether readings lie in half a turn that begins where an arc tangent does."""
    least, most = float(np.min(values)), float(np.max(values))
    begins = (-0.5 * math.pi, 0.0)
    return any(each - EDGE < least and most < each + math.pi + EDGE for each in begins)


def _half(inquiry: Inquiry, column: str, values: Array, error: Array) -> Account | None:
    """The account of an angle that is known but for half turns, as from an arc tangent."""
    half = np.round(error / math.pi)
    if not np.any(half % 2.0) or not _folded(values):
        return None
    phrase = "{who} {is} folded into half a turn, as an arc tangent of one number does"
    left = error - math.pi * half
    return _told(inquiry, column, left, ("half turns", CAUSE + CHOICE, phrase), {})


def _told(
    inquiry: Inquiry,
    column: str,
    left: Array,
    said: tuple[str, float, str],
    correction: dict[str, object],
) -> Account | None:
    """The account, by its name, cost and phrase, of what leaves this over the whole log."""
    excerpt = inquiry.excerpts[column]
    rest = float(np.max(np.abs(left))) / math.tau
    if rest > BROUGHT_WITHIN or (rest > 0.1 and np.max(np.abs(left)) > excerpt.limit):
        return None
    name, cost, phrase = said
    over = float(np.max(np.abs(left))) / Size.of(excerpt.error).largest
    return Account(name, cost, {column: rest}, {column: over}, phrase, {column: correction})


def _jumps(inquiry: Inquiry, turn: Array, jumps: Rows) -> str:
    """Where turns are lost, and how many at once."""
    times, each = inquiry.case.log.time_s, []
    for place in jumps[:SHOWN]:
        by = int(turn[place] - turn[place - 1])
        each.append(f"{by:+d} at sample {place} (t = {times[place]:.6g} s)")
    if jumps.size > SHOWN:
        each.append(f"{jumps.size - SHOWN} more")
    return listed(each)


def _unsigned(inquiry: Inquiry, column: str) -> Account | None:
    """The account of readings that have lost their sign."""
    excerpt = inquiry.excerpts[column]
    expected = excerpt.expected
    if excerpt.channel.kind.turns:
        expected = np.remainder(expected + math.pi, math.tau) - math.pi
    if np.any(excerpt.values < 0.0) or not np.any(expected < 0.0):
        return None
    errors = {column: excerpt.values - np.abs(expected)}
    phrase = "{who} {has} no sign: {is} the magnitude"
    return inquiry.account("unsigned", CAUSE + CHOICE, errors, phrase)
