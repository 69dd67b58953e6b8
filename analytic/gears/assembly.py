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

from models.errors import CrankcheckError, few
from models.scene.pairs import Gear, Points

WHOLE = 1e-6
"""Difference from a whole number that the places of planets may make, in teeth."""
LISTED = 30
"""Numbers that a message lists."""
Teeth = tuple[int, int]
"""Teeth of a planet and of the central gear that it meshes with, negative of a ring."""


@dataclass(frozen=True)
class PlanetStage:
    """A planet on a carrier between two central gears, ``teeth`` by mesh, at ``angle_rad`` from
    their centre. ``kind`` is common to equal planets; ``most`` of them, evenly spread, clear each
    other's addendum circles."""

    planet: str
    kind: tuple[object, ...]
    teeth: tuple[Teeth, Teeth]
    angle_rad: float
    most: int

    @property
    def period(self) -> int:
        """Places on the carrier where a planet fits, evenly spread; 0: everywhere."""
        (p, a), (q, b) = self.teeth
        return abs(q * a - p * b) // math.gcd(p, q)

    @property
    def counts(self) -> list[int]:
        """Numbers of equal planets, evenly spread, that fit and clear each other."""
        return [n for n in range(1, self.most + 1) if self.period % n == 0]

    def check(self, count: int) -> None:
        """Raise CrankcheckError if so many equal planets do not fit, or touch each other."""
        if count in self.counts:
            return
        fault = f"overlap: {self.most} have room beside each other"
        if count < 1 or self.period % count:
            places = self.period / max(count, 1)
            fault = (
                f"can not be assembled: {self.sum}/{count} = {places:.6g} has to be a whole number"
            )
        raise CrankcheckError(f"{count} equal planets like {self.planet} {fault}; {self.works}")

    @property
    def works(self) -> str:
        """The numbers that work, in words."""
        return f"numbers that work: {few(map(str, self.counts), LISTED)}"

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
    meshes: dict[tuple[str, ...], list[tuple[str, Teeth, float]]] = {}
    for gear in gears:
        sign, (one, other), pivots = -1 if gear.internal else 1, gear.teeth, gear.pivots(points)
        distance = gear.distance_m(points)
        for n, teeth in enumerate(((one, sign * other), (other, sign * one))):
            if distance > 0.0:
                place = gear.bodies[n], gear.carrier, pivots[n], pivots[1 - n]
                share = 0.5 * (gear.module(points) or 0.0) * (teeth[0] + 2) / distance
                meshes.setdefault(place, []).append((gear.bodies[1 - n], teeth, share))
    stages = []
    for (planet, carrier, own, centre), its in meshes.items():
        (x, y), (ox, oy) = points[carrier][own], points[carrier][centre]
        for (sun, teeth, tip), (ring, others, second_tip) in combinations(its, 2):
            # Of n planets neighbours are 2 a sin(pi / n) apart, and their tips reach a share of a.
            share = max(tip, second_tip)
            most = math.ceil(math.pi / math.asin(share)) - 1 if share < 1.0 else 1
            both, angle = (teeth, others), math.atan2(y - oy, x - ox)
            stages.append(PlanetStage(planet, (carrier, sun, ring, both), both, angle, most))
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
