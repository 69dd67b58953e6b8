"""Gears and cams of scenes: motion, forces and free motion, each by a second way."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import analytic.multibody.release_multibody as all_bodies
from analytic.cams.profile import touch
from analytic.forces.free_body import apply_loads, free_bodies
from analytic.forces.kinetostatics import forces
from analytic.forces.virtual_power import torque_by_power
from analytic.free.release import release
from analytic.kinematics import chunks, repeats_after, solve, unit_chunk
from analytic.structure.mobility import analyse, sides_of
from models.errors import CrankcheckError, StructureError
from models.files.assemble import scene_text
from models.files.reading import load_scene, parse_scene, shipped
from models.scene import Scene
from models.scene.driver import let_go
from models.scene.moved import mirrored, moved, rotated, scaled
from models.scene.pairs import Gear
from tests.worlds.tiers import few

GEARS, CAMS = tuple(shipped("gears")), tuple(shipped("cams"))
TIMES = np.linspace(0.0, 1.3, 97)


@pytest.mark.parametrize(
    ("name", "body", "ratio"),
    [
        ("gear-train", "output", Fraction(2, 9)),
        ("planetary", "arm", Fraction(1, 6)),
        ("planetary", "planet", Fraction(-1, 4)),
        # The arm at 1/3; the ring by Willis, (r - 1/3) / (1 - 1/3) = -30/90.
        ("differential", "ring", Fraction(1, 9)),
    ],
)
def test_trains_turn_by_willis(name: str, body: str, ratio: Fraction) -> None:
    scene = load_scene(name)
    motion = solve(scene, TIMES)
    driver = motion.links[scene.driver.link]
    own = motion.links[body]
    assert np.abs(own.theta - float(ratio) * driver.theta).max() < 1e-13
    assert np.abs(own.omega - float(ratio) * driver.omega).max() < 1e-13


@pytest.mark.parametrize("name", GEARS)
def test_pitch_circles_roll_without_slip(name: str) -> None:
    """The two gears of a pair have one velocity at the point where their pitch circles touch."""
    scene = load_scene(name)
    motion, still = solve(scene, TIMES), np.zeros((len(TIMES), 2))
    for gear in scene.gears.values():
        places, speeds, rates = [], [], []
        for body, pivot in zip(gear.bodies, gear.pivots(scene.points_of), strict=True):
            at = motion.points[pivot]
            places.append(at.position)
            speeds.append(at.velocity)
            rates.append(motion.links[body].omega if body != "ground" else still[:, 0])
        way = places[1] - places[0]
        radius = gear.teeth[0] * gear.slip_m(scene.points_of) * (-1.0 if gear.internal else 1.0)
        touch_m = places[0] + radius * way / np.hypot(*way.T)[:, None]
        seen = [
            v + w[:, None] * np.column_stack([-(touch_m - p)[:, 1], (touch_m - p)[:, 0]])
            for p, v, w in zip(places, speeds, rates, strict=True)
        ]
        assert np.abs(seen[0] - seen[1]).max() < 1e-13


@pytest.mark.parametrize("name", ["cam-roller", "cam-rocker"])
def test_a_roller_runs_on_the_pitch_curve(name: str) -> None:
    """In the frame of the cam its centre is where the cam's own geometry has it."""
    scene = load_scene(name)
    (pair,) = scene.cams.values()
    for each in (scene, mirrored(scene, ())):
        (own,) = each.cams.values()
        motion = solve(each, TIMES)
        turned = motion.links[own.cam].theta
        contact = touch(own.profile, own.law_angle(turned, np.zeros_like(turned)))
        assert contact.pitch is not None
        if own.slider:
            line = each.sliders[own.slider].direction_rad - math.pi / 2
            ground = contact.pitch * np.exp(1j * line)
        else:
            pitch = contact.pitch if own.side > 0 else contact.pitch.conj()
            way = complex(*each.ground["P"]) - complex(*each.ground["O"])
            ground = pitch * way / abs(way)
        tip = own.tip or each.sliders[own.slider].point
        seen = motion.points[tip].position @ np.array([1.0, 1j]) - complex(*each.ground["O"])
        assert np.abs(seen - ground).max() < 1e-14
        assert pair.profile.law is own.profile.law


