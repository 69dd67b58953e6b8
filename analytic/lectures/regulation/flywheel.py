"""Flywheel for a wanted evenness of speed: exact, and as the textbooks draw it.

::

    W  work since the start              the steeper line, of slope tan psi_max, touches the closed
    |        _B__ /                      curve from above; tan psi_min touches it from below. They
    |      /    |/                       meet in the origin of the energy-mass diagram, which lies a
    |     (    /|                        flywheel to the left of where the curve's J begins.
    |    /`--A' |
    +---------------- J  own reduced moment of inertia

With k = w^2 / 2 of the largest and the smallest speed, w = mean (1 +- delta/2), the flywheel is
(max(W - k_max J) - min(W - k_min J)) / (k_max - k_min). That is exact where no torque follows the
speed; else W is that of the cycle with the flywheel, and is found with it.

Sources: F. Wittenbauer, Graphische Dynamik (the tangents); I. I. Artobolevskii, Theory of
Mechanisms, on flywheels (own inertia at mean speed, after N. I. Mertsalov); problem book "Bai tap
co hoc may", chapter on real motion and its regulation (surplus of work).
"""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from analytic.lectures.regulation.periodic_solution import StallError
from analytic.lectures.regulation.steady_cycle import SteadyCycle, cycle_of, steady_cycle
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.array import Array
from models.errors import CrankcheckError

MOST_TRIES = 40
MET = 1e-12
"""Relative error of the coefficient."""
LEAST = 1e-6
"""Smallest coefficient: below it `MET` is less than the rounding of a speed."""
EVEN = 1e-4
"""Share of a coefficient that changes no torque."""
FINER = 20
"""Samples of a curve per sample of the cycle."""


class CoefficientError(CrankcheckError):
    """Coefficient of fluctuation without a flywheel."""


@dataclass(frozen=True)
class EnergyMass:
    """Wittenbauer's diagram: the work W since the start [J] over the machine's own reduced moment
    of inertia J [kg m^2], (T,) each."""

    inertia: Array
    work: Array

    def tangent(self, slope: float, *, above: bool) -> tuple[float, int]:
        """Return the value at J = 0 [J] of a tangent with a slope [J/(kg m^2)], and the sample that
        it touches."""
        height = self.work - slope * self.inertia
        at = int(np.argmax(height) if above else np.argmin(height))
        return float(height[at]), at


@dataclass(frozen=True)
class Approximations:
    """Flywheels [kg m^2] of the textbooks, with torques as at the mean speed.

    ``by_surplus`` is the surplus of work over delta w^2, less the mean of the machine's own moment
    of inertia. ``by_own_energy`` subtracts the energy of its variable part, at the mean speed, from
    the work; the rest, its minimum, turns as a flywheel does. ``by_tangents`` are Wittenbauer's,
    with tan psi = w^2 (1 +- delta) / 2.
    """

    by_surplus: float
    by_own_energy: float
    by_tangents: float


@dataclass(frozen=True)
class WantedFlywheel:
    """Flywheel of ``inertia_kg_m2`` on the driver, with the resulting ``cycle`` of the coefficient
    of fluctuation ``delta``; ``bare`` is the cycle without it, None where the machine stops."""

    delta: float
    inertia_kg_m2: float
    cycle: SteadyCycle
    bare: SteadyCycle | None
    approximations: Approximations

    @property
    def slopes(self) -> tuple[float, float]:
        """tan psi_max and tan psi_min, half the squares of the extreme speeds [J/(kg m^2)]."""
        high, low = self.cycle.extreme_speeds_rad_s
        return 0.5 * high**2, 0.5 * low**2

    @property
    def diagram(self) -> EnergyMass:
        """Diagram of the cycle with the flywheel, whose energy is not in it."""
        return energy_mass(self.cycle)


def wanted_flywheel(scene_machine: TurningMachine, delta: float) -> WantedFlywheel:
    """Find the flywheel for a coefficient of fluctuation. Raises CrankcheckError for an invalid
    coefficient, or one that the machine keeps without a flywheel; no steady cycle."""
    _check(delta)
    machine, bare = scene_machine, None
    with suppress(StallError):
        bare = cycle_of(machine)
        machine = bare.machine  # turning as its loads turn it
    if bare is not None and bare.delta <= delta:
        raise CrankcheckError(
            f"{machine.scene.name}: no flywheel is needed for a coefficient of {delta:g}: the "
            f"machine has {bare.delta:.4g} without it; give a smaller one"
        )
    least = _heavy(machine, delta)
    near = _classical(least, delta)
    cycle = _exact(machine, delta, max(near.by_tangents, 1e-9 * least.solution.flywheel))
    return WantedFlywheel(delta, cycle.solution.flywheel, cycle, bare, near)


