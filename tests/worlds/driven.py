"""Random mechanisms for the engines, within the range that profile tuned is meant for.

A crank turns at constant speed, and one or two dyads (three, where the last needs two links to ride
on) hang on it and on each other, of all kinds and in all roles. What is random, and the range:

- lengths 0.2 to 2, the whole scaled by 0.01 to 100, turned and moved by up to three lengths;
- speed 0.1 to 1000 rad/s, either way, at `LEAST_STEPS` to `MOST_STEPS` steps a turn;
- every sine of a transmission angle at least `MARGIN` over the whole turn. Where no layout out of
  `TRIES` turns round with that margin the driver swings instead;
- links are slender rods as long as what they carry, of densities within 1 : `DENSITY`; half of the
  mechanisms have massless blocks, where MuJoCo can hold them;
- steps fine enough that no cap of a tolerance is in force (`reports.judge.tolerance`);
- joints that pymunk's iterations solve: those of profile tuned leave at most `LEFT` of an error
  (`contraction`). From about 0.35 on its mechanisms come apart.

`HARD` is a second range, for MuJoCo: sines from 0.15, densities 1:1000 (so that masses come to more
than that), every link with a point on an arm of up to ten of its lengths, to the end of which half
of the rods reach; and joints that pymunk's iterations solve or do not.
"""

import itertools
import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.assemble import scene_text
from models.files.reading import parse_scene
from models.mjcf.tree import plan
from models.scene import GROUND, Link, Point, Scene, Slider, span
from models.scene.laws import ConstantSpeed
from models.scene.moved import moved, scaled
from reports.compare.hardness import curvature
from reports.quantities.limits import DEFAULTS
from sim.pymunk.convergence import left_over
from sim.pymunk.settings import TUNED
from sim.pymunk.space import build
from tests.worlds import strategies

POSITIONS = 16


def contraction(scene: Scene) -> float:
    """The largest factor over a period that the error keeps in one iteration in the long run."""
    times = np.linspace(0.0, scene.driver.law.period_s, POSITIONS, endpoint=False)
    motion = solve(scene, times, bound=False)
    return max(left_over(build(scene, motion.state(k))) for k in range(POSITIONS))


CROSSED = tuple(form for form in strategies.FORMS if form.startswith("PRP"))
"""Two lines that may not become parallel: not one of the crank with one of the ground."""
BASES = tuple(f for f in strategies.FORMS if f not in CROSSED and not f.endswith("on guide"))
"""What they may ride on: something that does not turn with the crank."""
TRIES, MOST_TRIES = 40, 200
LOOKS = 181
LEAST_STEPS, MOST_STEPS = 180, 1440
DENSITY = 100.0
ROD_M, BLOCK_M, BLOCK_KG = 0.2, 0.1, 0.1
"""Length of the shortest rod, side of a block, and its mass at density 1."""
ITERATIONS = int(TUNED.settings["iterations"].value)
LEFT = 0.2
TRACED = "traced"
"""What the names of points begin with to which no rod reaches."""


@dataclass(frozen=True)
class Range:
    """What may be drawn: sines from ``margin``, densities 1 : ``density``, points on arms of up to
    ``arm`` lengths of their link (0: no such points), what pymunk's iterations leave (infinite: not
    looked at), and powers of ten of speed [rad/s] and scale."""

    margin: float = strategies.MARGIN
    density: float = DENSITY
    arm: float = 0.0
    least_left: float = 0.0
    most_left: float = LEFT
    speed: tuple[float, float] = (-1.0, 3.0)
    scale: tuple[float, float] = (-2.0, 2.0)


TUNED_RANGE = Range()
HARD = Range(margin=0.15, density=1000.0, arm=10.0, most_left=1.0)
WIDE = Range(density=1000.0, most_left=math.inf, speed=(-0.52, 2.85), scale=(-2.6, 0.4))
"""For exudyn: lengths of 5 mm to 5 m, 0.3 to 700 rad/s, masses from a gram to tons."""


@dataclass(frozen=True)
class Driven:
    """A random mechanism as its scene file says it, how to run a period of it, and what the
    iterations of profile tuned leave of an error of its joints."""

    scene: Scene
    text: str
    forms: tuple[str, ...]
    steps_per_turn: int
    turns_round: bool
    left: float


@st.composite
def recipes(draw: st.DrawFn) -> tuple[tuple[str, ...], int]:
    """Forms of one or two dyads, and a seed for the rest: what `made` makes a mechanism of."""
    forms = draw(st.lists(st.sampled_from(strategies.FORMS), min_size=1, max_size=2))
    if forms[0] in CROSSED:
        forms = [draw(st.sampled_from(BASES)), forms[0]]
    return tuple(forms), draw(st.integers(0, 2**64 - 1))


