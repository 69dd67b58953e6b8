"""Gears and cams in the engines that crankcheck offers them in."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.assemble import scene_text
from models.files.reading import load_scene, parse_scene, shipped
from models.lectures.tasks.cams import load_cam_task
from models.scene import GROUND, Driver, Link, Scene
from models.scene.laws import ConstantSpeed
from reports.judge.cell import check
from reports.lectures.cams.cam_request import designed
from reports.lectures.cams.cam_scene import cam_scene
from sim.run import run
from tests.analytic.gears.trains import KNOWN
from tests.worlds.engines import SIMPLE
from tests.worlds.runs import ran, start_of
from tests.worlds.tiers import few, slow
from tests.worlds.turns import of_turns

ENGINES = ("mujoco", "pymunk", "exudyn")
FEW = ("planetary", "sun-and-planet", "cam-rocker")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    "name", few([*shipped("gears"), *shipped("cams")], FEW, "the others are of the same kinds")
)
def test_a_tuned_engine_is_within_tolerance_with_forces(name: str, engine: str) -> None:
    found = check(of_turns(load_scene(name), engine, 360, with_forces=True))
    assert found.verdict == "within", found.failures


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["gear-train", "planetary"])
def test_loaded_gears_are_within_1e5_of_a_radian_at_a_millisecond(name: str, engine: str) -> None:
    scene = load_scene(name)
    motion = ran(scene, engine, dt_s=1e-3, steps=600).motion
    true = solve(scene, motion.time_s)
    for link, own in true.links.items():
        assert np.abs(motion.links[link].theta - own.theta).max() < 1e-5


@slow("three runs of each kind of law")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["cam-roller", "cam-rocker"])
def test_followers_are_within_1e4_of_the_stroke(name: str, engine: str) -> None:
    scene = load_scene(name)
    (pair,) = scene.cams.values()
    motion = ran(scene, engine, dt_s=scene.driver.law.period_s / 720, steps=1440).motion
    true = solve(scene, motion.time_s)
    if pair.slider:
        off = motion.sliders[pair.slider].displacement - true.sliders[pair.slider].displacement
    else:
        off = motion.links[pair.follower].theta - true.links[pair.follower].theta
    assert np.abs(off).max() < 1e-4 * pair.profile.law.stroke


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_a_free_cam_keeps_its_energy(engine: str) -> None:
    """Where MuJoCo takes a light cam's angle for a length, and pymunk the chord of the law for the
    tangent, a turn gains 4 and 3 hundredths."""
    scene = load_scene("cam-flat")
    dt_s = scene.driver.law.period_s / 1000
    energy = ran(scene, engine, dt_s=dt_s, steps=1000, drive="free").energy
    assert np.abs(energy.total_j - energy.total_j[0]).max() < 1e-3 * energy.kinetic_j.max()


@pytest.mark.parametrize(
    "name", few(["valve-roller", "rocker-arm", "flat-tappet"], ["flat-tappet"], "as shipped scenes")
)
def test_the_scene_of_a_designed_cam_is_held(name: str) -> None:
    """The last one has a law with a jump of the acceleration, at samples of the run."""
    task, _ = load_cam_task(name)
    made = cam_scene(task.name, task.source, designed(task))
    scene = parse_scene(scene_text(made), "made")
    for engine in ENGINES:
        found = check(of_turns(scene, engine, 360, with_forces=True))
        assert found.verdict == "within", found.failures


@pytest.mark.parametrize("engine", SIMPLE)
@pytest.mark.parametrize(("name", "what"), [("planetary", "gears"), ("cam-flat", "cams")])
def test_other_engines_say_that_they_are_not_offered(engine: str, name: str, what: str) -> None:
    scene = load_scene(name)
    done = run(scene, start_of(scene), engine, dt_s=1e-3, steps=20)
    assert done.status == "unsupported"
    assert f"{what} (" in done.reason
    assert "not offered by crankcheck" in done.reason


def _scene(name: str) -> Scene:
    """A published train as a scene: central bodies about one point, planets beside it, each gear
    pinned to its carrier; where centres stand does not matter to the ratios."""
    known = KNOWN[name]
    held = dict.fromkeys(known.held, GROUND)
    gears = [
        replace(
            gear,
            bodies=tuple(held.get(body, body) for body in gear.bodies),
            carrier=held.get(gear.carrier, gear.carrier),
        )
        for gear in known.gears
    ]
    carriers = {gear.carrier for gear in known.gears}
    every = {body for gear in gears for body in (*gear.bodies, gear.carrier)} - {GROUND}
    on = {body: {gear.carrier for gear in known.gears if body in gear.bodies} for body in every}
    met = {body: sum(body in gear.bodies for gear in known.gears) for body in every}
    planets = [
        body for body in sorted(every)
        if body not in {*carriers, known.source}
        and met[body] > 1 and len(on[body]) == 1 and GROUND not in on[body]
    ]  # fmt: skip
    points = {GROUND: {"O": (0.0, 0.0)}} | {body: {f"tip-{body}": (0.1, 0.0)} for body in every}
    for number, body in enumerate(sorted(every)):
        if body in planets:
            (carrier,) = on[body]
            place = (0.06 * math.cos(number), 0.06 * math.sin(number))
            points[held.get(carrier, carrier)][body] = place
            points[body][body] = (0.0, 0.0)
        elif on.get(body) == {GROUND}:
            points[GROUND][body] = (0.05 * number, 0.0)
            points[body][body] = (0.0, 0.0)
        else:
            points[body]["O"] = (0.0, 0.0)
    links = {body: Link(body, points[body], 1.0, (0.0, 0.0), 1e-3) for body in sorted(every)}
    named = {f"g{n}": replace(gear, name=f"g{n}") for n, gear in enumerate(gears)}
    driver = Driver(known.source, ConstantSpeed(0.0, 5.0))
    return Scene(name, "published", points[GROUND], links, {}, driver, gears=named)


@slow("24 trains in three engines")
@pytest.mark.parametrize("name", KNOWN)
def test_published_trains_turn_by_their_ratios(name: str) -> None:
    scene, known = _scene(name), KNOWN[name]
    times = np.linspace(0.0, 0.4, 41)
    own = solve(scene, times).links[known.body].theta
    assert np.abs(own - float(known.ratio) * 5.0 * times).max() < 1e-12 * abs(own[-1]) + 1e-13
    for engine in ENGINES:
        done = run(scene, start_of(scene), engine, dt_s=1e-3, steps=400)
        if (name, engine) == ("wolfrom", "pymunk"):  # 162 to 1: its iterations do not converge
            assert done.status == "diverged"
            continue
        assert done.status == "ok", (engine, done.reason)
        assert done.motion is not None
        turned = done.motion.links[known.body].theta
        off = np.abs(turned - float(known.ratio) * 5.0 * done.motion.time_s).max()
        assert off < 1e-5 * max(1.0, abs(float(known.ratio))), engine
