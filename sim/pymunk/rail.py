"""A point on a line in pymunk, held where the groove joint is in error.

Chipmunk's groove joint solves for both components of the impulse and then drops the one along the
line. Unless the bodies answer to a push along the line with a motion along the line alone, the
sliding speed leaks into the constraint: the point leaves its line, by an error of first order in
the step however many iterations there are, and a slider-crank with a massless piston comes apart.
A rail holds the point by one scalar constraint across the line.
"""

from __future__ import annotations

from dataclasses import dataclass

import pymunk

from models.scene import Point


@dataclass(frozen=True)
class Rail:
    """A point held on a line by a pin joint whose far end moves along with the point.

    The far end stands across the line from the point, at a fixed distance, in the frame of the
    guide; it is set between the position and the velocity half of each step.
    """

    rider: pymunk.Body
    guide: pymunk.Body
    anchor: Point
    start: Point
    along: Point
    arm: float

    def joint(self) -> pymunk.PinJoint:
        """The pin joint, set for the present positions."""
        joint = pymunk.PinJoint(self.guide, self.rider, (0.0, 0.0), self.anchor)
        joint.distance = self.arm
        self.follow(joint, None)
        joint.pre_solve = self.follow
        return joint

    def follow(self, joint: pymunk.Constraint, _space: object) -> None:
        """Bring the far end level with the point."""
        place = self.guide.world_to_local(self.rider.local_to_world(self.anchor))
        (ux, uy), (x, y) = self.along, self.start
        s = (place[0] - x) * ux + (place[1] - y) * uy
        joint.anchor_a = (
            x + s * ux - self.arm * uy,
            y + s * uy + self.arm * ux,
        )
