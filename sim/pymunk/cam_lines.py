"""Cams of a space as a relation: the force along the way of the follower, at the instant centre.

::

         | u                 The point A of the cam, sigma s' to the right of its centre O, moves
      ___|__ follower        along u at s' times the cam's speed: as fast as the follower. A pin
         |                   joint from A along u to the follower lets both move so, and has the
      O--A                   torque of the force on the cam. An oscillating follower has A on the
         s'                  line through O and its pivot.

Both ends are set anew before each step, by the chord of the law over the step, and the error of the
follower's place so far is the error of the joint's distance.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class CamLine:
    """A cam and its follower: their bodies, the places on them, and the follower's coordinate."""
