"""Cams: disc cams with one follower, which a law of motion moves.

::

        |  translating: up at x = +e          oscillating: pivot at x = +d, psi from the
       (+)  roller (knife: no radius)         line from the pivot to the cam's centre
      __|__                                        (+)____ l
     (  O--|- e                               ( O )- psi -_ o
      \\___/                                    \\_/      d

All lengths in m. The cam turns by its angle times ``sense``; its law counts the angle in that
sense, so that mirrored cams have one law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from models.scene.cam_laws import CamLaw

CONTACTS = ("knife", "roller", "flat")
"""A knife edge is a roller of radius 0; a flat face is a straight line."""


@dataclass(frozen=True)
class _CamFollower:
    contact: str
    roller_m: float = 0.0

    def __post_init__(self) -> None:
        if self.contact not in CONTACTS:
            raise ValueError(f"no contact {self.contact!r:.60}; there are {', '.join(CONTACTS)}")
        for name, number in vars(self).items():
            if name != "contact" and not math.isfinite(number):
                raise ValueError(f"{name} is {number!r:.60}; a follower needs finite numbers")
        if (self.roller_m > 0.0) != (self.contact == "roller") or self.roller_m < 0.0:
            raise ValueError(
                f"roller_m is {self.roller_m:g} of a follower with a {self.contact}; a roller has "
                "a radius above 0, and others have none"
            )

    @property
    def is_flat(self) -> bool:
        return self.contact == "flat"


@dataclass(frozen=True)
class TranslatingFollower(_CamFollower):
    """A follower that slides along +y at x = ``offset_m``. A flat face stands across: its offset
    is that of the guide, and changes no profile."""

    offset_m: float = 0.0

    def start(self, base_m: float) -> float:
        """Return y of the tip, or of the face, at lift 0 [m]. Raises ValueError for an offset
        beyond the base circle."""
        reach = base_m + self.roller_m
        if self.is_flat:
            return base_m
        if not abs(self.offset_m) < reach:
            raise ValueError(
                f"offset_m is {self.offset_m:g}, and base circle and roller reach to {reach:g} m; "
                "give a smaller offset"
            )
        return math.sqrt((reach - self.offset_m) * (reach + self.offset_m))

    def base(self, start_m: float) -> float:
        """Return the base radius [m] of a start, the inverse of `start`."""
        return start_m if self.is_flat else math.hypot(start_m, self.offset_m) - self.roller_m


@dataclass(frozen=True)
class OscillatingFollower(_CamFollower):
    """A follower that turns about a pivot at ``pivot_m`` from the cam's centre.

    A knife edge or roller sits at the end of an arm of ``arm_m``; a flat face is parallel to the
    line through the pivot, ``face_m`` from it, positive away from the cam. The lift turns it away
    from the cam.
    """

    pivot_m: float = 0.0
    arm_m: float = 0.0
    face_m: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.pivot_m > 0.0:
            raise ValueError(f"pivot_m is {self.pivot_m:g}; give a distance above 0")
        if (self.arm_m > 0.0) == self.is_flat or (self.face_m != 0.0 and not self.is_flat):
            raise ValueError(
                f"found arm_m {self.arm_m:g} and face_m {self.face_m:g}; a {self.contact} follower "
                f"has {'a face and no arm' if self.is_flat else 'an arm above 0 and no face'}"
            )

    def start(self, base_m: float) -> float:
        """Return psi at lift 0 [rad]. Raises ValueError for a base circle that it cannot touch."""
        d, arm = self.pivot_m, self.arm_m
        low, high = (self.face_m, self.face_m + d) if self.is_flat else (abs(d - arm), d + arm)
        reach = base_m + self.roller_m
        if not low <= reach <= high:
            raise ValueError(
                f"base circle and roller reach to {reach:g} m, and the follower touches circles "
                f"of {low:g} to {high:g} m; give a base radius, arm and pivot that fit"
            )
        if self.is_flat:
            return math.asin((base_m - self.face_m) / d)
        # Half the angle between d and the arm in the triangle with the side ``reach``.
        up, along = (reach - d + arm) * (reach + d - arm), (high - reach) * (high + reach)
        return 2.0 * math.atan2(math.sqrt(max(up, 0.0)), math.sqrt(along))

    def base(self, start_rad: float) -> float:
        """Return the base radius [m] of a start, the inverse of `start`."""
        if self.is_flat:
            return self.pivot_m * math.sin(start_rad) + self.face_m
        sine = math.sin(0.5 * start_rad)  # the third side, without cancellation
        between = self.pivot_m - self.arm_m
        return math.sqrt(between**2 + 4.0 * self.pivot_m * self.arm_m * sine**2) - self.roller_m


Follower = TranslatingFollower | OscillatingFollower


@dataclass(frozen=True)
class Cam:
    """A cam: law of motion, base radius of its profile [m], follower, sense (+1 counter-clockwise).

    Its law lifts in m for a translating follower, and in rad for an oscillating one. Raises
    ValueError for a base circle that the follower cannot touch.
    """

    law: CamLaw
    base_m: float
    follower: Follower
    sense: int = 1

    def __post_init__(self) -> None:
        if not 0.0 < self.base_m < math.inf:
            raise ValueError(f"base_m is {self.base_m!r:.60}; give a base radius above 0")
        if self.sense not in (1, -1):
            raise ValueError(f"sense is {self.sense!r:.60}; give 1 (counter-clockwise) or -1")
        self.follower.start(self.base_m)

    @property
    def start(self) -> float:
        """Coordinate of the follower at lift 0 [m or rad]."""
        return self.follower.start(self.base_m)
