"""Periodic motion of elastic links: it repeats after a turn of the driver.

    M(t) y'' + C(t) y' + K(t) y = h(t)

y are the coefficients of the shapes; all four are periodic where the driver's speed is constant.
The derivatives of the whole equations are differences with a step at which truncation and rounding
are alike, once extrapolated. Source: Thesis on vibration of planar mechanisms with elastic links
(2018), chapter 4.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import lu_factor, lu_solve  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.natural import FrequencySensitivity, resonance_text, sensitivity
from analytic.elastic.reduced import ReducedForm
from models.array import Array
from models.errors import CrankcheckError

STEPS = (1.0, -1.0, 0.5, -0.5)
"""Steps of two central differences, which are extrapolated."""


@dataclass(frozen=True)
class LinearForm:
    """M, C, K (T, m, m) and h (T, m) at times [s], (T,)."""

    time_s: Array
    mass: Array
    damping: Array
    stiffness: Array
    force: Array


def linearise(
    form: ReducedForm,
    time_s: Array,
    scale_m: float,
    about: tuple[Array, Array, Array] | None = None,
) -> LinearForm:
    """Linearise the equations about the rigid mechanism at times (T,), or about coefficients with
    their rates and second derivatives ``about``, (T, m) each.

    Derivatives are differences over ``scale_m`` [m], and over ``scale_m`` times the driver's speed.
    """
    count, m = len(time_s), form.size
    z, rates, seconds = about or (np.zeros((count, m)),) * 3
    base, nothing = form.at(time_s, z, rates, form.near(time_s)), np.zeros(m)
    # All steps of a difference are one call, from joints that are closed but for the step.
    times, at, turning, pulled, near = (
        np.concatenate([each] * len(STEPS)) for each in (time_s, z, rates, seconds, base.now.q)
    )
    steps = np.repeat(STEPS, count)[:, None]

    def slope(dz: Array, drates: Array) -> Array:
        """Return the derivative along a change of the coefficients, or of their rates, at 0."""
        now = form.at(times, at + steps * dz, turning + steps * drates, near)
        left = (now.mass @ pulled[:, :, None])[:, :, 0] - now.force
        far, far_back, half, half_back = left.reshape(len(STEPS), count, m)
        return np.asarray((4.0 * (half - half_back) - 0.5 * (far - far_back)) / 3.0)

    speed = scale_m * float(np.abs(form.law.at(time_s)[1]).max())
    stiffness, damping = np.empty((count, m, m)), np.empty((count, m, m))
    for k, one in enumerate(np.eye(m)):
        stiffness[:, :, k] = slope(scale_m * one, nothing) / scale_m
        damping[:, :, k] = slope(nothing, speed * one) / speed
    force = base.force - (base.mass @ seconds[:, :, None])[:, :, 0]
    return LinearForm(time_s, base.mass, damping, stiffness, force)


FEWEST, OTHERS, MOST = 65, 91, 1025
"""Instants of a turn; twice as many are taken as long as the series has not converged. Different
first numbers end with different last ones: loads with kinks or jumps prevent convergence, and two
motions with the same instants would have their truncation in common."""
MOST_UNKNOWNS = 6000
"""Most coefficients at all instants: more equations take too much room and time."""
ENDED = 1e-13
"""Last coefficient of a converged series, over the largest."""
CLOSE = 1e-13
"""Step of Newton's method, over the largest coefficient, after which none is taken."""
MOST_STEPS, SLOW = 60, 0.3
"""Most steps; and the largest ratio of a step to the last before the derivatives are taken anew."""
FIRST = 1e-4
"""Deflection for the first derivatives, over the longest link."""
FAR = 0.5
"""Largest difference of the motion from that of the linearised equations, over the largest
coefficient: beyond it, the motion is another of several, or bends too far for a beam."""
COMES_BACK = 1e-9
"""Largest difference of the forces of one turn and the next, over the largest."""
CURE = "take a lower speed or stiffer links, or give the links damping_s"


