"""How long a step is and how many there are, checked before anything runs."""

import math
from numbers import Real

from models.errors import CrankcheckError, shown
from models.scene import Scene
from reports.compare.beside import SETTLING
from reports.way.length import LEAST_STEPS

LEAST_STEPS_PER_TURN = 8
MOST_STEPS = 300_000
"""All steps are logged: as many take about 1 GB with a six-bar."""
MOST_SEARCHED = 200_000
"""Of a run of a search: some seconds. A finer step can not be what a search for the cheapest one is
after."""
MOST_UNLOGGED = 1_000_000_000
"""Some hours of work, where few of the steps are logged."""
STEPS_PER_TURN = 720.0
TURNS = 2.0
"""Of a verification."""
FREE_STEP_S = 1e-3
"""The longest step of what is let go, which has no turns."""
FREE_STEPS = 5000
"""The least in what a scene says it is left free for: what is fast is over soon."""
FREE_STEPS_S = (4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)
"""Those of a sweep over it."""
TIMES_HELD = (1.0, 2.0, 4.0)
"""Those of a sweep over elastic links that are let go, over the fewest that their segments hold."""


def counted(
    scene: Scene,
    dt_s: float | None,
    steps_per_turn: float | None,
    turns: float,
    *,
    every: int = 1,
    least: int = LEAST_STEPS,
) -> tuple[float, int]:
    """Step [s] and number of steps for a scene, from --dt or --steps-per-turn (default 720).

    Every ``every``-th step is logged; there are at least ``least``.

    Raises
    ------
    CrankcheckError
        Both ways to set the step, a number that is not above 0, too few steps in a turn, too many
        or too few in all.
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
            f"{option} --turns {turns:g}: {math.ceil(steps)} steps of {scene.name}; an "
            f"engine takes up its pins in the first {SETTLING}, so a run has at least "
            f"{least}: take {least / per_turn:.3g} turns or more, or a shorter step"
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
    """Step [s] and number of steps for a scene that is let go, from --dt (default 1e-3 s, or a
    5000th of the time that the scene says) and --duration (default: that time).

    Every ``every``-th step is logged; there are at least ``least``.

    Raises
    ------
    CrankcheckError
        A number that is not above 0, too many or too few steps.
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
            f"--every {every}: the run of {scene.name} has {math.ceil(steps)} steps, so that none "
            f"is logged but the start; log more of them, or take {longer}"
        )


def positive(option: str, value: float, unit: str) -> float:
    """The number, which is above 0. Raises CrankcheckError that names the unit for any other."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise CrankcheckError(f"{option}: found {shown(value)}; give a number above 0, in {unit}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not (math.isfinite(number) and number > 0.0):
        raise CrankcheckError(f"{option} {number:g}: give a number above 0, in {unit}")
    return number