def made(forms: Sequence[str], seed: int, within: Range = TUNED_RANGE) -> Driven:
    """The mechanism of a seed, made anew until it is within the range; LookupError where it never
    is."""
    chance = random.Random(f"{seed}: {'; '.join(forms)}")
    name = f"random-{chance.getrandbits(64):x}"
    speed = chance.choice((1, -1)) * 10 ** chance.uniform(*within.speed)
    stuck = 0
    for _ in range(MOST_TRIES):
        designed = _laid_out(chance, forms, speed)
        turns_round = stuck < TRIES
        if not turns_round:
            designed = strategies.swinging(designed, abs(speed), within.margin)
        elif strategies.least_sine(designed.scene, LOOKS) < within.margin:
            stuck += 1
            continue
        scene = _weighed(chance, _with_arms(chance, designed.scene, within.arm), within.density)
        left = contraction(scene) ** ITERATIONS if math.isfinite(within.most_left) else 0.0
        fewest = _fewest_steps(scene)
        if within.least_left <= left <= within.most_left and fewest <= MOST_STEPS:
            break
    else:
        raise LookupError(f"{forms}: none of {MOST_TRIES} layouts is within the range")
    shift = (chance.uniform(-3.0, 3.0), chance.uniform(-3.0, 3.0))
    scene = scaled(moved(scene, shift), 10 ** chance.uniform(*within.scale))
    text = scene_text(replace(scene, name=name))
    steps = round(fewest * (MOST_STEPS / fewest) ** chance.random())
    return Driven(parse_scene(text, name), text, designed.forms, steps, turns_round, left)


def _laid_out(chance: random.Random, forms: Sequence[str], speed: float) -> strategies.Designed:
    """A crank with the dyads of the forms, anywhere."""
    at = strategies.Layout(chance.uniform, chance.choice)
    crank = at.crank(comes_round=True)
    return strategies.with_dyads(at, forms, crank, ConstantSpeed(at.frames[crank][1], speed))


def _fewest_steps(scene: Scene) -> float:
    """Steps a turn from which on no cap of a tolerance is in force, `LEAST_STEPS` at least."""
    motion = solve(scene, strategies.swing_times(scene, LOOKS), bound=False)
    sine = min(float(sine.min()) for sine in motion.conditioning.values())
    bend, law = curvature(scene, motion), scene.driver.law
    longest = min(
        (quantity.cap * sine / quantity.coefficient / bend**quantity.power) ** 0.5
        for quantity in (DEFAULTS["position"], DEFAULTS["velocity"], DEFAULTS["acceleration"])
    )
    return max(law.peak_speed_rad_s * law.period_s / longest, LEAST_STEPS)


def _with_arms(chance: random.Random, scene: Scene, most: float) -> Scene:
    """Each link with one more point, away from its first by up to ``most`` of its lengths."""
    if not most:
        return scene

    def armed(link: Link) -> Link:
        arm = max(span(link.points), ROD_M) * most ** chance.uniform(-0.5, 1.0)
        x, y = next(iter(link.points.values()))
        turn = chance.uniform(-math.pi, math.pi)
        end = (x + arm * math.cos(turn), y + arm * math.sin(turn))
        name = f"{chance.choice(('carried', TRACED))}-{link.name}"
        return replace(link, points={**link.points, name: end})

    return replace(scene, links={name: armed(link) for name, link in scene.links.items()})


def _weighed(chance: random.Random, scene: Scene, most: float) -> Scene:
    """The scene with random masses, of densities 1 : ``most``."""

    def density() -> float:
        return float(most ** chance.random())

    def block(slider: Slider) -> Slider:
        mass = BLOCK_KG * density()
        return replace(slider, mass_kg=mass, inertia_kg_m2=mass * BLOCK_M**2 / 6)

    carried = _carried(scene)
    links = {name: _rod(link, carried[name], density()) for name, link in scene.links.items()}
    light = replace(scene, links=links)
    blocks = {n: s if s.link else block(s) for n, s in scene.sliders.items()}
    if chance.random() < 0.5:
        try:
            plan(light, solve(light, np.zeros(1), bound=False).state())
        except EngineError:
            return replace(light, sliders=blocks)  # MuJoCo closes no loop at a massless block
        return light
    return replace(light, sliders=blocks)


def _carried(scene: Scene) -> Mapping[str, list[Point]]:
    """What each link has to reach, in its frame [m]: its pins, and where others slide on it."""
    motion = solve(scene, strategies.swing_times(scene, LOOKS), links=(), points=(), bound=False)
    found = {
        name: [place for point, place in link.points.items() if not point.startswith(TRACED)]
        for name, link in scene.links.items()
    }
    for slider in scene.sliders.values():
        if slider.on != GROUND:
            travel = motion.sliders[slider.name].displacement
            c, s = math.cos(slider.direction_rad), math.sin(slider.direction_rad)
            x, y = slider.through_m
            ends = (float(travel.min()), float(travel.max()))
            found[slider.on] += [(x + c * end, y + s * end) for end in ends]
    return found


def _rod(link: Link, places: Sequence[Point], density: float) -> Link:
    """The link as a slender rod between the two places that are farthest apart."""
    pairs = itertools.combinations_with_replacement(places, 2)
    (ax, ay), (bx, by) = max(pairs, key=lambda pair: math.dist(*pair))
    length = max(math.hypot(bx - ax, by - ay), ROD_M)
    centre = ((ax + bx) / 2, (ay + by) / 2)
    return Link(link.name, link.points, density * length, centre, density * length**3 / 12)
