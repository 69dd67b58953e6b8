"""The coordinate of the driven joint over a motion: logged by an engine, or the reference's own."""

from __future__ import annotations

from models.array import Array
from models.motion import Motion
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
