"""How far an output travels: swing of a link, stroke of a slider, time ratio, limit positions.

For any mechanism whose driver turns fully: the output's rate per driver rate is looked at over a
turn (over two, where change points let positions repeat after two only), and its changes of sign,
the limit positions, are refined by bisection. Where a closed form exists (`analytic.fourbar`,
slider-crank, slotted lever) the tests hold this to it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import repeats_after, solve_driven
from analytic.plane import Array
from models.errors import CrankcheckError
from models.scene import Scene

SCAN = 720


@dataclass(frozen=True)
class Travel:
    """The travel of an output over ``period_rad`` of the driver, after which it repeats.

    ``low`` and ``high`` are its extremes ([rad] for a link, [m] for a slider), ``low_at_rad`` and
    ``high_at_rad`` the driver angles (0 to ``period_rad``) where it has them; ``time_ratio`` is the
    driver angle of the longer stroke over that of the shorter.
    """

    low: float
    high: float
    low_at_rad: float
    high_at_rad: float
    period_rad: float = math.tau

    @property
    def stroke(self) -> float:
        """Swing [rad] or stroke [m]."""
        return self.high - self.low

    @property
    def time_ratio(self) -> float:
        forth = (self.high_at_rad - self.low_at_rad) % self.period_rad
        back = self.period_rad - forth
        return max(forth, back) / min(forth, back)


def travel(scene: Scene, output: str) -> Travel:
    """The travel of link or slider ``output`` until the mechanism repeats.

    Raises
    ------
    ReachError
        The driver does not turn fully.
    CrankcheckError
        No such output; an output that turns fully; one with more than two limit positions; or a
        turn that passes a singular position, change points apart.
    """
    if output not in scene.links and output not in scene.sliders:
        have = ", ".join([*scene.links, *scene.sliders])
        raise CrankcheckError(f"{scene.name}: no link or slider {output!r}; it has {have}")
    period = repeats_after(scene)
    count = SCAN * round(period / math.tau)
    grid: Array = (np.arange(count, dtype=np.float64) + 0.5) * (math.tau / SCAN)
    rate = _rate(scene, output, grid)
    _refuse_singular(scene, grid)
    turns = np.flatnonzero(np.sign(rate) != np.sign(np.roll(rate, -1)))
    if len(turns) == 0:
        raise CrankcheckError(f"{scene.name}: {output} never turns back: it has no limit positions")
    if len(turns) != 2:
        raise CrankcheckError(
            f"{scene.name}: {output} turns back {len(turns)} times in a turn of the driver; "
            "travel is between two limit positions"
        )
    low: Array = grid[turns]
    high: Array = low + math.tau / SCAN
    sign = np.sign(rate[turns])
    for _ in range(60):
        middle: Array = 0.5 * (low + high)
        same = np.sign(_rate(scene, output, middle)) == sign
        low = np.where(same, middle, low)
        high = np.where(same, high, middle)
    # Angles are continuous along the turn: a swing of more than half a turn is one, too.
    order = np.argsort(np.concatenate([grid, low]))
    places = _place(scene, output, np.concatenate([grid, low])[order])[np.argsort(order)[-2:]]
    first = 0 if places[0] < places[1] else 1
    at = low % period
    return Travel(
        float(places[first]),
        float(places[1 - first]),
        float(at[first]),
        float(at[1 - first]),
        period,
    )


def _refuse_singular(scene: Scene, grid: Array) -> None:
    """Refuse a turn in which a dyad all but loses its position: its output may run to infinity."""
    one, zero = np.ones_like(grid), np.zeros_like(grid)
    motion = solve_driven(scene, grid, one, zero, links=(), points=(), sliders=(), bound=False)
    passed = {crossing.dyad for crossing in motion.crossings}
    for key, sine in motion.conditioning.items():
        if key in passed:
            continue
        worst = int(np.argmin(sine))
        if sine[worst] < math.tau / SCAN:
            raise CrankcheckError(
                f"{scene.name}: the dyad of {key} passes a singular position near "
                f"{math.degrees(grid[worst]):.4g} deg, where its travel has no limits"
            )


def _rate(scene: Scene, output: str, theta: Array) -> Array:
    """The rate of the output per rate of the driver."""
    one, zero = np.ones_like(theta), np.zeros_like(theta)
    if output in scene.links:
        motion = solve_driven(
            scene, theta, one, zero, links=(output,), points=(), sliders=(), bound=False
        )
        return motion.links[output].omega
    motion = solve_driven(
        scene, theta, one, zero, links=(), points=(), sliders=(output,), bound=False
    )
    return motion.sliders[output].speed


def _place(scene: Scene, output: str, theta: Array) -> Array:
    """The angle or displacement of the output."""
    one, zero = np.ones_like(theta), np.zeros_like(theta)
    motion = solve_driven(scene, theta, one, zero, points=(), bound=False)
    if output in scene.links:
        return motion.links[output].theta
    return motion.sliders[output].displacement
