"""The second opinion of what nothing drives: the motion of a mechanism under gravity alone.

The constraint equations without the driver's, with a multiplier each, beside Newton's equations:

    M q'' + Phi_q^T lambda = Q(q, q')        Phi_q q'' = gamma

Source: E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, chapters 6 and 7.
Stepped by the fourth-order Runge-Kutta method, without correction of what the joints drift: it is
for short motions, and to a thousandth.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from analytic.check.constraints import Constraints
from models.array import Array
from models.errors import CrankcheckError
from models.joints import block_name, blocks, sliding_angle
from models.motion import State
from models.poses import centre_of, frames, mass_of
from models.scene import Point, Scene


def centres(scene: Scene, state: State, duration_s: float, steps: int) -> Mapping[str, Point]:
    """Where the centres of mass are a while after the driver has let go [m].

    Parameters
    ----------
    scene : Scene
        A mechanism of mobility 1, with its masses and its gravity.
    state : State
        The mechanism when it is let go.
    duration_s : float
        For how long it is free [s].
    steps : int
        Of the integration.

    Raises
    ------
    CrankcheckError
        The mass of what moves is none, or a redundant mechanism.
    """
    system = Constraints(scene)
    q, rates = _start(system, state)
    h = duration_s / steps
    for _ in range(steps):
        a1 = _seconds(system, q, rates)
        r2 = rates + h / 2 * a1
        a2 = _seconds(system, q + h / 2 * rates, r2)
        r3 = rates + h / 2 * a2
        a3 = _seconds(system, q + h / 2 * r2, r3)
        r4 = rates + h * a3
        a4 = _seconds(system, q + h * r3, r4)
        q = q + h / 6 * (rates + 2 * r2 + 2 * r3 + r4)
        rates = rates + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    heavy = (*scene.links, *blocks(scene))
    return {body: _centre(system, q, body) for body in heavy}


def _start(system: Constraints, state: State) -> tuple[Array, Array]:
    """Coordinates and rates at a state; a block without mass has a frame too."""
    scene, placed = system.scene, frames(system.scene, state)
    q, rates = np.zeros(system.size), np.zeros(system.size)
    sliders = {block_name(s): s for s in scene.sliders.values() if s.link is None}
    for body, at in system.at.items():
        if body in placed:
            frame = placed[body]
            q[at : at + 3] = *frame.origin, frame.theta
            rates[at : at + 3] = *frame.velocity, frame.omega
        else:
            slider = sliders[body]
            guide = placed[slider.on]
            q[at : at + 3] = *state.position[slider.point], guide.theta + sliding_angle(slider)
            rates[at : at + 3] = *state.velocity[slider.point], guide.omega
    return q, rates


def _centre(system: Constraints, q: Array, body: str) -> Point:
    """The centre of mass of a body."""
    (x, y), (a, b) = q[system.at[body] : system.at[body] + 2], _arm(system, q, body)
    return float(x + a), float(y + b)


def _arm(system: Constraints, q: Array, body: str) -> Point:
    """From the origin of a body's frame to its centre of mass, in the plane."""
    (x, y), theta = centre_of(system.scene, body), q[system.at[body] + 2]
    c, s = math.cos(theta), math.sin(theta)
    return c * x - s * y, s * x + c * y


def _seconds(system: Constraints, q: Array, rates: Array) -> Array:
    """The accelerations q'' of what nothing drives."""
    scene, size = system.scene, system.size
    rows = system.jacobian(q)[:-1]
    matrix, right = np.zeros((2 * size - 1, 2 * size - 1)), np.zeros(2 * size - 1)
    matrix[size:, :size], matrix[:size, size:] = rows, rows.T
    right[size:] = system.gamma(q, rates, 0.0)[:-1]
    for body in (*scene.links, *blocks(scene)):
        at, (mass, inertia) = system.at[body], mass_of(scene, body)
        a, b = _arm(system, q, body)
        g_x, g_y = scene.gravity_m_s2
        w2 = rates[at + 2] ** 2
        matrix[at : at + 3, at : at + 3] = [
            [mass, 0.0, -mass * b],
            [0.0, mass, mass * a],
            [-mass * b, mass * a, inertia + mass * (a * a + b * b)],
        ]
        right[at : at + 3] = (
            mass * (g_x + w2 * a),
            mass * (g_y + w2 * b),
            mass * (a * g_y - b * g_x),
        )
    try:
        solution: Array = np.linalg.solve(matrix, right).astype(np.float64)
    except np.linalg.LinAlgError:
        raise CrankcheckError(
            f"{scene.name}: free, its accelerations are not to be had; it lacks a mass"
        ) from None
    return solution[:size]
