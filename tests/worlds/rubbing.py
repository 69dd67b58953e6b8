"""Friction in random joints of random mechanisms."""

from __future__ import annotations

import random
from dataclasses import replace

from analytic.structure.mobility import analyse
from models.friction import ConstantFriction, CoulombFriction, Friction
from models.loads import Load
from models.scene import Scene
from tests.worlds.loading import loaded_mechanism


def rubbed(scene: Scene, chance: random.Random, mu: float = 0.3) -> Scene:
    names = [p for p, held in analyse(scene).pins.items() if len(held) == 2]
    joints = [*(name for name in names if name not in scene.sliders), *scene.sliders]
    chosen = chance.sample(joints, chance.randint(1, min(4, len(joints))))
    friction: dict[str, Friction] = {}
    for joint in chosen:
        if chance.random() < 0.25:
            friction[joint] = ConstantFriction(joint, chance.uniform(0.1, 3.0))
        else:
            radius = 0.0 if joint in scene.sliders else chance.uniform(0.005, 0.1)
            friction[joint] = CoulombFriction(joint, chance.uniform(0.0, mu), radius)
    return replace(scene, friction=friction)


def with_names_for_sliders(scene: Scene) -> Scene:
    """The scene with sliders that are not named as their points, which leaves those names to the
    pins of their blocks."""
    names = {name: f"line {name}" for name in scene.sliders}
    bodies = {f"block {name}": f"block {new}" for name, new in names.items()}

    def load(old: Load) -> Load:
        slider = None if old.slider is None else names[old.slider]
        return replace(old, body=bodies.get(old.body, old.body), slider=slider)

    return replace(
        scene,
        sliders={names[n]: replace(one, name=names[n]) for n, one in scene.sliders.items()},
        branch={names.get(key, key): sign for key, sign in scene.branch.items()},
        loads={name: load(one) for name, one in scene.loads.items()},
    )


def rubbed_mechanism(number: int) -> tuple[Scene, bool]:
    """The loaded mechanism of a number with friction, and whether it is near a dead point."""
    scene, near = loaded_mechanism(number)
    return rubbed(with_names_for_sliders(scene), random.Random(number)), near
