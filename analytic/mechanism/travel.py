"""How far an output travels: swing of a link, stroke of a slider, time ratio, limit positions.

For any mechanism whose driver turns fully: the output's rate per driver rate is looked at over a
turn (over two, where change points let positions repeat after two only), closer where it comes
nearer to zero than beside it, as an output may turn back and forth between two looks; its changes
of sign, the limit positions, are refined by bisection. Where a closed form exists
(`analytic.mechanism.fourbar`, slider-crank, slotted lever) the tests hold this to it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.kinematics import repeats_after, solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene

SCAN = 720
"""Looks at a turn."""
ZOOMS = 5
FINER = 65
"""Looks at the neighbourhood of every smallest rate in each zoom."""
DEPTH = 1e-9
"""What a rate falls by, over the largest, or is below zero by, if it is more than rounding."""


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
    found = travels(scene, [output])[output]
    if isinstance(found, CrankcheckError):
        raise found
    return found


def travels(scene: Scene, outputs: Sequence[str]) -> dict[str, Travel | CrankcheckError]:
    """The travel of several links and sliders, or why one has none.

    The work is that of one output: all are refined together. Raises as `travel` what concerns the
    whole mechanism.
    """
    period = repeats_after(scene)
    count = SCAN * round(period / math.tau)
    grid: Array = (np.arange(count, dtype=np.float64) + 0.5) * (math.tau / SCAN)
    looked = _driven(scene, outputs, grid)
    _refuse_singular(scene, grid, looked)
    results: dict[str, Travel | CrankcheckError] = {}
    between: dict[str, tuple[Array, Array, Array]] = {}
    for output, (theta, rate) in _closer(scene, outputs, grid, looked).items():
        sign = np.sign(rate)
        turns = np.flatnonzero(sign != np.roll(sign, -1))
        if len(turns) == 2:
            after = np.append(theta[1:], theta[0] + period)
            between[output] = theta[turns], after[turns], sign[turns]
        else:
            results[output] = _not_two(scene, output, len(turns))
    if between:
        limits = dict(zip(between, _refined(scene, between), strict=True))
        results |= _extremes(scene, grid, limits, period)
    return {output: results[output] for output in outputs}


def _closer(
    scene: Scene, outputs: Sequence[str], grid: Array, looked: Motion
) -> dict[str, tuple[Array, Array]]:
    """By output, the driver angles of the grid and those where it turned back between them, in
    order, and the output's rates there.

    A rate that is nearest to zero at one sample is looked at ever closer on both sides of it, as
    far as where it is smallest.
    """
    rates = {output: _rate(looked, output) for output in dict.fromkeys(outputs)}
    valleys = [(output, k) for output, rate in rates.items() for k in _valleys(rate)]
    if not valleys:
        return {output: (grid, rate) for output, rate in rates.items()}
    places = np.array([grid[k] for _, k in valleys])
    signs = np.array([np.sign(rates[output][k]) for output, k in valleys])
    width = math.tau / SCAN
    for _ in range(ZOOMS):
        near = places[:, None] + np.linspace(-width, width, FINER)
        motion = _driven(scene, list(rates), near.ravel())
        rows = [_rate(motion, o).reshape(near.shape)[i] for i, (o, _) in enumerate(valleys)]
        signed = np.array(rows) * signs[:, None]
        best = np.arange(len(near)), np.argmin(signed, axis=1)
        places, least = near[best], signed[best]
        width *= 2.0 / (FINER - 1)
    found = {}
    for output, rate in rates.items():
        back = -DEPTH * np.max(np.abs(rate))
        more = [i for i, (name, _) in enumerate(valleys) if name == output and least[i] < back]
        theta = np.append(grid, places[more])
        order = np.argsort(theta)
        found[output] = theta[order], np.append(rate, signs[more] * least[more])[order]
    return found


def _valleys(rate: Array) -> NDArray[np.intp]:
    """The samples at which a rate that repeats is nearer to zero than beside them, of one sign."""
    before, after, size = np.roll(rate, 1), np.roll(rate, -1), np.abs(rate)
    same = (np.sign(before) == np.sign(rate)) & (np.sign(after) == np.sign(rate))
    least = (size <= np.abs(before)) & (size <= np.abs(after))
    depth = np.maximum(np.abs(before), np.abs(after)) - size
    return np.flatnonzero(same & least & (depth > DEPTH * np.max(size)))


def _not_two(scene: Scene, output: str, turns: int) -> CrankcheckError:
    """Why an output without two limit positions has no travel."""
    if turns == 0:
        return CrankcheckError(
            f"{scene.name}: {output} never turns back: it has no limit positions"
        )
    return CrankcheckError(
        f"{scene.name}: {output} turns back {turns} times in a turn of the driver; "
        "travel is between two limit positions"
    )


def _refined(scene: Scene, between: Mapping[str, tuple[Array, Array, Array]]) -> Array:
    """The driver angles [rad] of the limit positions by bisection, shape (outputs, 2).

    ``between`` has, by output, the looks just before and after them, and the signs of the rate
    before.
    """
    low: Array = np.array([before for before, _, _ in between.values()])
    high: Array = np.array([after for _, after, _ in between.values()])
    signs = np.array([sign for _, _, sign in between.values()])
    for _ in range(60):
        middle: Array = 0.5 * (low + high)
        motion = _driven(scene, list(between), middle.ravel())
        rates = [_rate(motion, o).reshape(middle.shape)[k] for k, o in enumerate(between)]
        same = np.sign(rates) == signs
        low = np.where(same, middle, low)
        high = np.where(same, high, middle)
    return low


def _extremes(
    scene: Scene, grid: Array, limits: Mapping[str, Array], period: float
) -> dict[str, Travel]:
    """The places of the limit positions, shape (2,) by output.

    Angles are continuous along the turn: a swing of more than half a turn is one, too.
    """
    theta = np.concatenate([grid, *limits.values()])
    order = np.argsort(theta)
    motion = _driven(scene, list(limits), theta[order])
    travelled = {}
    for k, (output, low) in enumerate(limits.items()):
        first = len(grid) + 2 * k
        places = _place(motion, output)[np.argsort(order)[first : first + 2]]
        small = 0 if places[0] < places[1] else 1
        at = low % period
        travelled[output] = Travel(
            float(places[small]),
            float(places[1 - small]),
            float(at[small]),
            float(at[1 - small]),
            period,
        )
    return travelled


def _refuse_singular(scene: Scene, grid: Array, motion: Motion) -> None:
    """Refuse a turn in which a dyad all but loses its position: its output may run to infinity."""
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


def _driven(scene: Scene, outputs: Sequence[str], theta: Array) -> Motion:
    """The outputs with the driver at some angles and at unit speed."""
    links = [output for output in outputs if output in scene.links]
    sliders = [output for output in outputs if output not in scene.links]
    one, zero = np.ones_like(theta), np.zeros_like(theta)
    return solve_driven(
        scene, theta, one, zero, links=links, points=(), sliders=sliders, bound=False
    )


def _rate(motion: Motion, output: str) -> Array:
    """The rate of the output per rate of the driver."""
    if output in motion.links:
        return motion.links[output].omega
    return motion.sliders[output].speed


def _place(motion: Motion, output: str) -> Array:
    """The angle or displacement of the output."""
    if output in motion.links:
        return motion.links[output].theta
    return motion.sliders[output].displacement
