"""What the driver places: a body that it moves against the ground, by any kind of pair.

The reference has one driver's angle psi [rad] throughout. Of a pin that is the coordinate itself.
Of a slider it is the displacement over a scale, s = scale psi, so large that the mechanism closes
only within half a turn of 0, and a power of two, so that nothing is rounded: what is looked for
over a turn of a crank (limit positions, change points, whole turns) is looked for over all places
of a slider.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from analytic.dyads.parts import Sliding
from analytic.dyads.plane import (
    EPS,
    EXACT_ANGLE,
    STEADY,
    AngleError,
    BodyKinematics,
    PointError,
    PointKinematics,
    Real,
    Vec,
    direction,
    fixed_point,
)
from analytic.dyads.rounding import rounding_of_angles
from models.array import Array
from models.joints import local_point, sliding_angle
from models.scene import Point, Scene, span

SINES = 2 * EPS
"""What the driver's direction is off by for the rounding of sine and cosine [rad]."""


def driver_scale(scene: Scene) -> float:
    """The driver's coordinate over the reference's driver angle: 1 of a pin; of a slider a power
    of two [m], more than a third of all lengths of the scene together."""
    if scene.driver.slider is None:
        return 1.0
    lengths = [span(link.points) for link in scene.links.values()]
    lengths += [math.hypot(*place) for place in scene.ground.values()]
    lengths += [math.hypot(*slider.through_m) for slider in scene.sliders.values()]
    start = abs(float(scene.driver.law.at(np.zeros(1))[0][0]))
    return float(2.0 ** math.ceil(math.log2((2.0 * sum(lengths) + start) / math.pi)))


def told(scene: Scene, theta: float) -> str:
    """A driver angle of the reference in words: degrees, or metres of a slider that is driven."""
    if scene.driver.slider is not None:
        return f"{theta * driver_scale(scene):.6g} m"
    return f"{math.degrees(theta):.6g} deg"


def turning_driver(
    scene: Scene, pivot: str, theta: Array, omega: Real, alpha: Real, error: AngleError | None
) -> BodyKinematics:
    """A link at an angle about its pin to the ground."""
    turn = Vec(np.cos(theta), np.sin(theta))
    anchor = fixed_point(scene.ground[pivot])
    local = scene.links[scene.driver.link].points[pivot]
    return BodyKinematics(local, anchor, turn, omega, alpha, error, theta)


def sliding_driver(scene: Scene, found: Sliding) -> BodyKinematics:
    """A body at a displacement along a line of the ground."""
    driver = scene.driver
    assert driver.slider is not None
    slider = scene.sliders[driver.slider]
    along = direction(slider.direction_rad)
    anchor = PointKinematics(
        along * found.s + Vec(*slider.through_m),
        along * found.speed,
        along * found.acceleration,
        None,
    )
    angle = sliding_angle(slider)
    own = None
    if found.error is not None:
        leaning = rounding_of_angles(slider.direction_rad) + 2 * EPS
        anchor = replace(anchor, error=_along_line(slider.through_m, found, leaning))
        own = replace(EXACT_ANGLE, theta=rounding_of_angles(slider.direction_rad, slider.angle_rad))
    local: Point = local_point(scene, driver.link, slider.point)
    return BodyKinematics(local, anchor, direction(angle), 0.0, STEADY, own, angle)


def _along_line(base: Point, found: Sliding, leaning: float) -> PointError:
    """Bounds of a point on a line of the ground whose direction is known but for ``leaning``."""
    assert found.error is not None
    e, way = found.error, np.abs(found.s)
    return PointError(
        e.displacement + leaning * way + EPS * (way + math.hypot(*base)),
        e.speed + (leaning + EPS) * np.abs(found.speed),
        e.acceleration + (leaning + EPS) * np.abs(found.acceleration),
    )
