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
from itertools import combinations

from models.errors import CrankcheckError
from models.scene.pairs import Gear, Points

WHOLE = 1e-6
"""Difference from a whole number that the places of planets may make, in teeth."""
MOST_PLANETS = 30
"""Largest number of planets that is tried."""


@dataclass(frozen=True)
class PlanetStage:
    """A planet on a carrier between two central gears.

    ``teeth`` are those of planet and central gear by mesh, negative of a ring, ``kind`` is what
    equal planets have in common. It stands at ``angle_rad`` and ``distance_m`` from the centre, and
    its largest gear has the ``tip_m`` radius of its addendum circle (0 without a module).
    """

    planet: str
    kind: tuple[object, ...]
    teeth: tuple[tuple[int, int], tuple[int, int]]
    angle_rad: float = 0.0
    distance_m: float = 0.0
    tip_m: float = 0.0

    @property
    def period(self) -> int:
        """Places on the carrier where a planet fits, evenly spread; 0: everywhere."""
        (p, a), (q, b) = self.teeth
        return abs(q * a - p * b) // math.gcd(p, q)

    def clearance_m(self, count: int) -> float:
        """Return the gap between the addendum circles of neighbours, ``count`` planets evenly
        spread; negative where they overlap."""
        return 2.0 * (self.distance_m * math.sin(math.pi / count) - self.tip_m)

    def _overlaps(self, count: int) -> bool:
        return count > 1 and self.tip_m > 0.0 and self.clearance_m(count) <= 0.0

    def counts(self) -> list[int]:
        """Numbers of equal planets, evenly spread, that fit and clear each other."""
        fitting = (n for n in range(1, MOST_PLANETS + 1) if self.period % n == 0)
        return [n for n in fitting if not self._overlaps(n)]

    def check(self, count: int) -> None:
        """Raise CrankcheckError if so many equal planets do not fit, or touch each other."""
        if count < 1 or self.period % count:
            fault = (
                f"equal planets like {self.planet} can not be assembled: {self.sum}/{count} = "
                f"{self.period / max(count, 1):.6g} has to be a whole number"
            )
        elif self._overlaps(count):
            apart_m = self.distance_m * math.sin(math.pi / count)
            fault = (
                f"planets like {self.planet} overlap: addendum circles of {2e3 * self.tip_m:.6g} "
                f"mm stand {2e3 * apart_m:.6g} mm apart"
            )
        else:
            return
        raise CrankcheckError(f"{count} {fault}; {self.works}")

    @property
    def works(self) -> str:
        """The numbers that work, in words."""
        return f"numbers that work: {', '.join(map(str, self.counts()))}"

    @property
    def sum(self) -> str:
        """The sum of teeth that gives the places, in words."""
        (p, a), (q, b) = self.teeth
        if p == q:
            return f"({abs(a)} {'+' if a * b < 0 else '-'} {abs(b)})"
        return f"({q} x {a} - {p} x {b})/{math.gcd(p, q)}".replace("- -", "+ ").replace("x -", "x ")


def planet_stages(gears: Iterable[Gear], points: Mapping[str, Points]) -> list[PlanetStage]:
    """Find the planets of a train that mesh with two central gears of one axis; ``points`` are
    those of all bodies (`models.scene.Scene.points_of`). Planets that mesh with planets are left
    out. Raises ValueError as `Gear.pivots`."""
    meshes: dict[tuple[str, ...], list[tuple[str, tuple[int, int], float]]] = {}
    for gear in gears:
        sign, (one, other), pivots = -1 if gear.internal else 1, gear.teeth, gear.pivots(points)
        module = gear.module(points) or 0.0
        for n, teeth in enumerate(((one, sign * other), (other, sign * one))):
            if pivots[0] != pivots[1]:
                place = gear.bodies[n], gear.carrier, pivots[n], pivots[1 - n]
                mesh = gear.bodies[1 - n], teeth, 0.5 * module * (teeth[0] + 2)
                meshes.setdefault(place, []).append(mesh)
    stages = []
    for (planet, carrier, own, centre), its in meshes.items():
        (x, y), (ox, oy) = points[carrier][own], points[carrier][centre]
        angle, distance = math.atan2(y - oy, x - ox), math.hypot(x - ox, y - oy)
        for (sun, teeth, tip), (ring, others, second_tip) in combinations(its, 2):
            both, most = (teeth, others), max(tip, second_tip)
            kind = carrier, sun, ring, both
            stages.append(PlanetStage(planet, kind, both, angle, distance, most))
    return stages


def check_planets(stages: Iterable[PlanetStage]) -> None:
    """Raise CrankcheckError for planets that do not fit beside the first of their kind."""
    firsts: dict[tuple[object, ...], PlanetStage] = {}
    for stage in stages:
        first = firsts.setdefault(stage.kind, stage)
        turned, period = stage.angle_rad - first.angle_rad, first.period
        places = period * turned / math.tau
        if abs(places - round(places)) > WHOLE * max(period, 1):
            raise CrankcheckError(
                f"{stage.planet} can not be assembled where it is: "
                f"{math.degrees(turned) % 360.0:.6g} degrees from {first.planet}, equal planets "
                f"fit each {360.0 / period:.6g} degrees ({first.sum} = {period} places); evenly "
                f"spread, {first.works}"
            )
