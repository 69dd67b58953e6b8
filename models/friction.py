"""What rubs in a joint: Coulomb's friction, or one that is always as large.

A joint is named as in the scene's file: a slider by its own name, a pin by its point. Where a
slider has the name of its point, that name is the slider; another name for the slider leaves that
of the point to the pin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CoulombFriction:
    """Friction of ``mu`` times the normal force in the pin or slider ``joint``; in a pin it acts at
    ``radius_m`` [m] from its centre, in a slider ``radius_m`` is 0."""

    joint: str
    mu: float
    radius_m: float = 0.0

    @property
    def arm_m(self) -> float:
        """The radius of the friction circle [m]: the couple in a pin over its reaction.

        A pin with play touches its bore along one line. The reaction leans from the normal there by
        the angle of friction, atan(mu), and passes the centre at r sin(atan(mu)): mu r is larger by
        1/cos of that angle. A couple of mu' r times the reaction, as of pins that are run in, is
        that of mu = tan(asin(mu')).
        """
        return self.radius_m * self.mu / math.hypot(1.0, self.mu)


@dataclass(frozen=True)
class ConstantFriction:
    """Friction in the pin or slider ``joint`` that is ``size`` against the motion, whatever the
    joint bears: a torque [N m] in a pin, a force [N] in a slider."""

    joint: str
    size: float


Friction = CoulombFriction | ConstantFriction
