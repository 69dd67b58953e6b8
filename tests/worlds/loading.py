"""Random mechanisms of all dyads with random masses and loads, half of them near a dead point; with
friction in random joints, or with springs and dampers.
"""

import math
import random
from dataclasses import replace

import numpy as np

from analytic.kinematics import reach
from analytic.structure.mobility import analyse
from models.scene import GROUND, Driver, Point, Scene
from models.scene import loads as acting
from models.scene.characteristics import Characteristic, Constant, Polynomial, Sine
from models.scene.joints import block_name
from models.scene.laws import Accelerating, Oscillating
from models.scene.tabulated import Interpolation, Tabulated
from tests.worlds import strategies

TRIES = 8
OVER: tuple[acting.Over, ...] = ("time", "angle", "displacement")


def loaded_mechanism(number: int) -> tuple[Scene, bool]:
    """The mechanism of a number, the kinds of its first dyad taking turns, and whether it stands
    near a dead point at time 0: where the number is odd, but for some whose driver turns round."""
    chance = random.Random(number)
    kind = strategies.KINDS[number // 2 % len(strategies.KINDS)]
    for _ in range(TRIES):
        forms = strategies.some_forms(kind, chance)
        designed = _laid_out(chance, forms)
        if number % 2 == 0:
            return loaded(
                strategies.swinging(designed, chance.uniform(0.5, 20.0)).scene, chance
            ), False
        near = near_dead_point(designed.scene, chance)
        if near is not None:
            return loaded(near, chance), True
    return loaded(strategies.swinging(designed, 1.0).scene, chance), False


def _laid_out(chance: random.Random, forms: list[str]) -> strategies.Designed:
    at = strategies.Layout(chance.uniform, chance.choice)
    crank = at.crank()
    return strategies.with_dyads(
        at, forms, crank, Oscillating(at.frames[crank][1], strategies.SWINGS[0], 1.0)
    )


def near_dead_point(scene: Scene, chance: random.Random) -> Scene | None:
    """The scene with its driver, at time 0, as near to an end of its range as 1e-8 to 1e-2 rad;
    None where it turns round."""
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    ranges = [(low, high) for low, high in reach(scene) if 0.02 < high - low < math.tau - 1e-9]
    if not ranges:
        return None
    away = [abs(math.remainder(0.5 * sum(each) - start, math.tau)) for each in ranges]
    low, high = ranges[int(np.argmin(away))]
    off = 10 ** chance.uniform(-8.0, -2.0)
    theta = chance.choice((low + off, high - off))
    slow = chance.choice((1.0, 1e-20))  # where little but loads acts, the determinant decides
    law = Accelerating(theta, slow * chance.uniform(-20.0, 20.0), slow * chance.uniform(1.0, 300.0))
    return replace(scene, driver=Driver(scene.driver.link, law))


def massless(scene: Scene) -> Scene:
    links = {n: replace(k, mass_kg=0.0, inertia_kg_m2=0.0) for n, k in scene.links.items()}
    sliders = {n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in scene.sliders.items()}
    return replace(scene, links=links, sliders=sliders)


def loaded(scene: Scene, chance: random.Random) -> Scene:
    """The scene with masses, centres beside its points, gravity, and up to four loads; some of its
    blocks stay without mass."""

    def place() -> Point:
        return chance.uniform(-0.5, 0.5), chance.uniform(-0.5, 0.5)

    links = {
        name: replace(
            link,
            mass_kg=10 ** chance.uniform(-1.0, 1.0),
            centre_m=place(),
            inertia_kg_m2=10 ** chance.uniform(-2.0, 0.0),
        )
        for name, link in scene.links.items()
    }
    sliders = {
        name: replace(slider, mass_kg=mass, inertia_kg_m2=0.01 * mass)
        if slider.link is None and (mass := chance.choice((0.0, chance.uniform(0.1, 3.0))))
        else slider
        for name, slider in scene.sliders.items()
    }
    gravity = (0.0, 0.0) if chance.random() < 0.3 else (chance.uniform(-3.0, 3.0), -9.81)
    heavy = replace(scene, links=links, sliders=sliders, gravity_m_s2=gravity)
    names = [f"load{k}" for k in range(chance.randrange(5))]
    return replace(heavy, loads={name: _load(heavy, name, chance) for name in names})


def _load(scene: Scene, name: str, chance: random.Random) -> acting.Load:
    targets: list[tuple[str, str]] = [
        (link.name, point) for link in scene.links.values() for point in link.points
    ]
    targets += [
        (block_name(s), s.point)
        for s in scene.sliders.values()
        if s.link is None and s.mass_kg > 0.0
    ]
    body, point = chance.choice(targets)
    over = chance.choice(OVER if scene.sliders else OVER[:2])
    slider = chance.choice(list(scene.sliders)) if scene.sliders else None
    stroke = chance.choice(("both", "forward", "backward")) if slider else "both"
    if over != "displacement" and stroke == "both":
        slider = None
    torque = chance.random() < 0.3
    return acting.Load(
        name,
        body,
        None if torque else point,
        characteristic(over, chance),
        over,
        slider,
        stroke,  # type: ignore[arg-type]
        0.0 if torque else chance.uniform(-math.pi, math.pi),
        "ground" if torque else chance.choice(("ground", "body")),  # type: ignore[arg-type]
    )


def characteristic(over: acting.Over, chance: random.Random) -> Characteristic:
    """Of any kind; tables are wide enough for every stroke, or repeat with a turn."""
    size = 10 ** chance.uniform(0.0, 2.0)
    kind = chance.choice(("constant", "sine", "polynomial", "table"))
    if kind == "sine":
        return Sine(size, chance.uniform(0.5, 5.0), chance.uniform(-3.0, 3.0))
    if kind == "polynomial":
        return Polynomial(tuple(chance.uniform(-size, size) for _ in range(chance.randrange(1, 5))))
    interpolation: Interpolation = chance.choice(("linear", "pchip"))
    if kind == "table" and over == "angle":
        places = sorted(chance.uniform(0.0, math.tau) for _ in range(6))
        values = tuple(chance.uniform(-size, size) for _ in places)
        return Tabulated(tuple(places), values, interpolation, math.tau)
    if kind == "table" and over == "displacement":
        rows = sorted(sign * 4.0**k for k in range(-2, 12) for sign in (1, -1))
        values = tuple(chance.uniform(-size, size) for _ in rows)
        return Tabulated(tuple(rows), values, interpolation)
    return Constant(size)


def rubbed(scene: Scene, chance: random.Random, mu: float = 0.3) -> Scene:
    names = [p for p, held in analyse(scene).pins.items() if len(held) == 2]
    joints = [*(name for name in names if name not in scene.sliders), *scene.sliders]
    chosen = chance.sample(joints, chance.randint(1, min(4, len(joints))))
    friction: dict[str, acting.Friction] = {}
    for joint in chosen:
        if chance.random() < 0.25:
            friction[joint] = acting.ConstantFriction(joint, chance.uniform(0.1, 3.0))
        else:
            radius = 0.0 if joint in scene.sliders else chance.uniform(0.005, 0.1)
            friction[joint] = acting.CoulombFriction(joint, chance.uniform(0.0, mu), radius)
    return replace(scene, friction=friction)


def with_names_for_sliders(scene: Scene) -> Scene:
    """The scene with sliders that are not named as their points, which leaves those names to the
    pins of their blocks."""
    names = {name: f"line {name}" for name in scene.sliders}
    bodies = {f"block {name}": f"block {new}" for name, new in names.items()}

    def load(old: acting.Load) -> acting.Load:
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


def sprung(scene: Scene, chance: random.Random) -> Scene:
    """The scene with a spring of each kind that it has room for, one of them without a rate or
    without a damper now and then; between points it may be slack at length 0."""
    springs: dict[str, acting.Spring] = {}
    points = list(analyse(scene).pins)
    a, b = chance.sample(points, 2)
    if not {a, b} <= set(scene.ground):
        springs["line"] = acting.LineSpring(
            "line", *_sizes(chance, 300.0), chance.choice((0.0, 0.3)), (a, b)
        )
    pins = {
        point: [one for one in held if one == GROUND or one in scene.links]
        for point, held in analyse(scene).pins.items()
    }
    meeting = [point for point, held in pins.items() if len(held) > 1]
    point = chance.choice(meeting)
    first, second = chance.sample(pins[point], 2)
    springs["pin"] = acting.PinSpring(
        "pin", *_sizes(chance, 30.0), chance.uniform(-2.0, 2.0), point, (first, second)
    )
    if scene.sliders:
        slider = chance.choice(list(scene.sliders))
        springs["slide"] = acting.SlideSpring(
            "slide", *_sizes(chance, 300.0), chance.uniform(-0.5, 0.5), slider
        )
    return replace(scene, springs=springs)


def _sizes(chance: random.Random, size: float) -> tuple[float, float]:
    rate, damping = chance.uniform(0.1, 1.0) * size, chance.uniform(0.01, 0.1) * size
    return chance.choice(((rate, damping), (rate, 0.0), (0.0, damping)))
