"""The equations of motion of an assembly: accelerations and multipliers at a state.

    M q'' + Phi_q^T lambda = Q(q, q', t)        Phi_q q'' = gamma - 2 alpha Phi_q q' - beta^2 Phi

with Baumgarte's terms, by which violations of constraints decay, on the right side of the
accelerations; without them alpha and beta are 0. Source: J. Baumgarte, Stabilization of constraints
and integrals of motion in dynamical systems, Comp. Meth. Appl. Mech. Eng. 1, 1972.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack  # type: ignore[import-untyped]  # ships no stubs
from scipy.sparse import csc_array  # type: ignore[import-untyped]
from scipy.sparse.linalg import splu  # type: ignore[import-untyped]

from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration, EnergyBalance
from analytic.multibody.generalised_forces import GeneralisedForces, Strokes
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, SliderForces

WEAK = 1e-2
"""Singular value over the largest below which, in a change point, it counts as 0."""
MOST_PROJECTIONS = 20
NEAR = 1e-9
"""Step of a projection, over the longest link or in radians, whose square is below rounding."""


@dataclass(frozen=True)
class Dynamics:
    """Undriven assembly with its forces; ``rank`` is the number of independent constraints;
    ``alpha``, ``beta`` [1/s] of Baumgarte."""

    assembly: Assembly
    forces: GeneralisedForces
    rank: int
    alpha: float = 0.0
    beta: float = 0.0

    @property
    def redundant(self) -> bool:
        """True if some of the constraints follow from others."""
        return self.rank < self.assembly.joints.count

    def solve(self, time_s: Array, now: Configuration) -> tuple[Array, Array]:
        """Return q'' (T, n) and the multipliers (T, m) at times [s]. Raises CrankcheckError where
        they are not determined, and as `GeneralisedForces.on`."""
        return self._solved(time_s, now, self.forces.on(time_s, now))

    def _solved(self, time_s: Array, now: Configuration, pushed: Array) -> tuple[Array, Array]:
        assembly = self.assembly
        jacobian = assembly.joints.jacobian(now)
        mass, top = assembly.weigh(now.q, now.rates)
        top += pushed
        bottom = assembly.joints.gamma(now)
        if self.alpha or self.beta:
            open_rate = (jacobian @ now.rates[:, :, None])[:, :, 0]
            bottom = (
                bottom - 2.0 * self.alpha * open_rate - self.beta**2 * assembly.joints.gaps(now)
            )
        seconds, multipliers = np.empty_like(now.q), np.empty_like(bottom)
        for i in range(len(now.q)):
            try:
                saddle = Saddle(mass[i], jacobian[i], redundant=self.redundant)
            except CrankcheckError as error:
                name = assembly.scene.name
                raise CrankcheckError(f"{name}: at {time_s[i]:g} s {error}") from None
            seconds[i], multipliers[i] = saddle.solve(top[i], bottom[i])
        return seconds, multipliers

    def multipliers(self, time_s: Array, now: Configuration, seconds: Array) -> Array:
        """Return the smallest multipliers (T, m) that belong to accelerations q'' (T, n)."""
        mass, right = self.assembly.weigh(now.q, now.rates)
        right += self.forces.on(time_s, now) - (mass @ seconds[:, :, None])[:, :, 0]
        rows = np.swapaxes(self.assembly.joints.jacobian(now), 1, 2)
        each = zip(rows, right, strict=True)
        return np.array([np.linalg.lstsq(a, b, rcond=WEAK)[0] for a, b in each])

    def rates(self, time_s: float, state: Array, strokes: Strokes) -> Array:
        """Return the derivative of a state by time: of q, q' and the work of loads and dampers;
        ``strokes`` decides which loads act, whichever way their sliders move."""
        n, at = self.assembly.size, np.array([time_s])
        now = self.assembly.at_rates(state[None, :n], state[None, n : 2 * n])
        pushed = self.forces.on(at, now, strokes)
        seconds, _ = self._solved(at, now, pushed)
        return np.concatenate([now.rates[0], seconds[0], self.power(now, pushed)])

    def power(self, now: Configuration, pushed: Array) -> Array:
        """Return the non-conservative power of generalised forces (T, n) [W], (T,)."""
        power = (pushed * now.rates).sum(axis=1)
        for deflection in self.forces.deflections(now):  # what springs take up they keep
            power += (
                deflection.spring.rate * (deflection.q - deflection.spring.free) * deflection.rate
            )
        return np.asarray(power - self.assembly.lost(now.rates))

    def energies(self, now: Configuration, work: Array) -> EnergyBalance:
        """Return the energies at a configuration, with the work until then [J]."""
        assembly = self.assembly
        pushed = (assembly.mass(now.q) @ now.rates[:, :, None])[:, :, 0]
        potential = assembly.height_energy(now.q)
        for deflection in self.forces.deflections(now):
            spring = deflection.spring
            potential = potential + 0.5 * spring.rate * (deflection.q - spring.free) ** 2
        return EnergyBalance(0.5 * (now.rates * pushed).sum(axis=1), potential, work)

    def closed(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """Return the coordinates (T, n) on the constraints next to the given ones, in the norm of
        the mass matrix, and the rates that the constraints allow."""
        assembly = self.assembly
        unit = max(1.0, assembly.scene.longest_m)
        now = assembly.at_rest(q)
        pairs = zip(assembly.mass(q), assembly.joints.jacobian(now), strict=True)
        saddles = [Saddle(*pair, redundant=self.redundant) for pair in pairs]

        def closing(gaps: Array) -> Array:
            each = zip(saddles, gaps, strict=True)
            return np.array([saddle.solve(0.0, -own)[0] for saddle, own in each]).reshape(q.shape)

        for _ in range(MOST_PROJECTIONS):
            step = closing(assembly.joints.gaps(now))
            now = assembly.at_rest(now.q + step)
            if np.abs(step).max(initial=0.0) <= NEAR * unit:
                break
        opening = (assembly.joints.jacobian(now) @ rates[:, :, None])[:, :, 0]
        return now.q, rates + closing(opening)

    def closed_state(self, state: Array) -> Array:
        """Project a state of q, q' and the work, (2 n + 1,), onto the constraints."""
        n = self.assembly.size
        q, rates = self.closed(state[None, :n], state[None, n : 2 * n])
        return np.concatenate([q[0], rates[0], state[2 * n :]])


