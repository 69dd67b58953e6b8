"""Stability of a periodic motion of elastic links, and orders of their vibration about it.

A deviation from the periodic motion is multiplied by Phi in every period. An eigenvalue of it,
exp((s + i p) 2 pi), gives the growth of a mode, and its p vibrations in a period, but for a whole
number, which the natural frequency of the mechanism held still decides. The periodic force
resonates with the mode if p is whole; if p of one mode is a half, or those of two make a whole
number, the turning of the mechanism may feed the vibration itself (parametric resonance).

For M y'' + C y' + K y = h with coefficients of period T, the state x = (y, y') goes from x(0) to
Phi x(0) + p in a period. Its periodic motion starts at x0 = (I - Phi)^-1 p. Deviations grow in a
period as the eigenvalues of Phi: the motion is stable if none is larger than 1; if one is 1 and h
acts on it there is none (a resonance).

Source: Thesis on vibration of planar mechanisms with elastic links (2018), chapter 4; A. H. Nayfeh,
D. T. Mook, Nonlinear Oscillations, chapter 5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.natural import NaturalModes, natural_modes
from analytic.elastic.periodic import LinearForm, PeriodicMotion, linearise
from analytic.elastic.reduced import ReducedForm
from analytic.free.window import gauss
from models.array import Array

NODES = 8


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
    def start(self) -> tuple[Array, Array]:
        """Deflections and rates (m,) at the start of the periodic motion."""
        m = len(self.particular) // 2
        x = np.asarray(np.linalg.solve(np.eye(2 * m) - self.matrix, self.particular))
        return x[:m], x[m:]


@dataclass(frozen=True)
class Windows:
    """Maps of W windows of a period from the state x at their start, and from forces at their
    NODES: ``carry`` (W, 2 m, 2 m) and ``push`` (W, 2 m, NODES m). By Gauss' collocation, of order
    16."""

    period_s: float
    carry: Array
    push: Array

    @staticmethod
    def of(form: LinearForm, period_s: float, count: int) -> Windows:
        """Make the windows of linearised equations, ``count`` to a period."""
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
        """Return the map of a period with forces (N, m), at N instants of the period."""
        pushed = self._pushed(force)
        matrix, particular = np.eye(self.carry.shape[1]), np.zeros(self.carry.shape[1])
        for carry, own in zip(self.carry, pushed, strict=True):
            matrix, particular = carry @ matrix, carry @ particular + own
        return Monodromy(matrix, particular)

    def periodic(self, force: Array, monodromy: Monodromy) -> Array:
        """Return the periodic deflections at the start of every window (W, m) under these forces,
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
    """Integrate by Gauss' collocation in so many windows of a period."""
    return Windows.of(form, period_s, windows).over(form.force)


def at_nodes(own: Array, windows: int) -> Array:
    """Return values at an odd number of instants of a period, (N, ...), at the nodes of so many
    windows of it, (W, NODES, ...), by their Fourier series: in rows of W, as the threads of a
    product of large matrices cost more than they gain."""
    shares = (np.arange(windows)[:, None] + gauss(NODES).places) / windows
    count = len(own)
    series = np.fft.rfft(own.reshape(count, -1), axis=0) / count
    series[1:] *= 2.0
    angle = 2.0 * np.pi * shares[:, :, None] * np.arange(len(series))
    found = np.cos(angle) @ series.real - np.sin(angle) @ series.imag
    return np.asarray(found.reshape(*shares.shape, *own.shape[1:]))


STABLE = 1e-6
"""Allowed excess of a multiplier over 1: derivatives are differences, and windows round."""
RADIANS = 3.0
"""Angle of the fastest mode in a window of the integration."""
FEWEST, MOST = 24, 480
"""Windows of a period. Modes that are too fast for them are integrated, and not shown."""


@dataclass(frozen=True)
class Deviation:
    """Pair of multipliers of ``mode``, counted from 1 by its natural frequency. ``order`` is the
    number of its vibrations in a period, NaN where it is too fast, ``natural`` that of the
    mechanism held still, in the mean."""

    mode: int
    multiplier: complex
    order: float
    natural: float

    @property
    def size(self) -> float:
        """Growth in a period."""
        return abs(self.multiplier)


