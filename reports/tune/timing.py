"""What steps really take: two choices of settings, timed in turns on this machine."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass

from reports.sweep.measured import Repeats, timed_in_turns
from reports.tune.attempt import Attempt, Goal
from reports.workers.isolated import Isolated, Limits

ROUNDS = 12
"""How often each is timed, one after the other: a slow minute then slows both."""
GUESS_US = 50.0
"""Of a step; high, so that a repeat is short: of many short ones the least is hardly disturbed."""


@dataclass(frozen=True)
class Taken:
    """Measured times of the scenes together: of a step [microseconds] and of a turn [s].

    ``noise`` is how far two timings of the same thing lay apart, relative to it.
    """

    us_per_step: float
    s_per_turn: float
    noise: float


def times(goal: Goal, attempts: Sequence[Attempt], limits: Limits) -> list[Taken] | None:
    """Time each attempt at its step; the least time of all rounds counts. None where one is lost.

    The A/A noise is that of the least times of odd and even rounds over all scenes.
    """
    cells = [goal.cell(scene, a.settings, a.tried) for a in attempts for scene in goal.scenes]
    with closing(Isolated[Repeats](limits)) as isolated:
        timings = timed_in_turns(isolated, [(cell, GUESS_US) for cell in cells], ROUNDS)
    least = [(min(timing[0]), min(timing[1])) for timing in timings if timing is not None]
    if len(least) < len(cells):
        return None
    each = len(goal.scenes)
    return [
        _taken(least[each * index : each * (index + 1)], attempt.tried)
        for index, attempt in enumerate(attempts)
    ]


def _taken(halves: Sequence[Sequence[float]], steps_per_turn: int) -> Taken:
    """Sums over the scenes."""
    us = sum(min(half) for half in halves)
    a, b = (sum(half[k] for half in halves) for k in (0, 1))
    return Taken(us, 1e-6 * us * steps_per_turn, abs(a - b) / min(a, b))
