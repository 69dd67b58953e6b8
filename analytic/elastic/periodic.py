"""The periodic motion of elastic links: the one that comes back after a turn of the driver.

By collocation with trigonometric polynomials over the whole turn: the coefficients of the links at
an odd number of instants, whose derivatives follow exactly, have to meet the equations of motion
there, unlinearised. Newton's method takes the derivatives of the linearised equations. Source:
L. N. Trefethen, Spectral Methods in MATLAB, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.linearised import linearise
from analytic.elastic.reduced import ReducedForm
from models.array import Array
from models.errors import CrankcheckError

FEWEST, MOST = 65, 1025
"""Instants of a turn; twice as many are taken as long as the series has not come to an end."""
ENDED = 1e-13
"""A last coefficient of the series, over the largest, at which it has."""
CLOSE = 1e-13
"""A step of Newton's method, over the largest coefficient, after which none is taken."""
MOST_STEPS, SLOW = 60, 0.3
"""Steps; and what one may leave of the one before it until the derivatives are taken anew."""
FIRST = 1e-4
"""A deflection with which the derivatives are taken first, over the longest link."""


@dataclass(frozen=True)
class PeriodicMotion:
    """Coefficients at N instants of a period from time 0 on, (N, m), N odd."""

    period_s: float
    z: Array

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """The coefficients, their rates and second derivatives at times [s], (T, m) each."""
        series = np.fft.rfft(self.z, axis=0) / len(self.z)
        series[1:] *= 2.0
        order = 1j * np.arange(len(series)) * 2.0 * np.pi / self.period_s
        wave = np.exp(np.outer(time_s, order))
        place, rate, second = (np.asarray((wave * order**k @ series).real) for k in range(3))
        return place, rate, second

    @property
    def decay(self) -> float:
        """The last of the coefficients of the Fourier series over the largest."""
        series = np.abs(np.fft.rfft(self.z, axis=0))
        return float(series[-1].max() / (series.max() or 1.0))


def periodic_motion(form: ReducedForm) -> PeriodicMotion:
    """The periodic motion of a mechanism whose driver has a constant speed.

    Raises
    ------
    CrankcheckError
        A resonance: next to it no such motion is found.
    """
    start = np.zeros((FEWEST, form.size))
    while True:
        found = PeriodicMotion(form.period_s, _met(form, start))
        count = len(start)
        if found.decay <= ENDED or count >= MOST:
            return found
        finer = 2 * count - 1
        start = found.at(form.period_s * np.arange(finer) / finer)[0]


def _met(form: ReducedForm, start: Array) -> Array:
    """Coefficients that meet the equations at as many instants as there are in a start (N, m)."""
    z, (count, m) = start, start.shape
    period_s, unit = form.period_s, form.assembly.scene.longest_m
    time_s = period_s * np.arange(count) / count
    near = form.near(time_s)
    first = derivative(count, period_s)
    second = first @ first
    scale, size, last, factors = FIRST * unit, np.inf, np.inf, None
    for _ in range(MOST_STEPS):
        rates, seconds = first @ z, second @ z
        if factors is None:
            linear = linearise(form, time_s, scale, (z, rates, seconds))
            whole = np.einsum("tu,tab->taub", second, linear.mass)
            whole += np.einsum("tu,tab->taub", first, linear.damping)
            whole[range(count), :, range(count), :] += linear.stiffness
            factors = lu_factor(whole.reshape(count * m, count * m))
        now = form.at(time_s, z, rates, near)
        left = now.force - (now.mass @ seconds[:, :, None])[:, :, 0]
        step = lu_solve(factors, left.ravel()).reshape(count, m)
        z = z + step
        largest = float(np.abs(z).max()) or 1.0
        last, size = size, float(np.abs(step).max())
        if size <= CLOSE * largest or (size < 1e-9 * largest and size >= 0.5 * last):
            return np.asarray(z)
        if not size < unit:
            break
        if size > SLOW * last:
            scale, factors = max(1e-2 * largest, 1e-9 * unit), None
    raise CrankcheckError(
        f"{form.assembly.scene.name}: no periodic motion of its elastic links was found; they are "
        "next to a resonance, or bend too far: take another speed, or give them damping_s"
    )


def derivative(count: int, period_s: float) -> Array:
    """The derivative of what is periodic, at an odd number of instants, (N, N)."""
    k = np.arange(count)
    apart = (k[:, None] - k) * np.pi / count
    np.fill_diagonal(apart, 1.0)
    matrix = np.where((k[:, None] - k) % 2, -0.5, 0.5) / np.sin(apart)
    np.fill_diagonal(matrix, 0.0)
    return np.asarray(matrix * 2.0 * np.pi / period_s)
