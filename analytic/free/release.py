"""Let a mechanism of one freedom go: the equation of the machine, integrated to 1e-12."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]  # ships no stubs

from analytic.free.free_motion import FreeMotion
from analytic.free.integrated_law import IntegratedLaw
from analytic.free.machine import Machine
from models.array import Array
from models.errors import CrankcheckError
from models.released import Released
from models.scene import KEPT, Same, Scene

NUDGE = 1e-6
"""What the start is changed by to see it grow [rad]."""


def release(scene: Scene, until_s: float) -> FreeMotion:
    """The motion of a scene from its start, when it is let go.

    Parameters
    ----------
    scene : Scene
        A mechanism of mobility 1 whose driver is let go (`models.released`), with its masses.
    until_s : float
        For how long [s].

    Raises
    ------
    CrankcheckError
        A driver that is driven, no mass that moves, an integration that fails.
    """
    return _released(Same(scene), until_s)


@lru_cache(maxsize=KEPT)
def _released(same: Same, until_s: float) -> FreeMotion:
    scene = same.scene
    law = scene.driver.law
    if not isinstance(law, Released):
        raise CrankcheckError(f'{scene.name}: its driver follows a law; give it law = "free"')
    machine = Machine(scene)
    fine = _integrated(machine, law.start_rad, law.speed_rad_s, until_s, 1e-13)
    rough = _integrated(machine, law.start_rad, law.speed_rad_s, until_s, 1e-11)
    nudged = _integrated(machine, law.start_rad + NUDGE, law.speed_rad_s, until_s, 1e-11)
    time_s = np.linspace(0.0, until_s, 2001)
    at, near, far = fine(time_s), rough(time_s), nudged(time_s)
    growth = np.maximum.accumulate(np.maximum(1.0, np.abs(far[0] - near[0]) / NUDGE))
    off = np.maximum.accumulate(np.abs(at[0] - near[0]))

    def course(times: Array) -> tuple[Array, Array, Array]:
        theta, omega = fine(times)
        return theta, omega, machine.acceleration(times, theta, omega)

    peak = float(np.max(np.abs(at[1])))
    own = IntegratedLaw(course, 0.0, until_s, peak)
    return FreeMotion(scene, until_s, own, (time_s, growth), (time_s, off))


def _integrated(
    machine: Machine, start_rad: float, speed_rad_s: float, until_s: float, rtol: float
) -> Callable[[Array], Array]:
    """The driver's angle and rate over time, dense."""

    def rates(time_s: float, state: Array) -> tuple[float, float]:
        one = machine.acceleration(np.array([time_s]), state[:1], state[1:])
        return float(state[1]), float(one[0])

    done = solve_ivp(
        rates,
        (0.0, until_s),
        (start_rad, speed_rad_s),
        method="DOP853",
        rtol=rtol,
        atol=rtol,
        dense_output=True,
    )
    if not done.success:
        raise CrankcheckError(f"{machine.scene.name}: the integration fails: {done.message}")
    dense: Callable[[Array], Array] = done.sol
    return dense
