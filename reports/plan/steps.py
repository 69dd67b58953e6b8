"""Length and number of steps, checked before anything runs.

The error of a sound run falls with the square of the step or faster, so each run says about where
the next should be. It need not fall: two errors of opposite sign cancel at one step, and a soft
constraint leaves a floor. So a step counts only when finer ones reach the target as well.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from numbers import Real

from models.errors import CrankcheckError, shown
from models.scene import Scene
from reports.compare.compare import SETTLING
from reports.protocol.length import LEAST_STEPS

LEAST_STEPS_PER_TURN = 8
MOST_STEPS = 300_000
"""Most logged steps: as many take about 1 GB with a six-bar."""
MOST_SEARCHED = 200_000
"""Most steps of a run of a search: some seconds. A search for the cheapest needs none finer."""
MOST_UNLOGGED = 1_000_000_000
"""Most steps where few are logged: some hours of work."""
STEPS_PER_TURN = 720.0
TURNS = 2.0
"""Turns of a verification."""
FREE_STEP_S = 1e-3
"""Longest step of a free motion, which has no turns."""
FREE_STEPS = 5000
"""Least number of steps in the scene's duration of free motion: fast motions are over soon."""
FREE_STEPS_S = (4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)
"""Steps of a sweep over free motion."""
TIMES_HELD = (1.0, 2.0, 4.0)
"""Ratios of a sweep over elastic links in free motion, over the fewest steps for their segments."""


def counted(
    scene: Scene,
    dt_s: float | None,
    steps_per_turn: float | None,
    turns: float,
    *,
    every: int = 1,
    least: int = LEAST_STEPS,
) -> tuple[float, int]:
    """Return step [s] and number of steps for a scene, from --dt or --steps-per-turn (default 720).

    Every ``every``-th step is logged; there are at least ``least``.

    Raises CrankcheckError for both ways to set the step, a number that is not above 0, too few
    steps in a turn, too many or too few in all.
    """
    if dt_s is not None and steps_per_turn is not None:
        raise CrankcheckError("--dt and --steps-per-turn: both set the step; give one of them")
    turns = positive("--turns", turns, "turns; 1 is one period of the driver")
    period = scene.driver.law.period_s
    if dt_s is not None:
        dt_s = positive("--dt", dt_s, "seconds, such as 1e-3")
        option, per_turn = f"--dt {dt_s:g}", period / dt_s
    else:
        per_turn = STEPS_PER_TURN if steps_per_turn is None else steps_per_turn
        per_turn = positive("--steps-per-turn", per_turn, "steps, such as 720")
        option = f"--steps-per-turn {per_turn:g}"
    if per_turn < LEAST_STEPS_PER_TURN * (1 - 1e-12):
        raise CrankcheckError(
            f"{option}: {per_turn:.3g} steps in a turn of {scene.name} ({period:.4g} s); a "
            f"turn needs at least {LEAST_STEPS_PER_TURN}, so dt at most "
            f"{period / LEAST_STEPS_PER_TURN:.4g} s"
        )
    steps = turns * per_turn * (1 - 1e-12)  # may be infinite
    most = min(MOST_STEPS * every, MOST_UNLOGGED)
    if not steps <= most:
        raise CrankcheckError(
            f"{option} --turns {turns:g}: {steps:.6g} steps of {scene.name}; at most "
            f"{most}{' are logged' * (every == 1)}; take a longer step or fewer turns"
        )
    if steps <= least - 1:
        raise CrankcheckError(
            f"{option} --turns {turns:g}: {math.ceil(steps)} steps of {scene.name}; an engine "
            f"settles its pins in the first {SETTLING}, so a run has at least {least}: take "
            f"{least / per_turn:.3g} turns or more, or a shorter step"
        )
    _refuse_unlogged(scene, every, steps, "more turns")
    return dt_s or period / per_turn, math.ceil(steps)


