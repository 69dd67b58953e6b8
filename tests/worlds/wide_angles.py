"""Random mechanisms whose angles are given with many whole turns, in files and in radians.

A crank with one or two dyads, of all kinds and in all roles, that turns at constant speed, where it
turns round at all however near to a dead point, or swings. Half of them are read from their file,
the others made in Python.
"""

import math
import random
import re
import tomllib
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.files.assemble import scene_text
from models.files.reading import parse_scene
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from tests.analytic.wide_chain import Angle, Given
from tests.worlds.strategies import KINDS, Layout, least_sine, some_forms, swinging, with_dyads

TURNS = 2775
"""Nearly a million degrees."""
FAR = 1e6
"""Turns of the driver."""
TRIES = 10
LOOKS, DEAD = 721, 0.02
TURNING = re.compile(r"(direction_deg|angle_deg|start_deg|centre_deg|phase_deg) = ([-+.e\d]+)")


@dataclass(frozen=True)
class Turned:
    """A mechanism, the angles as they were given, and the kind of its first dyad."""

    scene: Scene
    given: Given
    kind: str


def made(number: int) -> Turned:
    """The mechanism of a number; the kinds take turns."""
    chance = random.Random(number)
    kind = KINDS[number % len(KINDS)]
    scene = _driven(chance, some_forms(kind, chance))
    return _from_file(chance, scene, kind) if number % 2 else _in_radians(chance, scene, kind)


def times(scene: Scene, number: int, count: int) -> Array:
    """Times of either sign: within a period, and up to `FAR` of them."""
    rng = np.random.default_rng(number)
    spans = np.repeat([1.0, 1e3, FAR], -(-count // 3))[:count]
    return np.asarray(rng.uniform(-1.0, 1.0, count) * spans * scene.driver.law.period_s)


def _driven(chance: random.Random, forms: list[str]) -> Scene:
    """A crank with the dyads, turning round if that comes about, else swinging."""
    for _ in range(TRIES):
        at = Layout(chance.uniform, chance.choice)
        crank = at.crank(comes_round=True)
        speed = chance.choice((1, -1)) * 10 ** chance.uniform(-1.0, 3.0)
        based = ["RRR", *forms] if forms[0].startswith("PRP") else forms
        designed = with_dyads(at, based, crank, ConstantSpeed(at.frames[crank][1], speed))
        if least_sine(designed.scene, LOOKS) > DEAD:  # no dead point hides between the looks
            return designed.scene
    return swinging(designed, abs(speed)).scene


def _in_radians(chance: random.Random, scene: Scene, kind: str) -> Turned:
    """With whole turns added to the radians, of which some digits go."""

    def more(angle: float) -> float:
        return angle + math.tau * _whole(chance)

    sliders = {
        name: replace(
            s,
            direction_rad=more(s.direction_rad),
            angle_rad=more(s.angle_rad) if s.link is not None else 0.0,
        )
        for name, s in scene.sliders.items()
    }
    law = scene.driver.law.turned(math.tau * _whole(chance))
    scene = replace(scene, sliders=sliders, driver=replace(scene.driver, law=law))
    return Turned(scene, Given.of(scene), kind)


def _from_file(chance: random.Random, scene: Scene, kind: str) -> Turned:
    """Through the text of a file, with whole turns added to the degrees there."""

    def more(key: str, number: str) -> str:
        return f"{key} = {float(number) + 360.0 * _whole(chance)!r}"

    text = re.sub(TURNING, lambda found: more(*found.groups()), scene_text(scene))
    tree = tomllib.loads(text)
    sliders = tree.get("sliders", {})
    given = Given(
        {n: Angle(s["direction_deg"], in_degrees=True) for n, s in sliders.items()},
        {n: Angle(s.get("angle_deg", 0.0), in_degrees=True) for n, s in sliders.items()},
        {
            key.replace("_deg", "_rad"): Angle(number, in_degrees=True)
            for key, number in tree["driver"].items()
            if key.endswith("_deg")
        },
    )
    return Turned(parse_scene(text, f"random {kind}"), given, kind)


def _whole(chance: random.Random) -> int:
    """Turns of either sign; none of a fifth of the angles."""
    return 0 if chance.random() < 0.2 else chance.choice((1, -1)) * round(TURNS ** chance.random())
