"""Cranks that hold a body in two or three of its positions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

from analytic.lectures.synthesis.pose import Pose, bisector, circle_through
from models.errors import CrankcheckError


@dataclass(frozen=True)
class Dyad:
    """A crank: its fixed pivot [m], its moving pivot in the body's own frame [m]."""

    fixed: complex
    moving: complex

    def radius(self, poses: Sequence[Pose]) -> float:
        """The distance of its pivots [m]."""
        return abs(poses[0].at(self.moving) - self.fixed)

    def turns(self, poses: Sequence[Pose]) -> list[float]:
        """Its angle in each position [rad]."""
        return [cmath.phase(pose.at(self.moving) - self.fixed) for pose in poses]


def about_bisector(poses: Sequence[Pose], moving: complex, distance_m: float) -> Dyad:
    """Of two positions: the fixed pivot on the bisector of a moving one's places, so far from the
    middle, to the left of its way. Raises CrankcheckError of a point that stays."""
    first, second = (pose.at(moving) for pose in poses)
    return Dyad(bisector(first, second).at(distance_m), moving)


def about_circumcentre(poses: Sequence[Pose], moving: complex, letter: str) -> Dyad:
    """Of three positions: the fixed pivot in the middle of the circle through a moving one's
    places. Raises CrankcheckError where they lie on a line."""
    places = [pose.at(moving) for pose in poses]
    centre = circle_through(*places)
    if centre is None:
        across = math.degrees(cmath.phase(1j * (places[2] - places[0]))) % 180.0
        raise CrankcheckError(
            f"{letter} lies on a line in the three positions: the centre of its circle is at "
            f"infinity, along {across:.4g} deg; a crank can not hold it (a slider on that line "
            "can); take another moving pivot"
        )
    return Dyad(centre, moving)


def about_given_pivot(poses: Sequence[Pose], fixed: complex, letter: str) -> Dyad:
    """Of three positions and a fixed pivot: inversion, as the body sees it. To the body the pivot
    is in three places, and the middle of their circle is the moving pivot. Raises CrankcheckError
    where they lie on a line."""
    centre = circle_through(*(pose.back(fixed) for pose in poses))
    if centre is None:
        raise CrankcheckError(
            f"seen from the body, {letter} lies on a line in the three positions: the moving pivot "
            "is at infinity; take another place for it"
        )
    return Dyad(fixed, centre)