def counted_free(
    scene: Scene,
    dt_s: float | None,
    duration_s: float | None,
    *,
    every: int = 1,
    least: int = LEAST_STEPS,
) -> tuple[float, int]:
    """Return step [s] and number of steps for a free motion, from --dt (default 1e-3 s, or a 5000th
    of the scene's duration) and --duration (default: the scene's duration).

    Every ``every``-th step is logged; there are at least ``least``.

    Raises CrankcheckError for a number that is not above 0, too many or too few steps.
    """
    period_s = lasts_s = scene.driver.law.period_s
    if dt_s is None:
        dt_s = min(FREE_STEP_S, period_s / FREE_STEPS)
    dt_s = positive("--dt", dt_s, "seconds, such as 1e-3")
    if duration_s is not None:
        lasts_s = positive("--duration", duration_s, "seconds, such as 10")
    steps = lasts_s / dt_s * (1 - 1e-12)  # may be infinite
    most = min(MOST_STEPS * every, MOST_UNLOGGED)
    if not least - 1 < steps <= most:
        logged = ", as all are logged" * (every == 1)
        raise CrankcheckError(
            f"--dt {dt_s:g} --duration {lasts_s:g}: {steps:.6g} steps of {scene.name}; a run has "
            f"{least} at least, and {most} at most{logged}: take another step, or another duration"
        )
    _refuse_unlogged(scene, every, steps, "a longer duration")
    return dt_s, math.ceil(steps)


def _refuse_unlogged(scene: Scene, every: int, steps: float, longer: str) -> None:
    """Refuse a run that logs no step but its start. Raises CrankcheckError."""
    if every > math.ceil(steps):
        raise CrankcheckError(
            f"--every {every}: the run of {scene.name} has {math.ceil(steps)} steps, so only the "
            f"start would be logged; log more of them, or take {longer}"
        )


def positive(option: str, value: float, unit: str) -> float:
    """Return a number above 0. Raises CrankcheckError that names the unit for any other."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise CrankcheckError(f"{option}: found {shown(value)}; give a number above 0, in {unit}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not (math.isfinite(number) and number > 0.0):
        raise CrankcheckError(f"{option} {number:g}: give a number above 0, in {unit}")
    return number


RESOLUTION = 1.01
"""Largest ratio of a step that misses the target to one that reaches it."""
FINER = (math.sqrt(2.0), 2.0)
"""Factors of the finer steps that have to reach the target as well."""
FALL = 0.8
"""Share of an error, at half the step, above which it does not shrink."""
LEAP = 8.0
"""Largest growth of the number of steps from one run to the next."""


def coarsest(
    error_at: Callable[[int], float], target: float, start: int, least: int, most: int
) -> int | None:
    """Return the coarsest step that reaches the target, as a number of steps, in a turn or in the
    unit of ``least`` and ``most``; None without one.

    Parameters
    ----------
    error_at : Callable
        From a number of steps to the error; NaN counts as infinite. It is called once for each step
        at most; up to twice ``most`` to compare a step with finer ones.
    start : int
        The first number of steps.
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
        failed = max(worse)  # a coarser step reached it by luck
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
    """Return a step that reaches the target, from ``steps`` on to finer ones; None without one."""
    run = [steps]
    while not looks.reach(steps):
        if steps >= most or _stays(looks, run):
            return None
        steps = min(most, max(steps + 1, math.ceil(steps * _leap(looks, run))))
        run.append(steps)
    return steps


def _leap(looks: _Looks, run: list[int]) -> float:
    """Return the factor of steps that should reach the target."""
    error = looks.error(run[-1])
    if math.isinf(error):
        return 2.0
    order = 2.0
    if len(run) > 1 and math.isfinite(before := looks.error(run[-2])) and before > error > 0.0:
        order = math.log(before / error) / math.log(run[-1] / run[-2])
    order = min(max(order, 1.0), 4.0)
    return min(max(1.02 * math.pow(error / looks.target, 1.0 / order), 1.05), LEAP)


def _stays(looks: _Looks, run: list[int]) -> bool:
    """True if the error has stopped to fall: twice in a row, over a doubling of steps each."""
    pairs = list(itertools.pairwise(run))[-2:]
    return len(pairs) == 2 and all(
        looks.error(fine) > looks.error(coarse) * FALL ** math.log2(fine / coarse)
        for coarse, fine in pairs
    )


def _between(looks: _Looks, failed: int, reached: int, least: int) -> int:
    """Return the coarsest that reaches the target, to within the resolution.

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
    """Return the next number of steps to run between two."""
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
