"""Whether a periodic motion of elastic links is stable, and at which orders they vibrate about it.

A deviation from the periodic motion is multiplied by Phi in every period. An eigenvalue of it,
exp((s + i p) 2 pi), says by how much a mode grows, and that it vibrates p times in a period, but
for a whole number: which one, the natural frequency of the mechanism held still tells. Where p is
whole, the periodic force resonates with the mode; where p of one mode is a half, or those of two
make a whole number, the turning of the mechanism may feed the vibration itself (parametric
resonance). Source: Thesis on vibration of planar mechanisms with elastic links (2018), chapter 4;
A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations, chapter 5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.natural import NaturalModes, natural_modes
from analytic.elastic.periodic import LinearForm, PeriodicMotion, linearise
from analytic.elastic.reduced import ReducedForm
from analytic.lectures.vibration.monodromy import Monodromy, by_collocation
from models.array import Array, Mask

STABLE = 1e-6
"""What a multiplier may be larger than 1 by: derivatives are differences, and windows round."""
RADIANS = 3.0
"""What the fastest mode turns in a window of the integration."""
FEWEST, MOST = 24, 480
"""Windows of a period. Modes that are too fast for them are integrated, and not told of."""


@dataclass(frozen=True)
class Deviation:
    """A pair of multipliers: those of ``mode``, counted from 1 by its natural frequency. ``order``
    is how often it vibrates in a period, NaN where it is too fast to be told, ``natural`` that of
    the mechanism held still, in the mean."""

    mode: int
    multiplier: complex
    order: float
    natural: float

    @property
    def size(self) -> float:
        """What a period multiplies it by."""
        return abs(self.multiplier)

    @property
    def from_whole(self) -> float:
        """How far the order is from a whole number."""
        return abs(self.order - round(self.order)) if math.isfinite(self.order) else math.nan


@dataclass(frozen=True)
class Stability:
    """All deviations of a periodic motion, the lowest mode first, and what a period makes of
    them."""

    deviations: tuple[Deviation, ...]
    monodromy: Monodromy

    @property
    def largest(self) -> float:
        """The largest multiplier's size."""
        return float(np.abs(self.monodromy.multipliers).max(initial=0.0))

    @property
    def is_stable(self) -> bool:
        return self.largest <= 1.0 + STABLE


def stability_of(form: ReducedForm, motion: PeriodicMotion) -> Stability:
    """The stability of a periodic motion, unlinearised as it is."""
    time_s = motion.time_s
    scale = 1e-2 * float(np.abs(motion.z).max()) or 1e-6 * form.assembly.scene.longest_m
    linear = linearise(form, time_s, scale, motion.at(time_s))
    return stability(linear, form.period_s)


def stability(linear: LinearForm, period_s: float, highest: float = math.inf) -> Stability:
    """That of linearised equations at an odd number of instants of a period; modes of orders above
    ``highest`` need not be told."""
    modes = natural_modes(linear.mass, linear.stiffness)
    windows = window_count(modes, period_s, highest)
    return looked_at(by_collocation(linear, period_s, windows), windows, linear, modes, period_s)


def window_count(modes: NaturalModes, period_s: float, highest: float) -> int:
    """How many windows of a period do for modes up to an order."""
    fastest = min(float(modes.mean_rad_s.max()) * period_s / math.tau, highest)
    return min(max(math.ceil(fastest * math.tau / RADIANS), FEWEST), MOST)


def looked_at(
    monodromy: Monodromy, windows: int, linear: LinearForm, modes: NaturalModes, period_s: float
) -> Stability:
    """The stability that a monodromy matrix of linearised equations tells of, which so many windows
    of a period made, and modes of which are known."""
    orders = modes.mean_rad_s * period_s / math.tau
    resolved = orders * math.tau <= 1.5 * RADIANS * windows
    found = _deviations(monodromy, modes, linear.mass[0], orders, resolved)
    return Stability(tuple(found), monodromy)


def _deviations(
    monodromy: Monodromy, modes: NaturalModes, mass: Array, orders: Array, resolved: Mask
) -> list[Deviation]:
    """Pairs of multipliers by the mode that most of their energy is in as a period begins."""
    m = len(orders)
    multipliers, vectors = np.linalg.eig(monodromy.matrix)
    upper = _pairs(multipliers)
    coordinates = modes.shape[0].T @ mass
    places, rates = coordinates @ vectors[:m, upper], coordinates @ vectors[m:, upper]
    energy = np.abs(rates) ** 2 + modes.frequency_rad_s[0][:, None] ** 2 * np.abs(places) ** 2
    shares = energy / energy.sum(axis=0)
    mode, pair = linear_sum_assignment(-shares)
    found = []
    for k, own in zip(mode, pair, strict=True):
        multiplier = complex(multipliers[upper[own]])
        order = _unwrapped(multiplier, float(orders[k])) if resolved[k] else math.nan
        found.append(Deviation(int(k) + 1, multiplier, order, float(orders[k])))
    return found


def _pairs(multipliers: Array) -> list[int]:
    """One of each pair: of those that are not real the upper, of the real ones every second by
    size."""
    real = np.flatnonzero(np.abs(multipliers.imag) <= 1e-12 * np.abs(multipliers))
    real = real[np.argsort(-np.abs(multipliers[real]), kind="stable")]
    above = np.flatnonzero(multipliers.imag > 1e-12 * np.abs(multipliers))
    count = len(multipliers) // 2 - len(above)
    return [int(k) for k in (*above, *real[:count])]


def _unwrapped(multiplier: complex, near: float) -> float:
    """How often it vibrates in a period: its angle but for whole turns and its sign."""
    part = abs(np.angle(multiplier)) / math.tau
    whole = math.floor(near)
    every = [n + sign * part for n in (whole - 1, whole, whole + 1, whole + 2) for sign in (1, -1)]
    return float(min(every, key=lambda order: abs(order - near)))
