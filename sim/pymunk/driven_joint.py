"""Drive of a space: a prescribed crank or slider, or a motor in a pin."""

import math
from collections.abc import Callable

import numpy as np

from models.scene import joints
from sim.engine import Drive
from sim.pymunk.space import SpaceModel

Turn = Callable[[float | None, float], None]
"""Sets the driver before a step: at a position from which the speed, of the step after it, moves it
to the law's position at its end. None is where it is, at the start."""
SHARE = 0.1
"""Share of a motor's error that a step corrects: all at once is more than the iterations of profile
as-shipped settle, and adjacent joints open at any step; from 0.2 on in some positions."""


def driven_joint(model: SpaceModel, dt_s: float, drive: Drive) -> Turn:
    """Make the driver of a space at its start: a servo with a set speed only, a kinematic slider or
    crank, or a motor in a pin."""
    motor = model.motor

    def servo(place: float | None, speed: float) -> None:
        assert motor is not None
        motor.rate = speed

    def crank(place: float | None, speed: float) -> None:
        if place is not None:
            model.crank.angle = place
        model.crank.angular_velocity = speed

    if drive == "servo" and motor is not None:
        return servo
    if model.scene.driver.slider is not None:
        return _slider(model)
    if model.scene.driver.is_inner and motor is not None:
        return _pin_motor(model, dt_s)
    return crank


def _slider(model: SpaceModel) -> Turn:
    """Make a driver along a line of the ground."""
    scene, driver, body = model.scene, model.scene.driver, model.crank
    assert driver.slider is not None
    slider = scene.sliders[driver.slider]
    u, v = joints.turned((1.0, 0.0), slider.direction_rad)
    # The origin of the body is its centre of mass, at a constant way to the slider's point.
    tip = scene.links[driver.link].points[slider.point] if slider.link else (0.0, 0.0)
    x, y = joints.turned(joints.less(model.centre[driver.link], tip), body.angle)
    x, y = slider.through_m[0] + x, slider.through_m[1] + y

    def turn(place: float | None, speed: float) -> None:
        if place is not None:
            body.position = x + place * u, y + place * v
        body.velocity = speed * u, speed * v

    return turn


def _pin_motor(model: SpaceModel, dt_s: float) -> Turn:
    """Make a driver between two bodies, which corrects in each step a `SHARE` of its error."""
    driver, motor = model.scene.driver, model.motor
    link, base = model.crank, model.bodies[driver.base]
    at_start = float(driver.law.at(np.array([model.state.time_s]))[0][0])
    whole_rad = math.tau * round((link.angle - base.angle - at_start) / math.tau)

    def turn(place: float | None, speed: float) -> None:
        assert motor is not None
        motor.rate = speed
        if place is not None:
            moves = link.angular_velocity - base.angular_velocity
            comes_to = link.angle - base.angle - whole_rad + moves * dt_s
            motor.rate = speed + SHARE * (place + speed * dt_s - comes_to) / dt_s

    return turn
