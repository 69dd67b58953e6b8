"""Travel of an output: swing of a link, stroke of a slider or of a point along a direction, time
ratio, limit positions.

It covers any mechanism that goes through a whole cycle (`analytic.mechanism.cycle`). Tests compare
it with the closed forms (`analytic.mechanism.fourbar`, slider-crank, slotted lever).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.mechanism.cycle import Cycle, Output, series, zeros
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import GROUND, Scene

SAME = 1e-9
"""Distance of limit positions, over the stroke, below which they are one place."""


@dataclass(frozen=True)
class Travel:
    """Travel of an output over ``period_rad`` of the driver's phase, after which it is back.

    ``low`` and ``high`` are its extremes ([rad] for a link, else [m]), ``low_at_rad`` the phase (of
    the cycle, see `analytic.mechanism.cycle`) where it first has ``low``, and ``high_at_rad`` that
    where it next has ``high``; ``limits`` is the number of limit positions in a cycle: two, or more
    where it turns back on its way. ``time_ratio`` is the phase of the longer stroke between the
    extremes over that of the shorter, and so of their times.
    """

    low: float
    high: float
    low_at_rad: float
    high_at_rad: float
    period_rad: float = math.tau
    limits: int = 2

    @property
    def stroke(self) -> float:
        """Swing [rad] or stroke [m]."""
        return self.high - self.low

    @property
    def time_ratio(self) -> float:
        forth = (self.high_at_rad - self.low_at_rad) % self.period_rad
        back = self.period_rad - forth
        return max(forth, back) / min(forth, back)


def travel(scene: Scene, output: Output) -> Travel:
    """Find the travel of a link, a slider or a point along a direction until the mechanism repeats.

    Raises
    ------
    ReachError
        The driver does not turn fully, or swing as far as its law has it.
    CrankcheckError
        No such output; an output that turns fully; or a cycle that passes a singular position,
        change points apart.
    """
    if isinstance(output, str) and output not in scene.links and output not in scene.sliders:
        have = ", ".join([*scene.links, *scene.sliders])
        raise CrankcheckError(f"{scene.name}: no link or slider {output!r}; it has {have}")
    found = travels(scene, [output])[output]
    if isinstance(found, CrankcheckError):
        raise found
    return found


def travels(scene: Scene, outputs: Sequence[Output]) -> dict[Output, Travel | CrankcheckError]:
    """Return the travel of several outputs, or the error of an output without one.

    The work is that of one output: all are refined together. Raises the errors of `travel` that
    concern the whole mechanism.
    """
    cycle = Cycle.of(scene)
    limits = {o: at for o, at in zeros(cycle, outputs, 1).items() if at.size > 1}
    found = _extremes(cycle, limits)
    return {output: found.get(output) or _endless(scene, output) for output in outputs}


def _endless(scene: Scene, output: Output) -> CrankcheckError:
    name = output if isinstance(output, str) else output.point
    return CrankcheckError(f"{scene.name}: {name} never turns back: it has no limit positions")


def _extremes(cycle: Cycle, limits: Mapping[Output, Array]) -> dict[Output, Travel]:
    """Return the outermost of the limit positions, whose phases are given by output.

    Angles are continuous along the cycle: a swing may be more than half a turn.
    """
    if not limits:
        return {}
    phase = np.concatenate([cycle.grid, *limits.values()])
    order = np.argsort(phase)
    motion = cycle.at(list(limits), phase[order])
    travelled, first = {}, len(cycle.grid)
    for output, at in limits.items():
        places = series(motion, output)[0][np.argsort(order)[first : first + at.size]]
        first += at.size
        low, high = float(np.min(places)), float(np.max(places))
        same = SAME * (high - low)
        low_at = float(at[places <= low + same][0])
        high_at = _next(at[places >= high - same], low_at, cycle)
        again_at = _next(at[places <= low + same], high_at, cycle)
        back = (again_at - low_at) % cycle.period_rad or cycle.period_rad
        travelled[output] = Travel(low, high, low_at, high_at, back, at.size)
    return travelled


def _next(at: Array, after: float, cycle: Cycle) -> float:
    """Return the first of the phases that follows another in the cycle."""
    return float(at[np.argmin((at - after) % cycle.period_rad)])


@dataclass(frozen=True)
class ExtremeSpeed:
    """Largest or smallest speed within a cycle.

    ``driver_rad`` is the driver's angle (0 to ``period_rad`` of its cycle if it turns), ``rate``
    the speed over that of the driver's phase: [1] for a link, else [m].
    """

    driver_rad: float
    rate: float


def extreme_speeds(
    scene: Scene, outputs: Sequence[Output]
) -> dict[Output, tuple[ExtremeSpeed, ...]]:
    """Return by output its extreme speeds in the order of the phase, under a driver of constant
    speed or one that swings: where its acceleration changes sign, found on the closed form to
    rounding. A constant speed has none. Raises as `analytic.mechanism.cycle.zeros`."""
    cycle = Cycle.of(scene)
    found = {}
    for output, at in zeros(cycle, outputs, 2).items():
        rates = series(cycle.at([output], at), output)[1] if at.size else at
        angles = cycle.driver(at)
        found[output] = tuple(
            ExtremeSpeed(float(angle), float(rate))
            for angle, rate in zip(angles, rates, strict=True)
        )
    return found


def coriolis(scene: Scene, motion: Motion) -> Mapping[str, Array]:
    """Return 2 omega v [m/s^2], (T,), of sliders on moving guides: omega of the guide, v along it.

    Positive to the left of the slider's line, a quarter turn counter-clockwise from its direction:
    v turned in the sense of omega. The guides must be among the motion's links. Its rounding is
    that of the two factors (``motion.bound``).
    """
    return {
        name: 2.0 * motion.links[slider.on].omega * motion.sliders[name].speed
        for name, slider in scene.sliders.items()
        if slider.on != GROUND
    }
