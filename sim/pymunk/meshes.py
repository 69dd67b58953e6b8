"""Gears of a space: a gear joint on carriers at rest, else the slip of the pitch circles held.

::

              | L t                   Chipmunk's gear joint couples two bodies. On a moving carrier
    C0 -------P------- C1             the pitch circles roll at P: a pin joint from P of the first
       r0  r  |     r1                gear to a place L t of the second acts along the tangent t
                                      alone. Both ends are set anew before each step.
"""

import math
from dataclasses import dataclass

import pymunk

from models.errors import EngineError
from models.scene import GROUND, Point
from models.scene.joints import local_point
from models.scene.pairs import Gear
from sim.pymunk.native import SpaceBodies


def mesh(placed: SpaceBodies, gear: Gear) -> pymunk.Constraint:
    """Make the constraint of two gears; their module is known, or their carrier rests."""
    first, second = map(placed.body, gear.bodies)
    z0, z1 = gear.teeth[0], gear.second
    if gear.carrier == GROUND:
        return pymunk.GearJoint(first, second, -gear.constant_rad / z0, -z1 / z0)
    return Mesh.of(placed, gear).joint()


@dataclass(frozen=True)
class Mesh:
    """Two gears on a moving carrier: bodies, centres on them, and the radius of the first."""

    gear: Gear
    bodies: tuple[pymunk.Body, pymunk.Body]
    carrier: pymunk.Body
    centres: tuple[Point, Point]
    slip_m: float
    arm_m: float

    @staticmethod
    def of(placed: SpaceBodies, gear: Gear) -> "Mesh":
        """Make the mesh of a scene's gears. Raises EngineError for two about one centre."""
        scene = placed.scene
        if gear.module(scene.points_of) is None:
            raise EngineError(
                f"gears.{gear.name}: both turn about one centre of {gear.carrier}, which moves: "
                "pymunk has no such relation; give them centres apart"
            )
        ends = zip(gear.bodies, gear.pivots(scene.points_of), strict=True)
        first, second = (
            placed.from_centre(body, local_point(scene, body, pivot)) for body, pivot in ends
        )
        bodies = placed.body(gear.bodies[0]), placed.body(gear.bodies[1])
        carrier, arm = placed.body(gear.carrier), 2.0 * scene.longest_m
        return Mesh(gear, bodies, carrier, (first, second), gear.slip_m(scene.points_of), arm)

    def joint(self) -> pymunk.PinJoint:
        """Make the pin joint, set for the present positions."""
        joint = pymunk.PinJoint(*self.bodies, (0.0, 0.0), (self.arm_m, 0.0))
        self.roll(joint, None)
        joint.pre_solve = self.roll
        return joint

    def roll(self, joint: pymunk.Constraint, _space: object) -> None:
        """Set both ends at the pitch point, and the slip so far as the error of the distance."""
        (one, other), sign = self.bodies, -1.0 if self.gear.internal else 1.0
        (x0, y0), (x1, y1) = (
            body.local_to_world(at) for body, at in zip(self.bodies, self.centres, strict=True)
        )
        apart = math.hypot(x1 - x0, y1 - y0)
        ex, ey = (x1 - x0) / apart, (y1 - y0) / apart
        radius = sign * self.gear.teeth[0] * self.slip_m
        x, y = x0 + radius * ex, y0 + radius * ey
        joint.anchor_a = one.world_to_local((x, y))
        joint.anchor_b = other.world_to_local((x - self.arm_m * ey, y + self.arm_m * ex))
        z0, z1 = self.gear.teeth[0], self.gear.second
        slip = z0 * one.angle + z1 * other.angle - (z0 + z1) * self.carrier.angle
        joint.distance = self.arm_m + sign * self.slip_m * (slip - self.gear.constant_rad)
