"""Cams of a space as a relation: a force along the way of the follower, at the instant centre.

::

         | u          The point A of the cam, s' to the right of its centre O (times its sense),
      ___|__          moves along u at s' times the cam's speed: as fast as the follower. A pin
         |            joint from A along u to the follower lets both move so, and takes the torque
      O--A            of its force from the cam. With an oscillating follower A is on the line
        s'            through O and its pivot, and u across it.

Both ends are set anew before each step, for the chord of the law over the step; the error of the
follower's place so far is that of the joint's distance.
"""

from dataclasses import dataclass

import numpy as np
import pymunk

from models.errors import EngineError
from models.scene import Point, Scene
from models.scene.joints import local_point, turned
from models.scene.pairs import CamPair
from sim.pymunk.native import SpaceBodies

LEAST_CHORD = 1e-9
"""Turn of a cam in a step [rad] below which the chord of its law is its tangent."""
PARALLEL = 1e-6
"""Least difference of the follower's turning from the cam's, over the cam's."""


@dataclass(frozen=True)
class CamLine:
    """A cam, its follower and their carrier, in a space that is stepped by ``dt_s`` [s]."""

    scene: Scene
    placed: SpaceBodies
    pair: CamPair
    dt_s: float

    def joint(self) -> pymunk.PinJoint:
        """Make the pin joint, set for the present positions."""
        ends = self.placed.body(self.pair.cam), self.placed.body(self.pair.follower)
        joint = pymunk.PinJoint(*ends, (0.0, 0.0), (1.0, 0.0))
        self.follow(joint, None)
        joint.pre_solve = self.follow
        return joint

    def follow(self, joint: pymunk.Constraint, _space: object) -> None:
        """Set both ends at the instant centre, and the follower's error as that of the distance."""
        pair, scene = self.pair, self.scene
        bodies = [self.placed.body(one) for one in (pair.cam, pair.follower, pair.carrier)]
        cam, follower, carrier = bodies
        turning = self.dt_s * (cam.angular_velocity - carrier.angular_velocity)
        now, chord = self._lift(cam.angle - carrier.angle, turning)
        centre = self._at(pair.cam, pair.pivots(scene.points_of)[0])
        if pair.slider:
            off = self._displacement(carrier) - now
            angle = carrier.angle + scene.sliders[pair.slider].direction_rad
            u = turned((1.0, 0.0), angle)
            x, y = centre[0] + chord * u[1], centre[1] - chord * u[0]
        else:
            off, (x, y), u = self._turned(centre, follower.angle - carrier.angle, now, chord)
        arm = 2.0 * scene.longest_m
        joint.anchor_a = cam.world_to_local((x, y))
        joint.anchor_b = follower.world_to_local((x + arm * u[0], y + arm * u[1]))
        joint.distance = arm - off

    def _lift(self, angle: float, turning: float) -> tuple[float, float]:
        """Return the follower's coordinate by the law, and its change per turning of the cam over
        the next step."""
        value, slope, _ = self.pair.lift(angle)
        if abs(turning) > LEAST_CHORD:
            slope = (self.pair.lift(angle + turning)[0] - value) / turning
        return self.pair.lowest(self.scene.points_of, self.scene.sliders) + value, slope

    def _at(self, body: str, point: str) -> Point:
        """Return a point of a body in the plane [m]."""
        local = self.placed.from_centre(body, local_point(self.scene, body, point))
        place = self.placed.body(body).local_to_world(local)
        return place.x, place.y

    def _displacement(self, carrier: pymunk.Body) -> float:
        """Return the slider's displacement [m]."""
        slider = self.scene.sliders[self.pair.slider]
        through = carrier.local_to_world(self.placed.from_centre(slider.on, slider.through_m))
        x, y = self._at(self.pair.follower, slider.point)
        u = turned((1.0, 0.0), carrier.angle + slider.direction_rad)
        return u[0] * (x - through.x) + u[1] * (y - through.y)

    def _turned(
        self, centre: Point, angle: float, now: float, chord: float
    ) -> tuple[float, Point, Point]:
        """Return the error of an oscillating follower [m] at the instant centre, that centre, and
        the direction across the line through cam and pivot."""
        pivot = self._at(self.pair.follower, self.pair.pivots(self.scene.points_of)[1])
        d = pivot[0] - centre[0], pivot[1] - centre[1]
        apart = float(np.hypot(*d))
        ex, ey = d[0] / apart, d[1] / apart
        if abs(chord - 1.0) < PARALLEL:
            raise EngineError(f"cams.{self.pair.name}: its follower turns as fast as the cam")
        # omega_cam x = omega_follower (x - d)
        x = chord * apart / (chord - 1.0)
        off = float(np.remainder(angle - now + np.pi, 2.0 * np.pi) - np.pi)
        return off * (x - apart), (centre[0] + x * ex, centre[1] + x * ey), (-ey, ex)
