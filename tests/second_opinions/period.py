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
from models.errors import CrankcheckError
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
    """The period of a scene that is let go under weights and springs alone.

    Good to about 1e-13 of itself, over the share of the energy that is left at the top where it
    nearly stops.

    Raises
    ------
    CrankcheckError
        Loads, dampers, friction; a spring that is wound up by turns; a motion that passes a limit
        of the driver; one that rests, or whose integral does not settle.
    """
    law = scene.driver.law
    if not isinstance(law, Released):
        raise CrankcheckError(f'{scene.name}: its driver follows a law; give it law = "free"')
    if scene.loads or scene.friction or any(one.damping for one in scene.springs.values()):
        raise CrankcheckError(
            f"{scene.name}: loads, dampers or friction put in energy or take it; a period is that "
            "of weights and springs alone"
        )
    arc = LimitedScene.of(scene, law.start_rad)
    machine = Machine(scene, Chart(arc, None))
    start = np.array([law.start_rad])
    speed = np.array([law.speed_rad_s])
    energy = float((machine.kinetic(start, speed) + machine.potential(start))[0])

    def left(phi: Array) -> Array:
        """What of the energy is left to move at driver angles."""
        return np.asarray(energy - machine.potential(phi))

    ends = _turning_points(arc, law, left, repeats_after(scene))
    if ends is None:
        turn = repeats_after(scene)

        def over(count: int) -> float:
            phi = law.start_rad + turn * (np.arange(count) + 0.5) / count
            return float(turn * np.mean(np.sqrt(0.5 * machine.inertia(phi)[0] / left(phi))))

        return Period(_settled(scene, over), None)
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])

    def swing(count: int) -> float:
        psi = math.pi * (np.arange(count) + 0.5) / count
        phi = middle - half * np.cos(psi)
        rate = np.sqrt(0.5 * machine.inertia(phi)[0] / left(phi))
        return float(2.0 * math.pi * np.mean(rate * half * np.sin(psi)))

    return Period(_settled(scene, swing), ends)


def _settled(scene: Scene, rule: Callable[[int], float]) -> float:
    """The value of a rule with more and more nodes. Raises CrankcheckError."""
    before = math.nan
    for count in COUNTS:
        value = rule(count)
        if abs(value - before) <= SAME * value:
            return value
        before = value
    raise CrankcheckError(f"{scene.name}: the integral of its period does not settle")


def _turning_points(
    arc: LimitedScene, law: Released, left: Callable[[Array], Array], turn: float
) -> tuple[float, float] | None:
    """The driver angles between which the motion swings, None where it turns over. Raises
    CrankcheckError where it passes a limit, or rests."""
    ends = []
    for way in (-1.0, 1.0):
        reach = turn
        if arc.limits is not None:
            limit = arc.limits[0 if way < 0.0 else 1]
            reach = abs(limit.driver_rad - law.start_rad)
        looks = law.start_rad + way * reach * np.linspace(0.0, 1.0 - 1e-9, SCAN)
        short = np.flatnonzero(left(looks)[1:] < 0.0)
        if short.size:
            k = int(short[0])
            ends.append(_zero(left, float(looks[k]), float(looks[k + 1])))
        elif arc.limits is not None:
            raise CrankcheckError(
                f"{arc.scene.name}: {arc.scene.driver.link} comes to its limit at "
                f"{math.degrees(limit.driver_rad):.6g} deg; its period is not that of a swing"
            )
    if not ends:
        return None
    if len(ends) < 2:
        raise CrankcheckError(
            f"{arc.scene.name}: what {arc.scene.driver.link} does not get over is narrower than "
            f"{math.degrees(turn / SCAN):.3g} deg; no period is told so near to a turn"
        )
    if ends[1] - ends[0] <= 2.0 * turn / SCAN:
        raise CrankcheckError(
            f"{arc.scene.name}: it rests where it is let go, or nearly; no period"
        )
    return ends[0], ends[1]


def _zero(left: Callable[[Array], Array], inside: float, outside: float) -> float:
    """Where nothing is left of the energy, to rounding; ``inside`` where that is so at once."""
    for _ in range(10):
        looks = np.linspace(inside, outside, 65)
        k = int(np.argmax(left(looks)[1:] < 0.0))
        inside, outside = float(looks[k]), float(looks[k + 1])
    return inside