@pytest.mark.parametrize("name", [*GEARS, *CAMS])
def test_torques_agree_with_virtual_power(name: str) -> None:
    scene = replace(load_scene(name), gravity_m_s2=(0.5, -9.81))
    found = forces(scene, TIMES)
    size = np.abs(found.torque).max()
    for span, chunk in chunks(scene, TIMES, bound=True):
        free = free_bodies(scene, chunk)
        apply_loads(scene, chunk, TIMES[span], free)
        if not scene.springs:
            power = torque_by_power(free, unit_chunk(scene, chunk.theta, bound=True), chunk)
            assert np.abs(power.value - found.torque[span]).max() < 1e-13 * size


@pytest.mark.parametrize(
    "name",
    few(["planetary", "sun-and-planet", "geared-five-bar"], ["planetary"], "other trains of gears"),
)
def test_free_motion_agrees_with_the_equations_of_all_bodies(name: str) -> None:
    scene = let_go(replace(load_scene(name), gravity_m_s2=(0.0, -9.81), loads={}), 0.15)
    times = np.linspace(0.0, 0.15, 13)
    one = release(scene, 0.15).at(times)
    other = all_bodies.release_multibody(scene, 0.15, near=one.state()).at(times)
    for link, own in one.links.items():
        assert np.abs(own.theta - other.links[link].theta).max() < 1e-11


def test_two_inputs_make_two_freedoms_of_free_motion() -> None:
    """A differential without its closing pair: the momenta of sun and arm follow their torques."""
    scene = load_scene("differential")
    gears = {name: gear for name, gear in scene.gears.items() if name in ("inner", "outer")}
    links = {name: link for name, link in scene.links.items() if name != "lay"}
    bare = replace(scene, gears=gears, links=links, loads={})
    with pytest.raises(StructureError, match="mobility"):
        analyse(bare)


@pytest.mark.parametrize("name", [*GEARS, *CAMS])
def test_motion_does_not_depend_on_the_place(name: str) -> None:
    scene = load_scene(name)
    assert parse_scene(scene_text(scene), "again") == scene
    motion = solve(scene, TIMES)
    turn = complex(math.cos(0.7), math.sin(0.7))
    others = (
        (rotated(scene, 0.7), lambda z: z * turn),
        (mirrored(scene, sides_of(scene)), np.conj),
        (scaled(scene, 3.0), lambda z: 3.0 * z),
        (moved(scene, (0.3, -2.0)), lambda z: z + complex(0.3, -2.0)),
    )
    for other, map_ in others:
        seen = solve(other, TIMES)
        for point, at in motion.points.items():
            here = map_(at.position @ np.array([1.0, 1j]))
            there = seen.points[point].position @ np.array([1.0, 1j])
            assert np.abs(here - there).max() < 1e-13


@pytest.mark.parametrize(("teeth", "turns"), [((40, 20), 1), ((20, 30), 3), ((24, 40), 5)])
def test_a_linkage_on_gears_comes_back_when_they_do(teeth: tuple[int, int], turns: int) -> None:
    scene = load_scene("geared-five-bar")
    (gear,) = scene.gears.values()
    scene = replace(scene, gears={"pair": replace(gear, teeth=teeth)})
    assert repeats_after(scene) == pytest.approx(turns * math.tau)
    period = scene.driver.law.period_s
    start, *later = solve(scene, period * np.arange(turns + 1)).points["C"].position
    back = [float(np.abs(place - start).max()) < 1e-12 for place in later]
    assert back == [False] * (turns - 1) + [True]


def _with(scene: Scene, **gears: Gear) -> Scene:
    return replace(scene, gears={**scene.gears, **gears})


def test_trains_that_do_not_move_are_refused() -> None:
    planetary = load_scene("planetary")
    extra = Gear("extra", ("sun", "arm"), (20, 40))
    with pytest.raises(StructureError, match="mobility"):
        analyse(_with(planetary, extra=extra))
    five = load_scene("geared-five-bar")
    with pytest.raises(CrankcheckError, match="return after 199 turns"):
        solve(_with(five, pair=replace(five.gears["pair"], teeth=(40, 199))), TIMES)
