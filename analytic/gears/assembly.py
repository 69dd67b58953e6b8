"""Planetary trains that can be assembled: teeth of equal planets that fit both central gears.

A planet at the angle phi on the carrier meshes with central gears A and B (Z teeth, negative of a
ring) by gears of p and q teeth on one body. At phi + delta the same planet fits if

    (q Z_A - p Z_B) delta / (2 pi gcd(p, q))    is a whole number

Planets of one gear (p = q) between sun and ring: (z_s + z_r) delta / 2 pi; n of them, evenly:
(z_s + z_r)/n. Source: Mueller, Epicyclic Drive Trains (1982).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from models.errors import CrankcheckError
from models.scene.pairs import Gear, Points

WHOLE = 1e-6
"""Difference from a whole number that the places of planets may make, in teeth."""
MOST_PLANETS = 30
"""Largest number of planets that is tried."""


@dataclass(frozen=True)
class PlanetStage:
    """A planet between the central gears of the pairs ``first`` and ``second`` on one carrier; it
    stands at ``angle_rad`` and ``distance_m`` from their centre, and its largest gear has the
    ``tip_m`` radius of its addendum circle (0 without a module)."""

    planet: str
    first: Gear
    second: Gear
    angle_rad: float = 0.0
    distance_m: float = 0.0
    tip_m: float = 0.0

    @property
    def period(self) -> int:
        """Places on the carrier where a planet fits, evenly spread; 0: everywhere."""
        (p, a), (q, b) = (_from_planet(gear, self.planet) for gear in (self.first, self.second))
        return abs(q * a - p * b) // math.gcd(p, q)

    @property
    def kind(self) -> tuple[object, ...]:
        """What equal planets have in common: carrier, central gears and teeth."""
        sides = [(_other(g, self.planet), _from_planet(g, self.planet))
                 for g in (self.first, self.second)]  # fmt: skip
        return self.first.carrier, *sides

    def clearance_m(self, count: int) -> float:
        """Return the gap between the addendum circles of neighbours, ``count`` planets evenly
        spread; negative where they overlap."""
        return 2.0 * (self.distance_m * math.sin(math.pi / count) - self.tip_m)

    def counts(self) -> list[int]:
        """Numbers of equal planets, evenly spread, that fit and clear each other."""
        fitting = (n for n in range(1, MOST_PLANETS + 1) if self.period % n == 0)
        return [n for n in fitting if n == 1 or self.clearance_m(n) > 0.0 or not self.tip_m]

    def check(self, count: int) -> None:
        """Raise CrankcheckError if so many equal planets do not fit, or touch each other."""
        works = ", ".join(map(str, self.counts()))
        if count < 1 or self.period % count:
            raise CrankcheckError(
                f"{count} equal planets like {self.planet} can not be assembled: "
                f"{self._sum()}/{count} = {self.period / max(count, 1):.6g} has to be a whole "
                f"number; numbers that work: {works}"
            )
        if count > 1 and self.tip_m and self.clearance_m(count) <= 0.0:
            raise CrankcheckError(
                f"{count} planets like {self.planet} overlap: addendum circles of "
                f"{2e3 * self.tip_m:.6g} mm stand "
                f"{2e3 * self.distance_m * math.sin(math.pi / count):.6g} mm apart; numbers that "
                f"work: {works}"
            )

    def check_beside(self, other: PlanetStage) -> None:
        """Raise CrankcheckError if an equal planet does not fit where it stands beside this."""
        places = self.period * (other.angle_rad - self.angle_rad) / math.tau
        if abs(places - round(places)) > WHOLE * max(self.period, 1):
            step = 360.0 / self.period
            raise CrankcheckError(
                f"{other.planet} can not be assembled where it is: "
                f"{math.degrees(other.angle_rad - self.angle_rad) % 360.0:.6g} degrees from "
                f"{self.planet}, equal planets fit each {step:.6g} degrees ({self._sum()} = "
                f"{self.period} places); evenly spread, numbers that work: "
                f"{', '.join(map(str, self.counts()))}"
            )

    def _sum(self) -> str:
        (p, a), (q, b) = (_from_planet(gear, self.planet) for gear in (self.first, self.second))
        if p == q:
            return f"({abs(a)} {'+' if a * b < 0 else '-'} {abs(b)})"
        return f"({q} x {a} - {p} x {b})/{math.gcd(p, q)}".replace("- -", "+ ").replace("x -", "x ")


def planet_stages(gears: Iterable[Gear], points: Mapping[str, Points]) -> list[PlanetStage]:
    """Find the planets of a train that mesh with two central gears of one axis; ``points`` are
    those of all bodies (`models.scene.Scene.points_of`). Planets that mesh with planets are left
    out. Raises ValueError as `Gear.pivots`."""
    sides = [
        (gear, gear.pivots(points)[n], gear.pivots(points)[1 - n], gear.bodies[n])
        for gear in gears
        for n in (0, 1)
    ]
    found = []
    for k, (first, own, centre, planet) in enumerate(sides):
        for second, other, same, body in sides[k + 1 :]:
            meets = (own, centre, planet, first.carrier) == (other, same, body, second.carrier)
            if meets and own != centre and first is not second:
                at, middle = (points[first.carrier][point] for point in (own, centre))
                away = (at[0] - middle[0], at[1] - middle[1])
                tip = max(_tip_m(gear, planet, points) for gear in (first, second))
                found.append(
                    PlanetStage(planet, first, second, math.atan2(away[1], away[0]),
                                math.hypot(*away), tip)
                )  # fmt: skip
    return found


def check_planets(stages: Iterable[PlanetStage]) -> None:
    """Raise CrankcheckError for planets that do not fit beside the first of their kind."""
    first: dict[tuple[object, ...], PlanetStage] = {}
    for stage in stages:
        first.setdefault(stage.kind, stage).check_beside(stage)


def _other(gear: Gear, planet: str) -> str:
    return next(body for body in gear.bodies if body != planet)


def _from_planet(gear: Gear, planet: str) -> tuple[int, int]:
    """Teeth of the planet, and of the central gear, negative where one of them is a ring."""
    own = gear.bodies.index(planet)
    return gear.teeth[own], gear.teeth[1 - own] * (-1 if gear.internal else 1)


def _tip_m(gear: Gear, planet: str, points: Mapping[str, Points]) -> float:
    module = gear.module(points) or 0.0
    return 0.5 * module * (gear.teeth[gear.bodies.index(planet)] + 2)
