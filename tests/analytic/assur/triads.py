"""Scenes with a triad: a crank, and a plate on three legs of given kinds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from models.array import Array
from models.laws import ConstantSpeed
from models.scene import Driver, Link, Point, Scene, Slider

KINDS = ("RR", "PR", "RP", "PP")


def turned(vector: Array, angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]]) @ vector


def triad_scene(kinds: Sequence[str], seed: int, crank_m: float = 0.04) -> Scene:
    """A scene that is assembled at its start: the crank carries the outer pin of the first leg that
    has one."""
    draw = np.random.default_rng(seed)
    place, phi = draw.uniform(-0.3, 0.3, 2) + np.array([1.0, 0.5]), draw.uniform(-3.0, 3.0)
    start = draw.uniform(-3.0, 3.0)
    ground: dict[str, Point] = {"A": (0.0, 0.0)}
    links: dict[str, Link] = {}
    sliders: dict[str, Slider] = {}
    crank_end = turned(np.array([crank_m, 0.0]), start)
    plate: dict[str, Point] = {}
    driven = next(i for i, kind in enumerate(kinds) if kind[0] == "R")
    for i, kind in enumerate(kinds):
        angle = math.tau * i / 3.0 + draw.uniform(-0.5, 0.5)
        local = turned(np.array([draw.uniform(0.2, 0.4), 0.0]), angle)
        at = place + turned(local, phi)
        q, outer = f"Q{i}", ("B" if i == driven else f"G{i}")
        far = crank_end if i == driven else at + draw.uniform(0.5, 0.9) * _unit(draw)
        if kind[0] == "R" and i != driven:
            ground[outer] = _pair(far)
        if kind == "RR":
            plate[q] = _pair(local)
            length = float(np.hypot(*(at - far)))
            links[f"leg{i}"] = bar(f"leg{i}", outer, q, length)
        elif kind == "PR":
            plate[q] = _pair(local)
            along = draw.uniform(-3.0, 3.0)
            through = at - 0.3 * turned(np.array([1.0, 0.0]), along)
            sliders[f"S{i}"] = Slider(
                f"S{i}", q, "ground", _pair(through), along, mass_kg=0.3, inertia_kg_m2=0.001
            )
        elif kind == "RP":
            way = turned(far - place, -phi)
            along = math.atan2(way[1] - local[1], way[0] - local[0])
            sliders[f"S{i}"] = Slider(
                f"S{i}", outer, "plate", _pair(local), along, mass_kg=0.3, inertia_kg_m2=0.001
            )
        else:
            links[f"leg{i}"] = Link(
                f"leg{i}", {f"P{i}": (0.0, 0.0), f"R{i}": (0.2, 0.1)}, 0.3, (0.1, 0.0), 0.01
            )
            plate[f"T{i}"] = _pair(local)
            leg_angle, slope = draw.uniform(-3.0, 3.0), draw.uniform(-3.0, 3.0)
            sliders[f"O{i}"] = Slider(
                f"O{i}",
                f"P{i}",
                "ground",
                _pair(at + 0.1),
                slope,
                link=f"leg{i}",
                angle_rad=leg_angle - slope,
            )
            inner = slope + 1.2 - leg_angle
            sliders[f"I{i}"] = Slider(
                f"I{i}",
                f"T{i}",
                f"leg{i}",
                (0.05, 0.02),
                inner,
                link="plate",
                angle_rad=phi - leg_angle - inner,
            )
    if len(plate) < 2:
        plate["E"] = (0.3, 0.1)
    links["plate"] = Link("plate", plate, 0.8, (0.05, 0.02), 0.02)
    crank = bar("crank", "A", "B", crank_m)
    return Scene(
        name="-".join(kinds),
        source="drawn at random",
        ground=ground,
        links={"crank": crank, **links},
        sliders=sliders,
        driver=Driver("crank", ConstantSpeed(start, 5.0)),
    )


def bar(name: str, one: str, other: str, length: float) -> Link:
    points = {one: (0.0, 0.0), other: (length, 0.0)}
    return Link(name, points, length, (0.5 * length, 0.0), length**3 / 12.0)


def _unit(draw: np.random.Generator) -> Array:
    return turned(np.array([1.0, 0.0]), draw.uniform(-3.0, 3.0))


def _pair(vector: Array) -> Point:
    return float(vector[0]), float(vector[1])
