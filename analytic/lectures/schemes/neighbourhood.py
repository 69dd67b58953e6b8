"""Which of the motions that the equations leave at a position are motions indeed.

The rank at the drawn position alone may be fooled both ways: where all links lie in a line a motion
more seems to be there, and a stretched row of bars seems to give way. So the scheme is moved: a
step along a motion that the equations leave, then back to closed loops (Levenberg-Marquardt). A
motion survives that where it can go on; one that is of first order only gives back. Looked at from
a position next to the drawn one, in directions drawn at random, so that what holds there holds in
general. Source for the terms: K. H. Hunt, Kinematic Geometry of Mechanisms, chapter 2 (transitory
and full-cycle mobility); the steps are ours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.lectures.schemes.scheme_loops import Loops
from models.array import Array

AWAY = 0.2
"""How far the drawn position is left [rad, or shares of the scheme's size]."""
LOOK = 1e-2
"""The step that tests a motion; what survives differs from the step by its square."""
CLOSED = 1e-13
SHAKES = 1e-5
"""Next to the drawn position a scheme that shakes is closed to its rounding, and so is off by the
root of that; what opens its loops by less may be such a motion, and is tried."""
MOST_STEPS = 60
TRIES = 4
SEED = 18


@dataclass(frozen=True)
class Neighbourhood:
    """What a scheme can do here and next to here.

    ``at`` (f,) is the position next to the drawn one, ``moves`` (f, d) are all motions that the
    equations leave there, ``finite`` says how many of them are motions indeed; ``here`` is what
    the equations leave at the drawn position.
    """

    here: int
    at: Array
    moves: Array
    finite: int
    others: tuple[int, ...]
    """The mobility on other branches that begin at the drawn position."""
    margin: float
    """The least of what holds there, as a share of the most (`Loops.margin`)."""

    @property
    def is_singular(self) -> bool:
        """Whether the drawn position has motions that those next to it have not."""
        return self.here > int(self.moves.shape[1])


def neighbourhood(loops: Loops) -> Neighbourhood:
    """Move a scheme out of the drawn position, and count its motions there."""
    here = loops.moves(np.zeros(loops.freedoms))
    draw = np.random.default_rng(SEED)
    found = []
    for _ in range(TRIES):
        at = _left(loops, here, draw)
        moves = loops.moves(at, SHAKES)
        found.append((_finite(loops, at, moves, draw), at, moves))
        if not loops.closing:
            break  # without loops all positions are alike
    finite, at, moves = max(found, key=lambda each: each[0])
    others = tuple(sorted({each[0] for each in found} - {finite}))
    return Neighbourhood(here.shape[1], at, moves, finite, others, loops.margin(at))


def settled(loops: Loops, q: Array) -> Array | None:
    """The closed position next to ``q``, or None where none was come to."""
    for _ in range(MOST_STEPS):
        open_by, slope = loops.closure(q)
        size = float(np.linalg.norm(open_by))
        if size < CLOSED * max(1, len(open_by)):
            return q
        left, values, right = np.linalg.svd(slope, full_matrices=False)
        # Damped by the square of what is open: rows that depend on others are left alone.
        damping = values / (values**2 + min(size**2, 1e-4) + 1e-18)
        q = q - right.T @ (damping * (left.T @ open_by))
    return q if size < 1e3 * CLOSED else None


def _left(loops: Loops, moves: Array, draw: np.random.Generator) -> Array:
    """A position off the drawn one, or that itself where nothing moves."""
    stay = np.zeros(loops.freedoms)
    if moves.shape[1] == 0:
        return stay
    for share in (1.0, 0.3, 0.1):
        direction = moves @ draw.standard_normal(moves.shape[1])
        direction *= share * AWAY / max(float(np.abs(direction).max()), 1e-300)
        there = settled(loops, direction)
        # What gives back comes to rest at the drawn position, or slowly towards it.
        if there is not None and 0.05 < np.abs(there).max() / (share * AWAY) < 3.0:
            return there
    return stay


def _finite(loops: Loops, at: Array, moves: Array, draw: np.random.Generator) -> int:
    """The number of independent motions at a position that survive a step."""
    count = int(moves.shape[1])
    if count == 0 or not loops.closing:
        return count
    if loops.closure(at)[1].shape[0] + count == loops.freedoms:
        return count  # independent equations: what they leave can go on (implicit functions)
    turned, _ = np.linalg.qr(draw.standard_normal((count, count)))
    steps = [settled(loops, at + LOOK * step) for step in (moves @ turned).T]
    way = np.array([np.zeros_like(at) if step is None else step - at for step in steps]) / LOOK
    values = np.linalg.svd(way @ moves, compute_uv=False)
    return int(np.count_nonzero(values > 0.2))
