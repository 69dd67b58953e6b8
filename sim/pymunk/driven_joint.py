"""Drive of a space: a prescribed crank or slider, or a motor in a pin."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pymunk

from models.scene import Point, joints
from sim.engine import Drive
from sim.pymunk.space import SpaceModel

SHARE = 0.1
"""Share of a motor's error that a step corrects: all at once is more than the iterations of profile
as-shipped settle, and adjacent joints open at any step; from 0.2 on in some positions."""


class DrivenJoint(Protocol):
    """Driver of a space."""

    def turn(self, place: float | None, speed: float) -> None:
        """Set the driver before a step: at a position from which the speed, of the step after it,
        moves it to the law's position at its end. None is where it is, at the start."""
        ...


@dataclass(frozen=True)
class KinematicCrank:
    """A body that turns about its origin."""

    body: pymunk.Body

    def turn(self, place: float | None, speed: float) -> None:
        if place is not None:
            self.body.angle = place
        self.body.angular_velocity = speed


@dataclass(frozen=True)
class KinematicSlider:
    """A body that moves along a line of the ground, from ``base`` [m]."""

    body: pymunk.Body
    base: Point
    along: Point

    def turn(self, place: float | None, speed: float) -> None:
        (x, y), (u, v) = self.base, self.along
        if place is not None:
            self.body.position = x + place * u, y + place * v
        self.body.velocity = speed * u, speed * v


@dataclass(frozen=True)
class ServoMotor:
    """A motor with a set speed only."""

    motor: pymunk.SimpleMotor

    def turn(self, place: float | None, speed: float) -> None:
        self.motor.rate = speed


@dataclass(frozen=True)
class PinMotor:
    """A motor between two bodies, which corrects in each step a `SHARE` of its error."""

    motor: pymunk.SimpleMotor
    link: pymunk.Body
    base: pymunk.Body
    whole_turns_rad: float
    dt_s: float

    def turn(self, place: float | None, speed: float) -> None:
        if place is None:
            self.motor.rate = speed
            return
        moves = self.link.angular_velocity - self.base.angular_velocity
        comes_to = self.link.angle - self.base.angle - self.whole_turns_rad + moves * self.dt_s
        due = place + speed * self.dt_s
        self.motor.rate = speed + SHARE * (due - comes_to) / self.dt_s


def driven_joint(model: SpaceModel, dt_s: float, drive: Drive) -> DrivenJoint:
    """Make the driver of a space at its start."""
    scene, driver = model.scene, model.scene.driver
    if drive == "servo" and model.motor is not None:
        return ServoMotor(model.motor)
    if driver.slider is not None:
        slider = scene.sliders[driver.slider]
        along = joints.turned((1.0, 0.0), slider.direction_rad)
        # The origin of the body is its centre of mass, at a constant way to the slider's point.
        tip = scene.links[driver.link].points[slider.point] if slider.link else (0.0, 0.0)
        centre = model.centre[driver.link]
        angle = model.crank.angle
        x, y = joints.turned((centre[0] - tip[0], centre[1] - tip[1]), angle)
        base = slider.through_m[0] + x, slider.through_m[1] + y
        return KinematicSlider(model.crank, base, along)
    if driver.is_inner and model.motor is not None:
        base_body = model.bodies[driver.base]
        apart = model.crank.angle - base_body.angle
        at_start = float(driver.law.at(np.array([model.state.time_s]))[0][0])
        whole = math.tau * round((apart - at_start) / math.tau)
        return PinMotor(model.motor, model.crank, base_body, whole, dt_s)
    return KinematicCrank(model.crank)