@dataclass(frozen=True)
class Stability:
    """All deviations of a periodic motion, the lowest mode first, and the map of a period."""

    deviations: tuple[Deviation, ...]
    monodromy: Monodromy

    @property
    def largest(self) -> float:
        """Size of the largest multiplier."""
        return float(np.abs(self.monodromy.multipliers).max(initial=0.0))

    @property
    def is_stable(self) -> bool:
        return self.largest <= 1.0 + STABLE


def stability_of(form: ReducedForm, motion: PeriodicMotion) -> Stability:
    """Return the stability of a periodic motion of the full equations."""
    time_s = motion.time_s
    scale = 1e-2 * float(np.abs(motion.z).max()) or 1e-6 * form.assembly.scene.longest_m
    linear = linearise(form, time_s, scale, motion.at(time_s))
    return stability(linear, form.period_s)


def stability(linear: LinearForm, period_s: float, highest: float = math.inf) -> Stability:
    """Return the stability of linearised equations at an odd number of instants of a period; modes
    of orders above ``highest`` need no order."""
    modes = natural_modes(linear.mass, linear.stiffness)
    windows = window_count(modes, period_s, highest)
    return looked_at(by_collocation(linear, period_s, windows), windows, linear, modes, period_s)


def window_count(modes: NaturalModes, period_s: float, highest: float) -> int:
    """Return the sufficient number of windows of a period for modes up to an order."""
    fastest = min(float(modes.mean_rad_s.max()) * period_s / math.tau, highest)
    return min(max(math.ceil(fastest * math.tau / RADIANS), FEWEST), MOST)


def looked_at(
    monodromy: Monodromy, windows: int, linear: LinearForm, modes: NaturalModes, period_s: float
) -> Stability:
    """Return the stability from a monodromy matrix of linearised equations, by so many windows of a
    period, with known modes: pairs of multipliers belong to the mode with most of their energy as a
    period begins."""
    orders = modes.mean_rad_s * period_s / math.tau
    resolved = orders * math.tau <= 1.5 * RADIANS * windows
    m = len(orders)
    multipliers, vectors = np.linalg.eig(monodromy.matrix)
    upper = _pairs(multipliers)
    coordinates = modes.shape[0].T @ linear.mass[0]
    places, rates = coordinates @ vectors[:m, upper], coordinates @ vectors[m:, upper]
    energy = np.abs(rates) ** 2 + modes.frequency_rad_s[0][:, None] ** 2 * np.abs(places) ** 2
    shares = energy / energy.sum(axis=0)
    mode, pair = linear_sum_assignment(-shares)
    found = []
    for k, own in zip(mode, pair, strict=True):
        multiplier = complex(multipliers[upper[own]])
        order = _unwrapped(multiplier, float(orders[k])) if resolved[k] else math.nan
        found.append(Deviation(int(k) + 1, multiplier, order, float(orders[k])))
    return Stability(tuple(found), monodromy)


def _pairs(multipliers: Array) -> list[int]:
    """Return one of each pair: the upper of complex ones, every second of the real ones by size."""
    real = np.flatnonzero(np.abs(multipliers.imag) <= 1e-12 * np.abs(multipliers))
    real = real[np.argsort(-np.abs(multipliers[real]), kind="stable")]
    above = np.flatnonzero(multipliers.imag > 1e-12 * np.abs(multipliers))
    count = len(multipliers) // 2 - len(above)
    return [int(k) for k in (*above, *real[:count])]


def _unwrapped(multiplier: complex, near: float) -> float:
    """Return the vibrations in a period: its angle up to whole turns and its sign."""
    part = abs(np.angle(multiplier)) / math.tau
    whole = math.floor(near)
    every = [n + sign * part for n in (whole - 1, whole, whole + 1, whole + 2) for sign in (1, -1)]
    return float(min(every, key=lambda order: abs(order - near)))
