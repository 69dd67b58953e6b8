"""Elastic links over time, driven by a law: Gauss' collocation on the reduced form.

The method is implicit, of order 2 s for s nodes, stable at every step, and keeps the energy of what
is not damped. At the nodes of a window of time the equations are met by Newton's method, with the
derivatives of the elastic forces, which are what is stiff.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from analytic.elastic.reduced import ReducedForm
from analytic.free.gauss import gauss
from models.array import Array
from models.errors import CrankcheckError

NODES = 10
RULE = gauss(NODES)
TWICE, END_TWICE = RULE.once @ RULE.once, RULE.end_once @ RULE.once
"""Rates are integrated as accelerations are, from their values at the nodes; integrated as the
polynomials that they are, the method would not be stable."""
MOST_ROUNDS = 40
CLOSE = 1e-13
"""What a round may change accelerations by, over the largest."""


@dataclass(frozen=True)
class VibrationHistory:
    """W windows of one length [s] from time 0 on: coefficients and rates at their beginnings,
    (W, m), and those of Legendre's polynomials that their second derivatives are, (W, NODES, m)."""

    step_s: float
    z: Array
    rates: Array
    series: Array

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """The coefficients, their rates and second derivatives at times [s], (T, m) each."""
        window = np.clip((time_s / self.step_s).astype(int), 0, len(self.z) - 1)
        share, series = time_s / self.step_s - window, self.series[window]
        second, first, zeroth = (
            np.einsum(
                "tk,tkm->tm", legendre.legvander(2.0 * share - 1.0, NODES - 1 + k) @ lift, series
            )
            for k, lift in enumerate((np.eye(NODES), RULE.lift_once, RULE.lift_twice))
        )
        h, rates = self.step_s, self.rates[window]
        return (
            self.z[window] + h * share[:, None] * rates + h * h * zeroth,
            rates + h * first,
            second,
        )


def vibrate(
    form: ReducedForm, z: Array, rates: Array, until_s: float, windows: int
) -> VibrationHistory:
    """The motion from coefficients and rates (m,) at time 0, in so many windows of time.

    Raises
    ------
    CrankcheckError
        A window in which the equations are not met; links that bend too far.
    """
    h = until_s / windows
    kept_z, kept_rates, kept_series = [], [], []
    seconds = np.zeros((NODES, form.size))
    for k in range(windows):
        seconds = _met(form, k * h, h, z, rates, seconds)
        kept_z.append(z)
        kept_rates.append(rates)
        kept_series.append(RULE.series @ seconds)
        z = z + h * rates + h * h * END_TWICE @ seconds
        rates = rates + h * RULE.end_once @ seconds
    return VibrationHistory(h, np.array(kept_z), np.array(kept_rates), np.array(kept_series))


def _met(
    form: ReducedForm, begin_s: float, h: float, z: Array, rates: Array, guess: Array
) -> Array:
    """The second derivatives at the nodes of a window, (NODES, m)."""
    m, times = form.size, begin_s + h * RULE.places
    near, drift = form.near(times), z + h * RULE.places[:, None] * rates
    seconds, inverse, last = guess, None, np.inf
    for _ in range(MOST_ROUNDS):
        now = form.at(times, drift + h * h * TWICE @ seconds, rates + h * RULE.once @ seconds, near)
        if inverse is None:
            inverse = np.linalg.inv(_newton(form, now.mass, h))
        step = inverse @ (now.seconds - seconds).ravel()
        seconds = seconds + step.reshape(NODES, m)
        size = float(np.abs(step).max()) / (float(np.abs(seconds).max()) or 1.0)
        if size <= CLOSE or (size < 1e-9 and size >= 0.5 * last):
            return seconds
        last = size
    raise CrankcheckError(
        f"{form.assembly.scene.name}: at {begin_s:g} s the equations of its elastic links are not "
        f"met in a window of {h:g} s; take shorter ones"
    )


def _newton(form: ReducedForm, mass: Array, h: float) -> Array:
    """1 + h^2 M^-1 K A^2 + h M^-1 C A of all nodes, (NODES m, NODES m)."""
    soft = np.linalg.solve(mass, np.broadcast_to(form.stiffness, mass.shape))
    lossy = np.linalg.solve(mass, np.broadcast_to(form.damping, mass.shape))
    whole = h * h * np.einsum("ij,iab->iajb", TWICE, soft)
    whole += h * np.einsum("ij,iab->iajb", RULE.once, lossy)
    size = NODES * form.size
    return np.asarray(np.eye(size) + whole.reshape(size, size))
