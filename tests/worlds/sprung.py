"""Springs with dampers of all three kinds in a mechanism."""

from __future__ import annotations

import random
from dataclasses import replace

from analytic.structure.mobility import analyse
from models.scene import GROUND, Scene
from models.springs import LineSpring, PinSpring, SlideSpring, Spring


def sprung(scene: Scene, chance: random.Random) -> Scene:
    """The scene with a spring of each kind that it has room for, one of them without a rate or
    without a damper now and then; between points it may be slack at length 0."""
    springs: dict[str, Spring] = {}
    points = list(analyse(scene).pins)
    a, b = chance.sample(points, 2)
    if not {a, b} <= set(scene.ground):
        springs["line"] = LineSpring(
            "line", *_sizes(chance, 300.0), chance.choice((0.0, 0.3)), (a, b)
        )
    pins = {
        point: [one for one in held if one == GROUND or one in scene.links]
        for point, held in analyse(scene).pins.items()
    }
    meeting = [point for point, held in pins.items() if len(held) > 1]
    point = chance.choice(meeting)
    first, second = chance.sample(pins[point], 2)
    springs["pin"] = PinSpring(
        "pin", *_sizes(chance, 30.0), chance.uniform(-2.0, 2.0), point, (first, second)
    )
    if scene.sliders:
        slider = chance.choice(list(scene.sliders))
        springs["slide"] = SlideSpring(
            "slide", *_sizes(chance, 300.0), chance.uniform(-0.5, 0.5), slider
        )
    return replace(scene, springs=springs)


def _sizes(chance: random.Random, size: float) -> tuple[float, float]:
    rate, damping = chance.uniform(0.1, 1.0) * size, chance.uniform(0.01, 0.1) * size
    return chance.choice(((rate, damping), (rate, 0.0), (0.0, damping)))
