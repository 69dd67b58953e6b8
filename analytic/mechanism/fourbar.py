"""The four-bar in closed form: Grashof class, limits, transmission angle, swing, time ratio.

Lengths by their place in the loop, as in the figure; the driver turns about A, the rocker about D::

            C
      b   /  \\  c           a driver AB, b coupler BC, c rocker CD, d ground AD
        B     \\
     a /       \\
      A ------- D
           d

Source: R. L. Norton, Design of Machinery, chapters 2 (Grashof), 3 (time ratio) and 4 (limits).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.scene import Scene

GrashofClass = Literal[
    "crank-rocker", "double-crank", "double-rocker", "triple-rocker", "change point"
]
SAME = 1e-12
"""Sums of lengths that differ by less, relative to their size, are equal: a change point."""


@dataclass(frozen=True)
class FourBar:
    """The four lengths [m]: driver a, coupler b, rocker c, ground d."""

    driver: float
    coupler: float
    rocker: float
    ground: float

    def __post_init__(self) -> None:
        lengths = sorted((self.driver, self.coupler, self.rocker, self.ground))
        if lengths[0] <= 0.0 or not math.isfinite(lengths[3]):
            raise ValueError(f"lengths {lengths}: four finite lengths above 0 make a four-bar")
        short = lengths[3] - sum(lengths[:3])
        if short > 0.0:
            raise ValueError(
                f"lengths {lengths}: the longest exceeds the sum of the others by {short:.4g} m, "
                "so the loop cannot close"
            )

    @staticmethod
    def of(scene: Scene) -> FourBar:
        """The four-bar that a scene is. Raises StructureError if it is something else."""
        groups = analyse(scene).groups
        if len(groups) != 1 or groups[0].kind != "RRR":
            kinds = ", ".join(group.kind for group in groups)
            raise StructureError(f"{scene.name}: not a four-bar; its groups are {kinds}")
        group = groups[0]
        links = {name: link.points for name, link in scene.links.items()}
        first, second = group.first, group.second
        crank_pin, rocker_pivot = group.outer1, group.outer2
        if crank_pin in scene.ground:
            first, second, crank_pin, rocker_pivot = second, first, rocker_pivot, crank_pin
        pivot = scene.driver_pivot
        driver = links[scene.driver.link]
        if crank_pin not in driver or rocker_pivot not in scene.ground:
            raise StructureError(
                f"{scene.name}: not a four-bar; {group.first} and {group.second} hang between "
                "pins of one body"
            )
        lengths = (
            math.dist(driver[pivot], driver[crank_pin]),
            math.dist(links[first][crank_pin], links[first][group.inner]),
            math.dist(links[second][rocker_pivot], links[second][group.inner]),
            math.dist(scene.ground[pivot], scene.ground[rocker_pivot]),
        )
        try:
            return FourBar(*lengths)
        except ValueError as error:
            raise StructureError(f"{scene.name}: not a four-bar; {error}") from None

    @property
    def excess_m(self) -> float:
        """s + l - p - q [m]: negative for Grashof chains, 0 at a change point."""
        s, p, q, longest = sorted((self.driver, self.coupler, self.rocker, self.ground))
        return (s - p) + (longest - q)

    @property
    def grashof_class(self) -> GrashofClass:
        """Which links turn fully against the ground."""
        lengths = (self.driver, self.coupler, self.rocker, self.ground)
        if abs(self.excess_m) <= SAME * sum(lengths):
            return "change point"
        if self.excess_m > 0.0:
            return "triple-rocker"
        shortest = min(lengths)
        if shortest == self.ground:
            return "double-crank"
        return "double-rocker" if shortest == self.coupler else "crank-rocker"

    @property
    def driver_turns_fully(self) -> bool:
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        tolerance = SAME * (a + b + c + d)
        return a + d <= b + c + tolerance and abs(a - d) >= abs(b - c) - tolerance

    @property
    def driver_range_rad(self) -> tuple[float, float]:
        """The driver's angles against AD on one side of it (from, to), within 0 to pi [rad].

        The other side mirrors it. (0, pi) where the driver turns fully.
        """
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        near = _angle(a, d, max(abs(b - c), abs(a - d)))
        far = _angle(a, d, min(b + c, a + d))
        return near, far

    @property
    def transmission_rad(self) -> tuple[float, float]:
        """Smallest and largest angle between coupler and rocker over the driver's range [rad]."""
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        near, far = max(abs(b - c), abs(a - d)), min(b + c, a + d)
        return _angle(b, c, near), _angle(b, c, far)

    @property
    def rocker_limits_rad(self) -> tuple[float, float]:
        """The rocker's angles against DA at its two limits (crank and coupler in line) [rad].

        Raises StructureError unless the driver is the crank of a crank-rocker.
        """
        self._require_crank()
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        return _angle(c, d, b - a), _angle(c, d, b + a)

    @property
    def rocker_swing_rad(self) -> float:
        """The angle between the rocker's limits [rad]."""
        low, high = self.rocker_limits_rad
        return high - low

    @property
    def time_ratio(self) -> float:
        """Time of the slower stroke of the rocker over that of the quicker, at constant speed."""
        self._require_crank()
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        # Crank angles of the limits: coupler drawn over the crank, and in line with it.
        imbalance = abs(_angle(d, abs(b - a), c) - _angle(d, b + a, c))
        return (math.pi + imbalance) / (math.pi - imbalance)

    def _require_crank(self) -> None:
        if self.grashof_class != "crank-rocker" or self.driver > self.rocker:
            raise StructureError(
                f"a {self.grashof_class} driven at its {self.driver:g} m link: rocker limits and "
                "time ratio belong to a crank-rocker driven at its crank"
            )


def _angle(p: float, q: float, opposite: float) -> float:
    """The angle between sides p and q of a triangle with the given opposite side [rad].

    By half-angle sines: no cancellation where the triangle is nearly flat.
    """
    above = (opposite - (p - q)) * (opposite + (p - q))
    below = ((p + q) - opposite) * ((p + q) + opposite)
    return 2.0 * math.atan2(math.sqrt(max(above, 0.0)), math.sqrt(max(below, 0.0)))
