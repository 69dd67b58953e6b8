"""Gears and cams of a space as relations: a force along their common way at the instant centre.

::

              | u                 | u     Where both bodies have the same velocity, a pin joint
    C0 -------P------- C1      ___|__     from one along u to the other lets them move so, and gives
       r0  r  |     r1            |       each the torque of its force. Pitch circles roll at P. A
                               O--A       cam moves A, s' to the right of its centre O (times its
                                 s'       sense), along u as fast as its follower; where that turns,
                                          A is on the line through O and its pivot, and u across it.

Both ends are set before each step; the error of the place so far is that of the joint's distance,
and so is the bend of a cam's law over the step. (Along the chord of the law, half a step ahead, the
force would give or take energy, to first order in the step.) Chipmunk's gear joint couples two
bodies, and so holds gears on a carrier at rest.
"""

import math
from collections.abc import Callable

import numpy as np
import pymunk

from models.errors import EngineError
from models.scene import GROUND, Point
from models.scene.joints import turned
from models.scene.pairs import CamPair, Gear
from sim.pymunk.native import SpaceBodies

PARALLEL = 1e-6
"""Least difference of the follower's turning from the cam's, over the cam's."""
Rolling = tuple[Point, Point, float]
"""Instant centre of two bodies [m], direction of the force, and the second body's error along
it."""


def mesh(placed: SpaceBodies, gear: Gear) -> pymunk.Constraint:
    """Make the constraint of two gears. Raises EngineError for two about one moving centre."""
    points, z0, z1 = placed.scene.points_of, gear.teeth[0], gear.second
    first, second, carrier = map(placed.body, (*gear.bodies, gear.carrier))
    if gear.carrier == GROUND:
        return pymunk.GearJoint(first, second, -gear.constant_rad / z0, -z1 / z0)
    if gear.module(points) is None:
        raise EngineError(
            f"gears.{gear.name}: both turn about one centre of {gear.carrier}, which moves: "
            "pymunk has no such relation; give them centres apart"
        )
    pivots, slip_m = gear.pivots(points), math.copysign(gear.slip_m(points), z1)

    def rolling() -> Rolling:
        (x, y), (x1, y1) = map(placed.at, gear.bodies, pivots)
        radius, apart = z0 * slip_m, math.hypot(x1 - x, y1 - y)
        ex, ey = (x1 - x) / apart, (y1 - y) / apart
        slip = z0 * first.angle + z1 * second.angle - (z0 + z1) * carrier.angle
        off = slip_m * (gear.constant_rad - slip)
        return (x + radius * ex, y + radius * ey), (-ey, ex), off

    return _pinned(placed, *gear.bodies, rolling)


def cam_line(placed: SpaceBodies, pair: CamPair, dt_s: float) -> pymunk.Constraint:
    """Make the constraint of a cam as a relation, in a space that is stepped by ``dt_s`` [s]. It
    raises EngineError in a step in which the follower turns as fast as the cam."""
    scene, bodies = placed.scene, (pair.cam, pair.follower)
    cam, follower, carrier = map(placed.body, (*bodies, pair.carrier))
    pivots = pair.pivots(scene.points_of)
    lowest = pair.lowest(scene.points_of, scene.sliders)

    def rolling() -> Rolling:
        angle = cam.angle - carrier.angle
        turning = dt_s * (cam.angular_velocity - carrier.angular_velocity)
        slope, ahead = pair.lift(angle)[1], pair.lift(angle + turning)[0]
        wanted = lowest + ahead - slope * turning
        ox, oy = placed.at(pair.cam, pivots[0])
        if pair.slider:
            slider = scene.sliders[pair.slider]
            u = turned((1.0, 0.0), carrier.angle + slider.direction_rad)
            through = carrier.local_to_world(placed.from_centre(slider.on, slider.through_m))
            x, y = placed.at(pair.follower, slider.point)
            off = u[0] * (x - through.x) + u[1] * (y - through.y) - wanted
            return (ox + slope * u[1], oy - slope * u[0]), u, off
        if abs(slope - 1.0) < PARALLEL:
            raise EngineError(f"cams.{pair.name}: its follower turns as fast as the cam")
        px, py = placed.at(pair.follower, pivots[1])
        apart = float(np.hypot(px - ox, py - oy))
        ex, ey = (px - ox) / apart, (py - oy) / apart
        x = slope * apart / (slope - 1.0)  # omega_cam x = omega_follower (x - apart)
        off = follower.angle - carrier.angle - wanted
        off = (off + math.pi) % math.tau - math.pi
        return (ox + x * ex, oy + x * ey), (-ey, ex), off * (x - apart)

    return _pinned(placed, *bodies, rolling)


def _pinned(
    placed: SpaceBodies, first: str, second: str, rolling: Callable[[], Rolling]
) -> pymunk.PinJoint:
    """Make the pin joint of two bodies, set for the present positions."""
    one, other, arm = placed.body(first), placed.body(second), 2.0 * placed.scene.longest_m

    def follow(joint: pymunk.Constraint, _space: object) -> None:
        (x, y), (ux, uy), off = rolling()
        joint.anchor_a = one.world_to_local((x, y))
        joint.anchor_b = other.world_to_local((x + arm * ux, y + arm * uy))
        joint.distance = arm - off

    joint = pymunk.PinJoint(one, other, (0.0, 0.0), (1.0, 0.0))
    follow(joint, None)
    joint.pre_solve = follow
    return joint