SOFT = 1e-7
"""Regularisation s of a redundant system, over the largest entry of its inverse mass."""
ROUNDS = 3
"""Number of corrections of a redundant system by its residual."""
SINGULAR = (
    "the equations of motion are singular: a freedom has no mass, or the mechanism is at a change "
    "point, where accelerations are not determined"
)
SPARSE = 150
"""Number of unknowns from which on a sparse factorisation is quicker."""


class Saddle:
    """Linear system of a mass matrix (n, n) and a Jacobian (m, n); ``redundant`` if the rows of the
    Jacobian depend on each other. Raises CrankcheckError for a singular one.

    ::

        | M      Phi_q^T |  | x      |     | top    |
        | Phi_q  -s      |  | lambda |  =  | bottom |

    Where constraints are redundant the system with s = 0 is singular, though x is determined. A
    small s makes it regular; corrected by its residual, the solution with s converges to that with
    s = 0 and the smallest multipliers (the proximal point method: each time the residual shrinks by
    s over the least non-zero singular value of Phi_q M^-1 Phi_q^T).
    """

    def __init__(self, mass: Array, jacobian: Array, *, redundant: bool) -> None:
        m, n = jacobian.shape
        self._count, self._redundant = n, redundant
        whole = np.zeros((n + m, n + m))
        whole[:n, :n], whole[n:, :n], whole[:n, n:] = mass, jacobian, jacobian.T
        self._soft = np.zeros(n + m)
        if redundant:
            lightest = np.diagonal(mass)[np.diagonal(mass) > 0.0].min()
            self._soft[n:] = SOFT / lightest
            whole[range(n, n + m), range(n, n + m)] = -self._soft[n:]
        self._whole = whole
        if len(whole) < SPARSE:
            *self._factors, singular = lapack.dgetrf(whole.T)  # symmetric: its rows are columns
            if singular > 0:
                raise CrankcheckError(SINGULAR)
        else:
            try:
                self._sparse = splu(csc_array(whole))
            except RuntimeError:
                raise CrankcheckError(SINGULAR) from None

    def solve(self, top: Array | float, bottom: Array | float) -> tuple[Array, Array]:
        """Return x (n,) and lambda (m,)."""
        right = np.empty(len(self._whole))
        right[: self._count], right[self._count :] = top, bottom
        found = self._once(right)
        if self._redundant:
            for _ in range(ROUNDS):
                left = right - self._whole @ found - self._soft * found
                found = found + self._once(left)
        return found[: self._count], found[self._count :]

    def _once(self, right: Array) -> Array:
        if len(self._whole) < SPARSE:
            return np.asarray(lapack.dgetrs(*self._factors, right)[0])
        return np.asarray(self._sparse.solve(right))


def joint_forces(assembly: Assembly, time_s: Array, multipliers: Array, torque: Array) -> Forces:
    """Return the multipliers of the equations of joints, in their order (T, m), as forces, with the
    driving torque (T,)."""
    pins: dict[str, dict[str, Array]] = {}
    row = 0
    for point, first, other in assembly.joints.pin_pairs():
        push = multipliers[:, row : row + 2]
        held = pins.setdefault(point, {})
        held[first] = held.get(first, 0.0) + push
        held[other] = held.get(other, 0.0) - push
        row += 2
    sliders: dict[str, SliderForces] = {}
    for name in assembly.scene.sliders:
        sliders[name] = SliderForces(multipliers[:, row], multipliers[:, row + 1])
        row += 2
    return Forces(time_s, pins, sliders, torque)
