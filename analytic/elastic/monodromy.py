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

from analytic.elastic.linearised import LinearForm
from analytic.free.gauss import gauss
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


def by_collocation(form: LinearForm, period_s: float, windows: int) -> Monodromy:
    """By Gauss' collocation, of order 16, in so many windows of a period."""
    rule, h, m = gauss(NODES), period_s / windows, form.force.shape[1]
    times = (h * (np.arange(windows)[:, None] + rule.places)).ravel()
    mass, damping, stiffness, force = (
        own.reshape(windows, NODES, *own.shape[1:]) for own in _between(form, period_s, times)
    )
    # With accelerations a at the nodes: (M + h C A + h^2 K A^2) a = h - C v - K (y + c h v).
    once = rule.once
    twice = once @ once
    whole = np.einsum("ij,wiab->wiajb", h * h * twice, stiffness)
    whole += np.einsum("ij,wiab->wiajb", h * once, damping)
    whole[:, range(NODES), :, range(NODES)] += np.swapaxes(mass, 0, 1)
    x = np.concatenate([np.eye(2 * m), np.zeros((2 * m, 1))], axis=1)
    forced = np.zeros(2 * m + 1)
    forced[-1] = 1.0
    for w in range(windows):
        y, v = x[:m], x[m:]
        right = force[w][:, :, None] * forced - damping[w] @ v
        right -= stiffness[w] @ (y + h * rule.places[:, None, None] * v)
        size = NODES * m
        a = np.linalg.solve(whole[w].reshape(size, size), right.reshape(size, -1))
        a = a.reshape(NODES, m, -1)
        y = y + h * v + h * h * np.tensordot(rule.end_once @ once, a, 1)
        x = np.concatenate([y, v + h * np.tensordot(rule.end_once, a, 1)])
    return Monodromy(x[:, :-1], x[:, -1])


def by_newmark(form: LinearForm, period_s: float, steps: int) -> Monodromy:
    """By Newmark's method in so many steps of a period, of order 2, as in the thesis."""
    h, m = period_s / steps, form.force.shape[1]
    mass, damping, stiffness, force = _between(
        form, period_s, np.linspace(0.0, period_s, steps + 1)
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


def _between(form: LinearForm, period_s: float, time_s: Array) -> tuple[Array, ...]:
    """Mass, damping, stiffness and force at other times, by their Fourier series."""
    count = len(form.time_s)
    order = np.arange(count // 2 + 1)
    wave = np.exp(2j * np.pi / period_s * np.outer(time_s - form.time_s[0], order))
    wave[:, 1:] *= 2.0
    found = []
    for own in (form.mass, form.damping, form.stiffness, form.force):
        series = np.fft.rfft(own.reshape(count, -1), axis=0) / count
        found.append((wave @ series).real.reshape(len(time_s), *own.shape[1:]))
    return tuple(found)
