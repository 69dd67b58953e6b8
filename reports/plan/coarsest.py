"""The coarsest step that reaches a target: found by few runs, and held against finer steps.

The error of a sound run falls with the square of the step or faster, so each run says about where
the next should be. It need not fall: two errors of opposite sign cancel at one step, and a soft
constraint leaves a floor. So a step counts only when finer ones reach the target as well.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

RESOLUTION = 1.01
"""How far apart, as a ratio, a step that reaches the target and one that misses it may be."""
FINER = (math.sqrt(2.0), 2.0)
"""How much finer the steps are that have to reach the target as well."""
FALL = 0.8
"""An error that is not under so much of itself at half the step does not fall."""
LEAP = 8.0
"""The most that the number of steps grows by from one run to the next."""


def coarsest(
    error_at: Callable[[int], float], target: float, start: int, least: int, most: int
) -> int | None:
    """The coarsest step, as a number of steps in a turn, or in whatever ``least`` and ``most``
    are in; None where none reaches.

    Parameters
    ----------
    error_at : Callable
        From a number of steps to the error; what is not a number counts as infinite. It is called
        once for each step at most; up to twice ``most`` to hold a step against finer ones.
    start : int
        Where to look first.
    """
    looks, failed = _Looks(error_at, target), least - 1
    steps = min(max(start, least), most)
    while True:
        reached = _finer(looks, steps, most)
        if reached is None:
            return None
        failed = max([failed, *(n for n in looks.errors if n < reached and not looks.reach(n))])
        steps = _between(looks, failed, reached, least)
        worse = [n for n in (math.ceil(f * steps) for f in FINER) if not looks.reach(n)]
        if not worse:
            return steps
        failed = max(worse)  # what was reached at a coarser step was luck
        if failed >= most:
            return None
        steps = failed + 1


@dataclass(frozen=True)
class _Looks:
    """The runs so far."""

    error_at: Callable[[int], float]
    target: float
    errors: dict[int, float] = field(default_factory=dict)

    def error(self, steps: int) -> float:
        if steps not in self.errors:
            error = self.error_at(steps)
            self.errors[steps] = math.inf if math.isnan(error) else error
        return self.errors[steps]

    def reach(self, steps: int) -> bool:
        return self.error(steps) <= self.target


def _finer(looks: _Looks, steps: int, most: int) -> int | None:
    """A step that reaches the target, from ``steps`` on to finer ones; None where none does."""
    run = [steps]
    while not looks.reach(steps):
        if steps >= most or _stays(looks, run):
            return None
        steps = min(most, max(steps + 1, math.ceil(steps * _leap(looks, run))))
        run.append(steps)
    return steps


def _leap(looks: _Looks, run: list[int]) -> float:
    """How many times more steps should reach the target."""
    error = looks.error(run[-1])
    if math.isinf(error):
        return 2.0
    order = 2.0
    if len(run) > 1 and math.isfinite(before := looks.error(run[-2])) and before > error > 0.0:
        order = math.log(before / error) / math.log(run[-1] / run[-2])
    order = min(max(order, 1.0), 4.0)
    return min(max(1.02 * math.pow(error / looks.target, 1.0 / order), 1.05), LEAP)


def _stays(looks: _Looks, run: list[int]) -> bool:
    """Whether the error has stopped to fall: twice in a row, over a doubling of steps each."""
    pairs = list(itertools.pairwise(run))[-2:]
    return len(pairs) == 2 and all(
        looks.error(fine) > looks.error(coarse) * FALL ** math.log2(fine / coarse)
        for coarse, fine in pairs
    )


def _between(looks: _Looks, failed: int, reached: int, least: int) -> int:
    """The coarsest that reaches the target, to within the resolution.

    ``failed`` is a number of steps that misses it, or one under ``least``, which was not run.
    """
    turn = 0
    while reached > failed + 1 and (failed < least or reached > RESOLUTION * failed):
        turn += 1
        steps = _guess(looks, failed, reached, least, turn)
        if looks.reach(steps):
            reached = steps
        else:
            failed = steps
    return reached


def _guess(looks: _Looks, failed: int, reached: int, least: int, turn: int) -> int:
    """Where to look next between two numbers of steps."""
    high, target = looks.error(reached), looks.target
    if failed < least:  # nothing is known to miss: as for order 2, and a bit further
        guess = 0.97 * reached * math.sqrt(max(high, target / LEAP**2) / target)
        return max(least, min(math.floor(guess), reached - 1))
    low = looks.error(failed)
    middle = math.sqrt(failed * reached)
    if turn % 4 and math.isfinite(low) and 0.0 < high < low:
        part = math.log(low / target) / math.log(low / high)
        middle = 1.002 * failed * (reached / failed) ** part
    edge = math.sqrt(RESOLUTION)
    middle = min(max(middle, failed * edge), reached / edge)
    return max(failed + 1, min(reached - 1, math.ceil(middle)))
