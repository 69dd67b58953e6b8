"""The period of a mechanism that keeps its energy, by quadrature and not by integration.

With the energy E of the start, J phi'^2 / 2 + V(phi) = E says how fast the driver is wherever it
is, and the time from one angle to another is an integral::

    T = integral of sqrt(J / (2 (E - V))) dphi        over a turn, or twice between turning points

Over a turn the integrand repeats, and the trapezoidal rule converges faster than any power. Between
turning points phi = middle - half cos(psi) takes away what the root has there: over psi it repeats
too. Phase errors, which the energy of an integration hides, show as a wrong period. Source: L. N.
Trefethen, J. A. C. Weideman, The exponentially convergent trapezoidal rule, SIAM Review 56 (2014).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.free.chart import Chart, LimitedScene
from analytic.free.machine import Machine
from analytic.kinematics import repeats_after
from models.array import Array
from models.scene import Scene
from models.scene.driver import Released

SCAN = 720
"""Angles of a turn at which is looked whether the driver comes so far."""
COUNTS = tuple(2**k for k in range(5, 15))
"""Nodes, until twice as many give the same."""
SAME = 1e-13


@dataclass(frozen=True)
class Period:
    """The time [s] after which the motion repeats. ``swing_rad`` are the driver's turning points,
    None where it turns over; then the motion repeats but for the turns."""

    time_s: float
    swing_rad: tuple[float, float] | None


def period(scene: Scene) -> Period:
    """The period of a scene that is free under weights and springs alone, that passes no limit of
    its driver, and that does not rest.

    Good to about 1e-13 of itself, over the share of the energy that is left at the top where it
    nearly stops.
    """
    law = scene.driver.law
    assert isinstance(law, Released)
    assert not scene.loads
    assert not scene.friction
    arc = LimitedScene.of(scene, law.start_rad)
    machine = Machine(scene, Chart(arc, None))
    start = np.array([law.start_rad])
    speed = np.array([law.speed_rad_s])
    energy = float((machine.kinetic(start, speed) + machine.potential(start))[0])

    def left(phi: Array) -> Array:
        """What of the energy is left to move at driver angles."""
        return np.asarray(energy - machine.potential(phi))

    turn = repeats_after(scene)
    ends = _turning_points(arc, law, left, turn)
    if not ends:

        def over(count: int) -> float:
            phi = law.start_rad + turn * (np.arange(count) + 0.5) / count
            return float(turn * np.mean(np.sqrt(0.5 * machine.inertia(phi)[0] / left(phi))))

        return Period(_settled(over), None)
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])

    def swing(count: int) -> float:
        psi = math.pi * (np.arange(count) + 0.5) / count
        phi = middle - half * np.cos(psi)
        rate = np.sqrt(0.5 * machine.inertia(phi)[0] / left(phi))
        return float(2.0 * math.pi * np.mean(rate * half * np.sin(psi)))

    return Period(_settled(swing), (ends[0], ends[1]))


def _settled(rule: Callable[[int], float]) -> float:
    """The value of a rule with more and more nodes."""
    values = [rule(COUNTS[0])]
    for count in COUNTS[1:]:
        values.append(rule(count))
        if abs(values[-1] - values[-2]) <= SAME * values[-1]:
            return values[-1]
    raise AssertionError(f"the integral of a period does not settle: {values}")


def _turning_points(
    arc: LimitedScene, law: Released, left: Callable[[Array], Array], turn: float
) -> list[float]:
    """The two driver angles between which the motion swings, none where it turns over."""
    ends = []
    for way in (-1.0, 1.0):
        reach = turn
        if arc.limits is not None:
            reach = abs(arc.limits[0 if way < 0.0 else 1].driver_rad - law.start_rad)
        looks = law.start_rad + way * reach * np.linspace(0.0, 1.0 - 1e-9, SCAN)
        short = np.flatnonzero(left(looks)[1:] < 0.0)
        if short.size:
            k = int(short[0])
            ends.append(_zero(left, float(looks[k]), float(looks[k + 1])))
    assert len(ends) == (0 if arc.limits is None and not ends else 2)
    return ends


def _zero(left: Callable[[Array], Array], inside: float, outside: float) -> float:
    """Where nothing is left of the energy, to rounding; ``inside`` where that is so at once."""
    for _ in range(10):
        looks = np.linspace(inside, outside, 65)
        k = int(np.argmax(left(looks)[1:] < 0.0))
        inside, outside = float(looks[k]), float(looks[k + 1])
    return inside
