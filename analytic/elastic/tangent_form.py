"""Equations of an undriven mechanism in coordinates in the tangent of its position.

At a closed position the directions that the joints allow, V, and those that they do not, W, are
columns of one orthogonal matrix (in the units of coordinates, for those of links alone: the
coefficients of elastic ones stay as they are). Every closed position near by has one y::

    q = q0 + V y + W s(y)      q' = B y'      q'' = B y'' + c

    B^T M B y'' = B^T (Q - M c)

so there are as many y as freedoms, rigid and elastic alike; no multipliers, no drift from the
joints, and no leading coordinate: a crank may turn back. The tangent is taken anew along the
motion. Source: E. J. Haug, J. Yen, Implicit Numerical Integration of Constrained Equations of
Motion, Mech. Struct. Mach. 19, 1991 (tangent space parametrisation).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.multibody.bodies import Configuration
from analytic.multibody.dynamics import Dynamics
from models.array import Array
from models.errors import CrankcheckError

MOST_STEPS = 20
CLOSED = 1e-9
"""Step of Newton's method, in the units of coordinates, after which none is taken: its square is
below rounding."""
INDEPENDENT = 1e-7
"""Singular value over the largest, from which on rows count as independent of each other."""
NUDGE = 1e-7
"""Change of y for derivatives; rates change by the same over their own size."""


@dataclass(frozen=True)
class Tangent:
    """Closed position ``q`` (n,), the directions ``free`` (n, f) that the joints allow there and
    the others, ``held`` (n, r); ``rows`` (m, r) combine the equations of joints to the independent
    ones."""

    q: Array
    free: Array
    held: Array
    rows: Array


@dataclass(frozen=True)
class FreeInstant:
    """Equations at T samples: ``now`` is the configuration, ``by`` B (T, n, f), ``gained`` c (T,
    n); ``mass`` M (T, n, n), ``pushed`` Q (T, n), and its part from loads, springs and dampers,
    ``applied``."""

    now: Configuration
    by: Array
    gained: Array
    mass: Array
    pushed: Array
    applied: Array

    @cached_property
    def inertia(self) -> Array:
        """B^T M B, (T, f, f)."""
        return np.asarray(np.swapaxes(self.by, 1, 2) @ self.mass @ self.by)

    @cached_property
    def seconds(self) -> Array:
        """y'' (T, f)."""
        right = (self.pushed - (self.mass @ self.gained[:, :, None])[:, :, 0])[:, :, None]
        right = np.swapaxes(self.by, 1, 2) @ right
        return np.asarray(np.linalg.solve(self.inertia, right)[:, :, 0])

    @property
    def all_seconds(self) -> Array:
        """q'' (T, n)."""
        return np.asarray((self.by @ self.seconds[:, :, None])[:, :, 0] + self.gained)

    @property
    def held(self) -> Array:
        """Forces of the joints on the coordinates, (T, n)."""
        return np.asarray((self.mass @ self.all_seconds[:, :, None])[:, :, 0] - self.pushed)


@dataclass(frozen=True)
class TangentForm:
    """Equations of motion of an undriven mechanism."""

    dynamics: Dynamics

    def tangent(self, q: Array) -> Tangent:
        """Return the tangent at a closed position (n,).

        The coefficients of elastic links are among the y unchanged, as the stiff terms are linear
        in them, except where the links would lock each other if they were rigid.
        """
        assembly = self.dynamics.assembly
        units, rank = assembly.units, self.dynamics.rank
        jacobian = assembly.joints.jacobian(assembly.at_rest(q[None]))[0] * units
        turning = np.delete(np.arange(len(q)), assembly.coefficients)
        rows, sizes, directions = np.linalg.svd(jacobian[:, turning])
        own = assembly.coefficients
        if len(sizes) < rank or sizes[rank - 1] <= INDEPENDENT * sizes[0]:
            rows, _, directions = np.linalg.svd(jacobian)
            turning, own = np.arange(len(q)), own[:0]
        across = np.zeros((len(q), len(q)))
        across[np.ix_(turning, np.arange(len(turning)))] = directions.T
        across[own, len(turning) + np.arange(len(own))] = 1.0
        across *= units[:, None]
        return Tangent(q, across[:, rank:], across[:, :rank], rows[:, :rank])

    def coordinates(self, at: Tangent, rates: Array) -> Array:
        """Return the y' (f,) of rates (n,) that the joints allow at the position of a tangent."""
        units = self.dynamics.assembly.units
        return np.asarray((at.free / units[:, None]).T @ (rates / units))

    def at(self, time_s: Array, at: Tangent, y: Array, rates: Array) -> FreeInstant:
        """Return the equations at times [s] (T,), for y and their rates (T, f). Raises
        CrankcheckError where the joints can not be closed."""
        assembly = self.dynamics.assembly
        q = self._closed(at, y)
        rest = assembly.at_rest(q)
        jacobian = at.rows.T @ assembly.joints.jacobian(rest)
        held = jacobian @ at.held
        by = at.free - at.held @ np.linalg.solve(held, jacobian @ at.free)
        now = assembly.at_rates(q, (by @ rates[:, :, None])[:, :, 0])
        gamma = assembly.joints.gamma(now) @ at.rows
        gained = np.linalg.solve(held, gamma[:, :, None])[:, :, 0] @ at.held.T
        mass, right = assembly.weigh(now.q, now.rates)
        applied = self.dynamics.forces.on(time_s, now)
        return FreeInstant(now, by, gained, mass, right + applied, applied)

    def _closed(self, at: Tangent, y: Array) -> Array:
        """Return the closed positions (T, n) next to a tangent, by Newton's method."""
        assembly = self.dynamics.assembly
        q, last = at.q + y @ at.free.T, np.inf
        for _ in range(MOST_STEPS):
            now = assembly.at_rest(q)
            held = at.rows.T @ assembly.joints.jacobian(now) @ at.held
            gaps = assembly.joints.gaps(now) @ at.rows
            step = np.linalg.solve(held, -gaps[:, :, None])[:, :, 0]
            q = q + step @ at.held.T
            size = float(np.abs(step).max(initial=0.0))
            if size <= CLOSED or (size < 1e-9 and size >= 0.5 * last):
                return np.asarray(q)
            last = size
        raise CrankcheckError(
            f"{assembly.scene.name}: the joints can not be closed: its elastic links have bent or "
            "stretched too far"
        )

    def derivatives(self, time_s: float, at: Tangent, y: Array, rates: Array) -> Array:
        """Return the derivatives of y'' by y and by y', (f, 2 f), at one state, by differences:
        they hold all stiff terms of elastic links, springs and the driver's control."""
        count = len(rates)
        quick = NUDGE * max(float(np.abs(rates).max()), 1.0)
        by_y, by_rates = np.zeros((2 * count + 1, count)), np.zeros((2 * count + 1, count))
        by_y[1 : 1 + count], by_rates[1 + count :] = NUDGE * np.eye(count), quick * np.eye(count)
        seconds = self.at(np.full(len(by_y), time_s), at, y + by_y, rates + by_rates).seconds
        change = (seconds[1:] - seconds[0]).T
        return np.asarray(change / np.repeat([NUDGE, quick], count))

    def multipliers(self, at: Tangent, instant: FreeInstant) -> Array:
        """Return the smallest multipliers of the equations of joints, (T, m)."""
        jacobian = self.dynamics.assembly.joints.jacobian(instant.now)
        across = np.swapaxes(at.rows.T @ jacobian @ at.held, 1, 2)
        right = -(instant.held @ at.held)[:, :, None]
        return np.asarray(np.linalg.solve(across, right)[:, :, 0] @ at.rows.T)
