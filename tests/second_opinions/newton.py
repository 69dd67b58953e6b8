"""The second opinion: all constraints of the mechanism at once, Phi(q, t) = 0, by Newton's method.

Nothing here knows of dyads. Every body has coordinates (x, y, theta) of its frame; every pin, every
prismatic pair and the driver gives its equations; position, velocity and acceleration follow from

    Phi(q, t) = 0        Phi_q q' = -Phi_t        Phi_q q'' = gamma

Source: E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, chapters 3 and 4.
It starts from a rough guess of one position, and follows the mechanism from there in small steps of
the driver; so it also serves groups that have no closed form.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from models.array import Array, samples
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from tests.second_opinions.constraints import Constraints

LONGEST_STEP_RAD = 0.05
"""The driver turns at most so far between two positions: the predictor stays on its branch."""
MOST_ITERATIONS = 25
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Guess:
    """A rough position: per body (links, and ``block NAME`` for slider blocks) x, y [m], theta."""

    bodies: Mapping[str, tuple[float, float, float]]


def solve(scene: Scene, time_s: Array, guess: Guess) -> Motion:
    """The motion of a scene of mobility 1 from its full constraint equations, without bounds, at
    increasing times [s], (T,); the ``guess`` at the first time decides the branch.

    Raises CrankcheckError where Newton's method does not converge from the guess, or the Jacobian
    is singular on the way; for times that are no numbers.
    """
    system = Constraints(scene)
    law = scene.driver.law
    q = np.array([c for body in system.bodies for c in guess.bodies[body]])
    positions, rates, seconds = [], [], []
    before: float | None = None
    time_s = samples(time_s, "time_s")
    for t in time_s:
        theta, omega, alpha = (float(a[0]) for a in law.at(np.array([t])))
        start = theta if before is None else before
        for angle in _stations(start, theta):
            if before is not None:
                lead = np.zeros(system.size)
                lead[-1] = angle - before
                q = q + _solved(system, q, lead, before)
            q = _closed(system, q, angle)
            before = angle
        drive = np.zeros(system.size)
        drive[-1] = omega
        qd = _solved(system, q, drive, theta)
        positions.append(q)
        rates.append(qd)
        seconds.append(_solved(system, q, system.gamma(q, qd, alpha), theta))
    return system.motion(time_s, *(np.array(each) for each in (positions, rates, seconds)))


def _stations(start: float, end: float) -> Array:
    """Driver angles from ``start`` (exclusive) to ``end`` in steps that keep the branch."""
    count = max(1, math.ceil(abs(end - start) / LONGEST_STEP_RAD))
    stations: Array = start + (end - start) * np.arange(1, count + 1) / count
    return stations


def _solved(system: Constraints, q: Array, right: Array, theta: float) -> Array:
    try:
        solution: Array = np.linalg.solve(system.jacobian(q), right).astype(np.float64)
        return solution
    except np.linalg.LinAlgError:
        raise CrankcheckError(
            f"{system.scene.name}: the constraints are singular at {math.degrees(theta):.6g} deg"
        ) from None


def _closed(system: Constraints, q: Array, theta: float) -> Array:
    """Newton's method from q at driver angle theta, down to rounding."""
    last = math.inf
    unit = np.tile([system.scene.longest_m, system.scene.longest_m, 1.0], len(q) // 3)
    for _ in range(MOST_ITERATIONS):
        step = _solved(system, q, -system.phi(q, theta), theta)
        q = q + step
        size = float(np.max(np.abs(step) / unit))
        if size <= EPS or (size < 1e-9 and size >= 0.5 * last):
            return q  # the steps no longer matter, or no longer shrink: what is left is rounding
        last = size
    raise CrankcheckError(
        f"{system.scene.name}: Newton's method does not converge at {math.degrees(theta):.6g} deg "
        f"(last step {last:.3g}); give a better guess"
    )