def _check(delta: float) -> None:
    if delta == 0.0:
        why = "an even run needs an infinite flywheel; give one above 0, such as 0.02"
    elif not 0.0 < delta < 2.0:  # or no number
        why = (
            "a machine that keeps turning has one above 0 and below 2, usual ones are 0.005 to 0.2"
        )
    elif delta < LEAST:
        why = f"rounding hides so small a fluctuation of speed; give {LEAST:g} or more"
    else:
        return
    raise CoefficientError(f"delta {delta:g}: {why}")


def _heavy(machine: TurningMachine, delta: float) -> SteadyCycle:
    """Return the cycle with a very large flywheel: torques are those of constant speed."""
    own = machine.inertia(np.linspace(0.0, machine.cycle_rad, 361))[0]
    inertia = 10.0 * float(np.max(own)) or 1.0
    for _ in range(MOST_TRIES):
        try:
            cycle = steady_cycle(machine, inertia)
        except StallError:
            inertia *= 10.0
            continue
        if cycle.delta <= EVEN * delta:
            return cycle
        inertia *= 2.0 * cycle.delta / (EVEN * delta)
    raise CrankcheckError(
        f"{machine.scene.name}: no flywheel up to {inertia:.3g} kg m^2 makes it run with a "
        f"coefficient of {delta:g}; check its loads"
    )


def energy_mass(cycle: SteadyCycle) -> EnergyMass:
    """Return the diagram of a cycle; the moment of inertia is without the added flywheel."""
    u = np.linspace(0.0, cycle.machine.cycle_rad, FINER * (len(cycle.fine) - 1) // 4 + 1)
    u = np.unique(np.concatenate([u, cycle.solution.cells.borders, [cycle.fastest, cycle.slowest]]))
    energy = cycle.energy(u)
    return EnergyMass(cycle.machine.inertia(u)[0], energy - cycle.solution.at_borders[0])


def _classical(heavy: SteadyCycle, delta: float) -> Approximations:
    """Return the approximations, from torques at constant speed."""
    square = heavy.mean_rad_s**2
    mean = float(np.mean(heavy.machine.inertia(heavy.fine[:-1])[0]))
    above, below = heavy.heights(0.5 * square)
    steep = heavy.heights(0.5 * square * (1.0 + delta))[0]
    flat = heavy.heights(0.5 * square * (1.0 - delta))[1]
    return Approximations(
        by_surplus=heavy.surplus_j / (delta * square) - mean,
        by_own_energy=(above - below) / (delta * square) - heavy.own_inertia_range[0],
        by_tangents=(steep - flat) / (delta * square),
    )


def _exact(machine: TurningMachine, delta: float, first: float) -> SteadyCycle:
    """Return the cycle of the coefficient, by the secant method: 1 / delta is nearly linear in its
    inertia."""
    tried: list[tuple[float, SteadyCycle]] = []
    inertia = first
    for _ in range(MOST_TRIES):
        try:
            cycle = steady_cycle(machine, inertia)
        except StallError:
            inertia *= 2.0
            continue
        tried.append((inertia, cycle))
        if abs(cycle.delta / delta - 1.0) <= MET:
            return cycle
        if len(tried) > 2 and abs(tried[-1][0] / tried[-2][0] - 1.0) <= 1e-15:
            return cycle
        inertia = _next(tried, delta)
    best = min(
        (cycle for _, cycle in tried), key=lambda each: abs(each.delta - delta), default=None
    )
    if best is not None and abs(best.delta / delta - 1.0) <= 1e-9:
        return best
    raise CrankcheckError(
        f"{machine.scene.name}: no flywheel was found for a coefficient of {delta:g}; give another"
    )


def _next(tried: list[tuple[float, SteadyCycle]], delta: float) -> float:
    inertia, cycle = tried[-1]
    off = 1.0 / cycle.delta - 1.0 / delta
    own = cycle.own_inertia_range[0]
    if len(tried) < 2:
        found = (inertia + own) * cycle.delta / delta - own
    else:
        before, other = tried[-2]
        slope = (1.0 / cycle.delta - 1.0 / other.delta) / (inertia - before)
        found = inertia - off / slope if slope > 0.0 else 2.0 * inertia
    return min(max(found, 0.2 * inertia), 5.0 * inertia)
