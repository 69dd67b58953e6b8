"""The coordinate of the driven joint over a motion: logged by an engine, or the reference's own."""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.motion import Motion, State
from models.scene import GROUND, Scene

Course = tuple[Array, Array, Array]
"""A coordinate [rad or m], its rate and its second rate, each (T,)."""


def driver_course(scene: Scene, motion: Motion) -> Course:
    """What the driver did: its angle, the angle of its link against its base, or the displacement
    of its slider. KeyError where the motion has not what that is worked out of."""
    driver = scene.driver
    if driver.slider is not None:
        slider = motion.sliders[driver.slider]
        return slider.displacement, slider.speed, slider.acceleration
    link = motion.links[driver.link]
    if driver.base == GROUND:
        return link.theta, link.omega, link.alpha
    base = motion.links[driver.base]
    return link.theta - base.theta, link.omega - base.omega, link.alpha - base.alpha


def driver_place(scene: Scene, motion: Motion) -> Array | None:
    """The driver's coordinate [rad or m], (T,); None where the motion does not tell it."""
    try:
        return driver_course(scene, motion)[0]
    except KeyError:
        return None


def driver_rates(scene: Scene, state: State) -> tuple[float, float]:
    """The rate and the second rate of the driver's coordinate in a state."""
    driver = scene.driver
    if driver.slider is not None:  # of which a state has no acceleration
        return state.speed[driver.slider], float(driver.law.at(np.array([state.time_s]))[2][0])
    omega, alpha = state.omega[driver.link], state.alpha[driver.link]
    if driver.base == GROUND:
        return omega, alpha
    return omega - state.omega[driver.base], alpha - state.alpha[driver.base]


def driver_place_in(scene: Scene, state: State) -> float:
    """The driver's coordinate in a state [rad or m]."""
    driver = scene.driver
    if driver.slider is not None:
        return state.displacement[driver.slider]
    return state.theta[driver.link] - (state.theta[driver.base] if driver.is_inner else 0.0)