@dataclass(frozen=True)
class PeriodicMotion:
    """Coefficients at N instants of a period from time 0 on, (N, m), N odd; and their sensitivity
    to the stiffness of the links.

    By collocation with trigonometric polynomials over the whole turn: the coefficients of the links
    at an odd number of instants, whose derivatives follow exactly, have to meet the equations of
    motion there, unlinearised. Newton's method takes the derivatives of the linearised equations;
    its first step is their motion. Source: L. N. Trefethen, Spectral Methods in MATLAB, chapter 3.
    """

    period_s: float
    z: Array
    sensitivity: FrequencySensitivity

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return the coefficients, their rates and second derivatives at times [s], (T, m) each."""
        series = np.fft.rfft(self.z, axis=0) / len(self.z)
        series[1:] *= 2.0
        order = 1j * np.arange(len(series)) * 2.0 * np.pi / self.period_s
        wave = np.exp(np.outer(time_s, order))
        place, rate, second = (np.asarray((wave * order**k @ series).real) for k in range(3))
        return place, rate, second

    @property
    def time_s(self) -> Array:
        """The instants [s], (N,)."""
        return instants(len(self.z), self.period_s)

    @property
    def decay(self) -> float:
        """Last coefficient of the Fourier series, over the largest."""
        series = np.abs(np.fft.rfft(self.z, axis=0))
        return float(series[-1].max() / (series.max() or 1.0))


def periodic_motion(form: ReducedForm, fewest: int = FEWEST) -> PeriodicMotion:
    """Find the periodic motion of a mechanism whose driver has a constant speed, at ``fewest``
    instants of a turn or more, an odd number.

    Raises
    ------
    CrankcheckError
        A resonance; links that bend too far; a drive or loads that do not repeat after a turn.
    """
    check_periodic(form)
    small = FIRST * form.assembly.scene.longest_m
    about_rigid = linearise(form, instants(fewest, form.period_s), small)
    linear = found = linear_motion(form, about_rigid)
    while True:
        z, change = _met(form, found.z)
        found = _looked_at(form, z, change)
        _refuse_other(form, found, linear)
        finer = 2 * len(z) - 1
        if found.decay <= ENDED or finer > MOST or finer * form.size > MOST_UNKNOWNS:
            break
        found = replace(found, z=found.at(instants(finer, form.period_s))[0])
    return found


def _refuse_other(form: ReducedForm, found: PeriodicMotion, linear: PeriodicMotion) -> None:
    """Refuse a motion that small deflections do not lead to. Raises CrankcheckError."""
    far = np.abs(found.at(linear.time_s)[0] - linear.z).max(initial=0.0)
    if far > FAR * np.abs(found.z).max(initial=0.0):
        raise CrankcheckError(
            f"{form.assembly.scene.name}: the periodic motion that was found of its elastic links "
            "is far from that of small deflections: it is another of several, or they bend too "
            f"far for a beam: {CURE}"
        )


def check_periodic(form: ReducedForm) -> None:
    """Refuse a drive or loads that do not repeat after a period. Raises CrankcheckError."""
    times = instants(9, form.period_s)
    still = np.zeros((len(times), form.size))
    bent = still + FIRST * form.assembly.scene.longest_m  # a straight link feels no pull
    now, later = (form.at(t, bent, still, form.near(t)) for t in (times, times + form.period_s))
    for first, second in ((now.force, later.force), (now.mass, later.mass)):
        if np.abs(first - second).max() > COMES_BACK * np.abs(first).max():
            raise CrankcheckError(
                f"{form.assembly.scene.name}: its elastic links have no periodic motion: their "
                f"loads are not the same {form.period_s:.6g} s later; drive it at a constant "
                "speed, with loads that repeat each turn, or start from another shape ([start] "
                'shape = "quasi-static")'
            )


def linear_motion(form: ReducedForm, linear: LinearForm) -> PeriodicMotion:
    """Solve linearised equations for their periodic motion at an odd number of instants of a
    period: by harmonic balance, which is collocation at these instants.

    Raises CrankcheckError at a resonance.
    """
    factors = lu_factor(balance(linear, form.period_s))
    z = _solved(factors, linear.force)
    return _looked_at(form, z, _solved(factors, z @ form.stiffness))


def _solved(factors: tuple[Array, Array], right: Array) -> Array:
    return np.asarray(lu_solve(factors, right.ravel()).reshape(right.shape))


def _looked_at(form: ReducedForm, z: Array, change: Array) -> PeriodicMotion:
    """Return a motion with its sensitivity. Raises CrankcheckError at a resonance."""
    found = sensitivity(form, z, change)
    if found.resonates:
        raise CrankcheckError(resonance_text(form, found))
    return PeriodicMotion(form.period_s, z, found)


def balance(linear: LinearForm, period_s: float) -> Array:
    """Return the matrix of linearised equations for all N instants, (N m, N m)."""
    count, m = linear.force.shape
    first = derivative(count, period_s)
    whole = (first @ first)[:, None, :, None] * linear.mass[:, :, None, :]
    whole += first[:, None, :, None] * linear.damping[:, :, None, :]
    whole[range(count), :, range(count), :] += linear.stiffness
    return np.asarray(whole.reshape(count * m, count * m))


def _met(form: ReducedForm, start: Array) -> tuple[Array, Array]:
    """Solve the equations at as many instants as a start (N, m) has: coefficients, and their change
    for a stiffness of twice its size."""
    z, (count, _) = start, start.shape
    unit = form.assembly.scene.longest_m
    time_s = instants(count, form.period_s)
    near = form.near(time_s)
    first = derivative(count, form.period_s)
    second = first @ first
    size, last, factors = np.inf, np.inf, None
    for _ in range(MOST_STEPS):
        rates, seconds = first @ z, second @ z
        largest = float(np.abs(z).max()) or 1.0
        try:
            if factors is None:
                scale = max(1e-2 * largest, 1e-9 * unit)
                linear = linearise(form, time_s, scale, (z, rates, seconds))
                factors = lu_factor(balance(linear, form.period_s))
            now = form.at(time_s, z, rates, near)
        except CrankcheckError:  # the joints can not be closed
            break
        left = now.force - (now.mass @ seconds[:, :, None])[:, :, 0]
        step = _solved(factors, left)
        z = z + step
        last, size = size, float(np.abs(step).max())
        if size <= CLOSE * largest or (size < 1e-9 * largest and size >= 0.5 * last):
            return z, _solved(factors, z @ form.stiffness)
        if not size < unit:
            break
        if size > SLOW * last:
            factors = None
    raise CrankcheckError(
        f"{form.assembly.scene.name}: no periodic motion of its elastic links was found: they bend "
        f"too far for a beam, or are next to a resonance: {CURE}"
    )


def instants(count: int, period_s: float) -> Array:
    """Return so many instants of a period from time 0 on [s]."""
    return np.asarray(period_s * np.arange(count) / count)


def derivative(count: int, period_s: float) -> Array:
    """Return the derivative matrix of a periodic series at an odd number of instants, (N, N)."""
    k = np.arange(count)
    apart = (k[:, None] - k) * np.pi / count
    np.fill_diagonal(apart, 1.0)
    matrix = np.where((k[:, None] - k) % 2, -0.5, 0.5) / np.sin(apart)
    np.fill_diagonal(matrix, 0.0)
    return np.asarray(matrix * 2.0 * np.pi / period_s)
