"""Scenes of free motion for the tests, and their motions by other methods: by steps of order 8, to
instants of no window, and by the equations of all bodies."""

import math
import pickle
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from analytic.free.chart import Chart
from analytic.free.free_motion import FreeMotion
from analytic.free.machine import Machine
from analytic.free.release import release
from analytic.free.solved_motion import MachineMotion
from models.array import Array
from models.scene import Scene, as_bytes
from models.scene.joints import centre_of, mass_of
from tests.analytic.multibody.scenes import scene
from tests.second_opinions.constraints import Constraints


def released(mechanism: Scene, until_s: float) -> FreeMotion:
    """Its free motion, integrated once for all tests."""
    return _released(as_bytes(mechanism), until_s)


@cache
def _released(pickled: bytes, until_s: float) -> FreeMotion:
    return release(pickle.loads(pickled), until_s)


def _driver(start_deg: float = 0.0, speed_rad_s: float = 0.0) -> str:
    start = f"start_deg = {start_deg}, speed_rad_s = {speed_rad_s}"
    return f'driver = {{ link = "crank", law = "free", {start}, duration_s = 10.0 }}'


def fourbar(
    a: float = 0.1, b: float = 0.25, c: float = 0.2, d: float = 0.3, branch: int = 1, **start: float
) -> Scene:
    """A four-bar of rods; by default the lecture's, let go from rest a right angle above the
    bottom."""
    return scene(f"""
ground = {{ points = {{ A = [0.0, 0.0], D = [{d}, 0.0] }} }}
{_driver(**start)}
branch = {{ C = {branch} }}
[links]
crank = {{ bar = ["A", "B"], length_m = {a} }}
coupler = {{ bar = ["B", "C"], length_m = {b} }}
rocker = {{ bar = ["D", "C"], length_m = {c} }}
""")


def past_limits(**start: float) -> Scene:
    """No link of it turns fully: the driver swings between two limits."""
    return fourbar(0.2, 0.2, 0.25, 0.4, **{"start_deg": 60.0, **start})


def slider_crank(r: float = 0.1, rod: float = 0.3, offset: float = 0.02, **start: float) -> Scene:
    return scene(f"""
ground = {{ points = {{ A = [0.0, 0.0] }} }}
{_driver(**{"start_deg": -70.0, **start})}
sliders = {{ C = {{ on = "ground", through_m = [0.0, {offset}], mass_kg = 1 }} }}
[links]
crank = {{ bar = ["A", "B"], length_m = {r} }}
rod = {{ bar = ["B", "C"], length_m = {rod} }}
""")


STEP_RAD = 0.06
"""The longest step, by what the driver turns in it: left to itself the method takes longer ones,
and misses its tolerance by a thousand."""
ASIDE = 1e-12
"""An end of a stretch is looked at from inside it by so much of its length: there what acts may
jump."""


def driver_by_steps(free: MachineMotion, time_s: Array) -> Array:
    """The driver's angle and rate at times [s] in rising order, (2, T).

    By `scipy`'s DOP853 in the charts of ``free``, which may not have chosen them wrong without
    being seen, as every body is held to the multibody form. It stops where what acts is not smooth.
    """
    legs = list(free.history.legs())
    starts = [float(free.history.starts_s[first]) for _, first, _ in legs]
    borders = np.unique([*starts, *free.edges_s, free.until_s])
    chart, found = legs[0][0], np.empty((2, len(time_s)))
    now, state = 0.0, np.array([float(row[0]) for row in free.history.state(np.zeros(1))[:2]])
    for end in np.unique([*borders[borders > 0.0], *time_s]):
        for leg, begin in zip(legs, starts, strict=True):
            if begin == now and leg[0] is not chart:
                state, chart = _moved(chart, leg[0], state), leg[0]
        if end > now:
            state = _stretch(free, chart, now, float(end), state)
        now = float(end)
        for k in np.flatnonzero(time_s == end):
            phi, slope, _ = chart.driver(state[:1])
            found[:, k] = phi[0], slope[0] * state[1]
    return found


def _stretch(free: MachineMotion, chart: Chart, now: float, end: float, state: Array) -> Array:
    """The coordinate and its rate at the end of a stretch without kinks inside."""
    machine, aside = Machine(free.scene, chart), ASIDE * (end - now)
    wound = dict(free.history.windows[int(free.history.windows_at(np.array([now]))[0])].wound)

    def rates(t: float, y: Array) -> tuple[float, float]:
        inside = min(max(t, now + aside), end - aside)
        u = y[:1] + (inside - t) * y[1:]
        return float(y[1]), float(machine.acceleration(np.array([inside]), u, y[1:], wound)[0])

    most = STEP_RAD / max(free.peak_speed_rad_s, 1.0)
    done = solve_ivp(rates, (now, end), state, "DOP853", rtol=3e-14, atol=1e-15, max_step=most)
    assert done.success, done.message
    return np.asarray(done.y[:, -1])


def _moved(old: Chart, new: Chart, state: Array) -> Array:
    """A coordinate and its rate in the chart of the other limit, by the driver's angle."""
    phi, slope, _ = (float(row[0]) for row in old.driver(state[:1]))
    u = math.sqrt(new.limit.side * (new.limit.driver_rad - phi))
    return np.array([u, slope * state[1] / (-2.0 * new.limit.side * u)])


def newton_euler(scene: Scene, system: Constraints, q: Array, rates: Array) -> Array:
    """The accelerations of all bodies, whose centres lie on their x-axes: M q'' + Phi_q^T lambda =
    F, Phi_q q'' = gamma, without the driver's equation."""
    size = system.size
    mass, force = np.zeros((size, size)), np.zeros(size)
    for name in scene.links:
        i, (m, inertia), x = system.at[name], mass_of(scene, name), centre_of(scene, name)[0]
        c, s = x * math.cos(q[i + 2]), x * math.sin(q[i + 2])
        carry = np.array([[1.0, 0.0, -s], [0.0, 1.0, c]])  # of the centre, from the frame
        mass[i : i + 3, i : i + 3] = m * carry.T @ carry
        mass[i + 2, i + 2] += inertia
        pull = np.array(scene.gravity_m_s2) + rates[i + 2] ** 2 * np.array([c, s])
        force[i : i + 3] = m * carry.T @ pull
    phi_q = system.jacobian(q)[:-1]
    whole = np.block([[mass, phi_q.T], [phi_q, np.zeros((len(phi_q), len(phi_q)))]])
    right = np.concatenate([force, system.gamma(q, rates, 0.0)[:-1]])
    return np.linalg.solve(whole, right)[:size]
