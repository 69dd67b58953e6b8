"""Where an output is fastest and slowest: the driver's angles at which its acceleration is zero."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from analytic.mechanism.cycle import Cycle, Output, series, zeros
from models.scene import Scene


@dataclass(frozen=True)
class ExtremeSpeed:
    """A largest or smallest speed within a cycle.

    ``driver_rad`` is the driver's angle (of one that turns, 0 to ``period_rad`` of its cycle),
    ``rate`` the speed over that of the driver's phase: [1] for a link, [m] for all else.
    """

    driver_rad: float
    rate: float


def extreme_speeds(
    scene: Scene, outputs: Sequence[Output]
) -> dict[Output, tuple[ExtremeSpeed, ...]]:
    """By output, its extreme speeds in the order of the phase, under a driver of constant speed or
    one that swings: where its acceleration changes sign, found on the closed form to rounding.

    None of an output that has one speed. Raises as `analytic.mechanism.cycle.zeros`.
    """
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
