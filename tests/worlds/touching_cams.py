"""Cams whose followers a spring closes, for engines that hold them by contact."""

from dataclasses import replace

import numpy as np

from analytic.cams.contact_force import FollowerLoad, lift_off
from analytic.cams.outline import outlined
from models.files.reading import parse_scene
from models.scene import Scene
from sim.run import run
from tests.worlds.runs import start_of

SLIDES = """
[links.lifter]
points = {{ R = [0.0, 0.0], T = [0.0, 0.1] }}
mass_kg = 0.5
[sliders.guide]
link = "lifter"
point = "R"
on = "ground"
through_m = [{offset}, 0.02]
direction_deg = 90.0
[springs.close]
slider = "guide"
rate_n_m = {rate}
free_m = {free}
[cams.disc]
slider = "guide"
"""
SWINGS = """
[links.lever]
points = {{ P = [0.01, 0.0], R = [{tip}, 0.0] }}
mass_kg = 0.5
centre_m = [0.01, 0.0]
inertia_kg_m2 = 7e-3
[springs.close]
pin = "P"
bodies = ["ground", "lever"]
rate_n_m_rad = 4.0
free_deg = {free}
[cams.disc]
follower = "lever"
tip = "R"
left = {left}
"""


def law(kind: str, lift: str) -> str:
    """Rise, dwell, return, dwell of a kind; of harmonic rise and return alone."""
    span, rest = (180.0, "") if kind == "harmonic" else (120.0, "{ motion='dwell', span_deg=60.0 }")
    sides = (f"{{ motion='{kind}', span_deg={span}, {lift.format(s)} }}, {rest}" for s in ("", "-"))
    return ", ".join(each.rstrip(", ") for each in sides)


def sprung(
    kind: str = "3-4-5",
    *,
    swings: bool = False,
    flat: bool = False,
    lift: float = 0.02,
    offset: float = 0.0,
    rate: float = 400.0,
    free: float = -0.07,
    left: bool = False,
    more: str = "",
) -> Scene:
    """A cam of base radius 40 mm at 10 rad/s, not about the origin of its link; its follower lifts
    20 mm or degrees, with a roller of 10 mm or a flat face."""
    sides = {"tip": -0.09, "free": -120.0 if left else 120.0, "left": str(left).lower()}
    body = SWINGS.format(**sides) if swings else SLIDES.format(offset=offset, rate=rate, free=free)
    lifts = f"lift_deg={{}}{lift * 1e3}" if swings else f"lift_m={{}}{lift}"
    contact = '"flat"' if flat else '"roller"\nroller_radius_m = 0.01'
    return parse_scene(
        f"""
name = "sprung"
source = "made up"
ground = {{ points = {{ O = [0.0, 0.02], P = [0.1, 0.02] }} }}
[links.cam]
points = {{ O = [0.003, -0.002], Q = [0.04, 0.0] }}
{body}
cam = "cam"
contact = {contact}
base_radius_m = 0.04
{more}
segments = [{law(kind, lifts)}]
[driver]
link = "cam"
speed_rad_s = 10.0
start_deg = 25.0
""",
        "sprung",
    )


def at_speed(scene: Scene, speed_rad_s: float) -> Scene:
    law = replace(scene.driver.law, speed_rad_s=speed_rad_s)
    return replace(scene, driver=replace(scene.driver, law=law))


def lift_off_rad_s(scene: Scene) -> float:
    """The closed form's speed of lift-off of a sliding follower."""
    pair, spring = scene.cams["disc"], scene.springs["close"]
    preload = spring.rate * (pair.lowest(scene.points_of, scene.sliders) - spring.free)
    load = FollowerLoad(scene.links["lifter"].mass_kg, spring.rate, preload)
    return lift_off(pair.profile, load)[0]


def opening(scene: Scene, engine: str, facets: int, steps: int) -> float:
    """The largest opening in the first turn, over the stroke."""
    held = outlined(scene, facets)
    dt_s = held.driver.law.period_s / steps
    done = run(held, start_of(held), engine, dt_s=dt_s, steps=steps)
    return float(np.max(done.gaps["disc"][3:])) / held.cams["disc"].profile.law.stroke


def flight(scene: Scene) -> float:
    """The largest opening of the first flight, over the stroke, by the oscillation of the follower
    on its spring from the angle at which nothing presses; 0 below the speed of lift-off."""
    pair, spring = scene.cams["disc"], scene.springs["close"]
    law, mass, omega = pair.profile.law, scene.links["lifter"].mass_kg, scene.driver.law.speed_rad_s
    stretch = pair.lowest(scene.points_of, scene.sliders) - spring.free
    phi = np.linspace(0.0, 2.0 * np.pi, 200_001)
    s, first, second, _ = law.at(phi)
    free = np.flatnonzero(mass * omega**2 * second + spring.rate * (s + stretch) < 0.0)
    if not free.size:
        return 0.0
    k = free[0]
    time_s, own = (phi[k:] - phi[k]) / omega, np.sqrt(spring.rate / mass)
    x = (s[k] + stretch) * np.cos(own * time_s) + omega * first[k] / own * np.sin(own * time_s)
    apart = x - stretch - s[k:]
    landed = np.flatnonzero(apart[10:] < 0.0)
    return float(np.max(apart[: landed[0] + 10 if landed.size else None])) / law.stroke


def lift_off_ratio(scene: Scene, engine: str, facets: int = 720, steps: int = 2000) -> float:
    """The engine's speed of lift-off over the closed form's: that at which a flight opens as far as
    the engine does at 1.04 of the closed form's."""
    own = lift_off_rad_s(scene)
    found = opening(at_speed(scene, 1.04 * own), engine, facets, steps)
    low, high = 1.0, 1.3
    for _ in range(30):
        middle = 0.5 * (low + high)
        below = flight(at_speed(scene, middle * own)) < found
        low, high = (middle, high) if below else (low, middle)
    return 1.04 / low
