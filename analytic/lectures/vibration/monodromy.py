"""What a period makes of a deviation: the monodromy matrix, and Floquet's multipliers.

For M y'' + C y' + K y = h with coefficients that come back after T, the state x = (y, y') goes from
x(0) to Phi x(0) + p in a period. Its periodic motion starts at x0 = (I - Phi)^-1 p. Deviations grow
in a period as the eigenvalues of Phi: the motion is stable where none is larger than 1; where one
is 1 and h goes on pushing there is none (a resonance). Source: Thesis on vibration of planar
mechanisms with elastic links (2018), chapter 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.elastic.periodic import LinearForm
from analytic.free.window import gauss
from models.array import Array

NODES = 8
NEWMARK_GAMMA, NEWMARK_BETA = 0.5, 0.25
"""The mean acceleration over a step: stable at any, of order 2, and nothing is damped by it."""


@dataclass(frozen=True)
class Monodromy:
    """Phi (2 m, 2 m) and p (2 m,), of deflections and then rates."""

    matrix: Array
    particular: Array

    @property
    def multipliers(self) -> Array:
        """Floquet's multipliers, the largest first, (2 m,) complex."""
        found = np.linalg.eigvals(self.matrix)
        return np.asarray(found[np.argsort(-np.abs(found), kind="stable")])

    @property
    def from_resonance(self) -> float:
        """How near a multiplier comes to 1."""
        return float(np.abs(self.multipliers - 1.0).min())

    @property
    def start(self) -> tuple[Array, Array]:
        """Deflections and rates (m,) at the start of the periodic motion."""
        m = len(self.particular) // 2
        x = np.asarray(np.linalg.solve(np.eye(2 * m) - self.matrix, self.particular))
        return x[:m], x[m:]


@dataclass(frozen=True)
class Windows:
    """What each of W windows of a period makes of the state x at its start, and of forces at its
    NODES: ``carry`` (W, 2 m, 2 m) and ``push`` (W, 2 m, NODES m). By Gauss' collocation, of order
    16."""

    period_s: float
    carry: Array
    push: Array

    @staticmethod
    def of(form: LinearForm, period_s: float, count: int) -> Windows:
        """Those of linearised equations, ``count`` to a period."""
        rule, h, m = gauss(NODES), period_s / count, form.force.shape[1]
        mass, damping, stiffness = (
            at_nodes(own, count) for own in (form.mass, form.damping, form.stiffness)
        )
        # With accelerations a at the nodes: (M + h C A + h^2 K A^2) a = f - C v - K (y + c h v).
        once = rule.once
        twice, size = once @ once, NODES * m
        whole = (h * h * twice)[:, None, :, None] * stiffness[:, :, :, None, :]
        whole += (h * once)[:, None, :, None] * damping[:, :, :, None, :]
        whole[:, range(NODES), :, range(NODES)] += np.swapaxes(mass, 0, 1)
        by_rates = damping + h * rule.places[:, None, None] * stiffness
        state = np.concatenate([stiffness, by_rates], axis=3).reshape(count, size, 2 * m)
        ends = np.concatenate([h * h * (rule.end_once @ once)[None], h * rule.end_once[None]])
        lift = np.einsum("ei,ab->eaib", ends, np.eye(m)).reshape(2 * m, size)
        push = lift @ np.linalg.inv(whole.reshape(count, size, size))
        carry = -push @ state
        carry += np.eye(2 * m) + h * np.eye(2 * m, k=m)
        return Windows(period_s, carry, push)

    def over(self, force: Array) -> Monodromy:
        """What a period makes of a state with forces (N, m), at N instants of the period."""
        pushed = self._pushed(force)
        matrix, particular = np.eye(self.carry.shape[1]), np.zeros(self.carry.shape[1])
        for carry, own in zip(self.carry, pushed, strict=True):
            matrix, particular = carry @ matrix, carry @ particular + own
        return Monodromy(matrix, particular)

    def periodic(self, force: Array, monodromy: Monodromy) -> Array:
        """The deflections at the start of every window (W, m) that come back with these forces,
        whose `over` is ``monodromy``."""
        x = np.concatenate(monodromy.start)
        found = []
        for carry, own in zip(self.carry, self._pushed(force), strict=True):
            found.append(x[: len(x) // 2])
            x = carry @ x + own
        return np.array(found)

    def _pushed(self, force: Array) -> Array:
        count = len(self.carry)
        each = at_nodes(force, count).reshape(count, -1, 1)
        return np.asarray((self.push @ each)[:, :, 0])


def by_collocation(form: LinearForm, period_s: float, windows: int) -> Monodromy:
    """By Gauss' collocation in so many windows of a period."""
    return Windows.of(form, period_s, windows).over(form.force)


def by_newmark(form: LinearForm, period_s: float, steps: int) -> Monodromy:
    """By Newmark's method in so many steps of a period, of order 2, as in the thesis."""
    h, m = period_s / steps, form.force.shape[1]
    shares = np.linspace(0.0, 1.0, steps + 1)
    mass, damping, stiffness, force = (
        _between(own, shares) for own in (form.mass, form.damping, form.stiffness, form.force)
    )
    y = np.concatenate([np.eye(m), np.zeros((m, m + 1))], axis=1)
    v = np.concatenate([np.zeros((m, m)), np.eye(m), np.zeros((m, 1))], axis=1)
    forced = np.zeros(2 * m + 1)
    forced[-1] = 1.0
    a = np.linalg.solve(mass[0], np.outer(force[0], forced) - damping[0] @ v - stiffness[0] @ y)
    whole = mass + NEWMARK_GAMMA * h * damping + NEWMARK_BETA * h * h * stiffness
    inverse = np.linalg.inv(whole)
    for k in range(1, steps + 1):
        y = y + h * v + (0.5 - NEWMARK_BETA) * h * h * a
        v = v + (1.0 - NEWMARK_GAMMA) * h * a
        a = inverse[k] @ (np.outer(force[k], forced) - damping[k] @ v - stiffness[k] @ y)
        y, v = y + NEWMARK_BETA * h * h * a, v + NEWMARK_GAMMA * h * a
    x = np.concatenate([y, v])
    return Monodromy(x[:, :-1], x[:, -1])


def at_nodes(own: Array, windows: int) -> Array:
    """What is known at an odd number of instants of a period, (N, ...), at the nodes of so many
    windows of it, (W, NODES, ...), by its Fourier series."""
    shares = (np.arange(windows)[:, None] + gauss(NODES).places) / windows
    return _between(own, shares)


def _between(own: Array, shares: Array) -> Array:
    """The same at shares of the period (W, ...): in rows of W, as the threads of a product of large
    matrices cost more than they gain."""
    count = len(own)
    series = np.fft.rfft(own.reshape(count, -1), axis=0) / count
    series[1:] *= 2.0
    angle = 2.0 * np.pi * shares.reshape(len(shares), -1, 1) * np.arange(len(series))
    found = np.cos(angle) @ series.real - np.sin(angle) @ series.imag
    return np.asarray(found.reshape(*shares.shape, *own.shape[1:]))
