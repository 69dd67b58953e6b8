"""Driving torque and reactions of mechanisms that are worked out otherwise, and what is refused."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.check.moved_scene import moved, rotated
from analytic.dyads.plane import Vec
from analytic.forces import kinetostatics
from analytic.kinematics import solve, solve_driven
from models.characteristics import Constant, Polynomial
from models.errors import CrankcheckError
from models.files import load_scene, parse_scene
from models.loads import Load
from models.tabulated import Tabulated
from tests.analytic.forces.beside import apart, series, turn
from tests.worlds.loading import loaded


def test_forces_of_a_motion_are_those_of_its_times() -> None:
    scene = loaded(load_scene("sixbar-stephenson"), random.Random(3))
    time_s = turn(scene)
    by_time = kinetostatics.forces(scene, time_s)
    of_motion = kinetostatics.forces(scene, solve(scene, time_s))
    bare = kinetostatics.forces(scene, time_s, bound=False)
    assert apart(by_time, of_motion) < 1e-14
    assert np.all(of_motion.bound.torque < 3.0 * by_time.bound.torque)
    assert np.all(by_time.bound.torque < 3.0 * of_motion.bound.torque)
    assert bare.bound is None
    for (name, a), (_, b) in zip(series(by_time), series(bare), strict=True):
        np.testing.assert_array_equal(a, b, err_msg=name)


def test_chunks_make_no_difference() -> None:
    scene = load_scene("slider-crank-offset")
    time_s = np.linspace(0.0, 3.0, 30_000)
    whole = kinetostatics.forces(scene, time_s, bound=False)
    part = kinetostatics.forces(scene, time_s[25_000:25_010], bound=False)
    np.testing.assert_allclose(whole.torque[25_000:25_010], part.torque, rtol=1e-14)


def test_all_forces_of_a_pin_add_up_to_nothing() -> None:
    """Of three bodies too; the ground stands first: what it exerts on the link is the second."""
    scene = replace(parse_scene(SHARED, "shared"), gravity_m_s2=(0.0, -9.81))
    assert len(scene.pins["B"]) == 3
    found = kinetostatics.forces(scene, turn(scene))
    largest = max(np.abs(force).max() for name, force in series(found) if name.startswith("pin"))
    for by_body in found.pins.values():
        assert np.abs(sum(by_body.values())).max() < 1e-14 * largest
    assert next(iter(found.pins["A"])) == "ground"


def test_a_hanging_weight_pulls_its_pin_down() -> None:
    """A crank that hangs: the pin holds m g - m omega^2 r up, the drive keeps it where it is."""
    scene = parse_scene(HANGING, "hanging")
    found = kinetostatics.forces(
        scene, solve_driven(scene, np.radians([-90.0, 0.0]), np.array(2.0), np.array(0.0))
    )
    down, level = found.pins["A"]["crank"]
    assert down == pytest.approx([0.0, 3.0 * (9.81 + 4.0 * 0.2)], abs=1e-14)
    assert level == pytest.approx([-3.0 * 4.0 * 0.2, 3.0 * 9.81], abs=1e-14)
    assert found.torque == pytest.approx([0.0, 3.0 * 9.81 * 0.2], abs=1e-14)
    np.testing.assert_array_equal(found.pins["A"]["ground"], -found.pins["A"]["crank"])


SHARED = """
name = "shared"
source = "test"
[ground]
points = { A = [0.0, 0.0], D = [0.3, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
coupler = { bar = ["B", "C"], length_m = 0.25 }
rocker = { bar = ["D", "C"], length_m = 0.2 }
rod = { bar = ["B", "E"], length_m = 0.3 }
[sliders.E]
on = "ground"
mass_kg = 0.5
[driver]
link = "crank"
speed_rad_s = 10.0
"""
HANGING = """
name = "hanging"
source = "test"
gravity_m_s2 = [0.0, -9.81]
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.4, mass_kg = 3.0 }
[driver]
link = "crank"
speed_rad_s = 1.0
"""


def test_force_on_a_central_slider_crank_is_that_of_the_textbook() -> None:
    """Massless rod, a force on the piston: side thrust F tan(psi), torque F r sin(phi + psi) /
    cos(psi), with the rod's lean psi (Shigley and Uicker, Theory of Machines, slider-crank)."""
    scene = load_scene("slider-crank-central")
    links = {n: replace(k, mass_kg=0.0, inertia_kg_m2=0.0) for n, k in scene.links.items()}
    sliders = {n: replace(s, mass_kg=1e-9) for n, s in scene.sliders.items()}
    gas = Load("gas", "block C", "C", Constant(1000.0), direction_rad=np.pi)
    scene = replace(scene, links=links, sliders=sliders, loads={"gas": gas})
    phi = np.radians(np.linspace(10.0, 350.0, 18))
    found = kinetostatics.forces(scene, solve_driven(scene, phi, np.array(1e-3), np.array(0.0)))
    r, length = scene.links["crank"].points["B"][0], scene.links["rod"].points["C"][0]
    psi = np.arcsin(r * np.sin(phi) / length)
    torque = -1000.0 * r * np.sin(phi + psi) / np.cos(psi)
    np.testing.assert_allclose(found.torque, torque, atol=1e-9)
    np.testing.assert_allclose(
        np.abs(found.sliders["C"].normal), 1000.0 * np.abs(np.tan(psi)), atol=1e-9
    )
    np.testing.assert_allclose(found.sliders["C"].moment, 0.0, atol=1e-9)


@pytest.mark.parametrize("name", ["shaper", "scotch-yoke", "sixbar-watt"])
def test_turned_and_moved_mechanisms_have_turned_forces(name: str) -> None:
    scene = loaded(load_scene(name), random.Random(2))
    loads = {n: one for n, one in scene.loads.items() if one.over != "angle"}
    scene = replace(scene, loads=loads)
    time_s = turn(scene)
    here = kinetostatics.forces(scene, time_s)
    there = kinetostatics.forces(moved(rotated(scene, 0.7), (3.0, -2.0)), time_s)
    c, s = np.cos(0.7), np.sin(0.7)
    turned = {
        p: {b: f @ np.array([[c, s], [-s, c]]) for b, f in held.items()}
        for p, held in here.pins.items()
    }
    assert apart(replace(here, pins=turned), there) < 1e-12


def test_a_scene_without_mass_and_load_is_refused() -> None:
    scene = load_scene("fourbar-lecture-1")
    links = {n: replace(k, mass_kg=0.0, inertia_kg_m2=0.0) for n, k in scene.links.items()}
    light = replace(scene, links=links)
    with pytest.raises(CrankcheckError, match="no link or slider has a mass and nothing loads"):
        kinetostatics.forces(light, [0.0])
    push = Load("push", "rocker", "C", Constant(1.0))
    assert kinetostatics.forces(replace(light, loads={"push": push}), [0.0]).torque[0] != 0.0


@pytest.mark.parametrize(
    ("load", "words"),
    [
        (Load("x", "door", "C", Constant(1.0)), r"loads.x.body: found door; use one of crank, rod"),
        (Load("x", "rod", "Q", Constant(1.0)), r"loads.x.point: found Q; use one of B, C"),
        (
            Load("x", "rod", "C", Constant(1.0), slider="Z", stroke="forward"),
            r"loads.x.slider: found Z; use one of C",
        ),
        (
            Load("x", "rod", "C", Polynomial((1.0,)), "displacement"),
            r"loads.x.slider: found none; use one of C",
        ),
        (
            Load("x", "rod", "C", Tabulated((0.0, 0.1), (1.0, 2.0)), "time"),
            r"loads.x: over the time \[s\] the table goes from 0 to 0.1, and 0.2 is asked for",
        ),
    ],
)
def test_a_load_that_is_not_there_is_refused(load: Load, words: str) -> None:
    scene = replace(load_scene("slider-crank-central"), loads={"x": load})
    with pytest.raises(CrankcheckError, match=words):
        kinetostatics.forces(scene, [0.1, 0.2])


def test_a_cutting_force_acts_on_the_working_stroke_alone() -> None:
    scene = load_scene("shaper")
    cut = Load("cut", "block F", "F", Constant(500.0), "time", "F", "forward", np.pi)
    time_s = turn(scene)
    idle = kinetostatics.forces(scene, time_s, bound=False)
    cutting = kinetostatics.forces(replace(scene, loads={"cut": cut}), time_s, bound=False)
    works = solve(scene, time_s, bound=False).sliders["F"].speed > 0.0
    more = cutting.torque - idle.torque
    assert np.all(np.abs(more[works]) > 0.0)
    assert np.all(more[~works] == 0.0)
    assert 0.3 < np.mean(works) < 0.8


def test_where_a_stroke_turns_the_bound_holds_the_whole_force() -> None:
    """Rounding may have the speed on either side of 0."""
    scene = load_scene("slider-crank-central")
    cut = Load("cut", "block C", "C", Constant(500.0), "time", "C", "forward")
    scene = replace(
        scene, loads={"cut": cut}, sliders={"C": replace(scene.sliders["C"], mass_kg=1.0)}
    )
    still = solve_driven(scene, np.array([np.pi, 1.0]), np.array(1.0), np.array(0.0))
    found = kinetostatics.forces(scene, still)
    assert found.bound.pins["C"]["block C"][0] >= 500.0
    assert found.bound.pins["C"]["block C"][1] < 1e-9


def test_vectors_of_no_length_cost_nothing() -> None:
    scene = load_scene("slider-crank-central")
    chunk = next(iter(kinetostatics.chunks(scene, np.zeros(3), bound=True)))[1]
    body = kinetostatics.free_bodies(scene, chunk)["rod"]
    assert body.vector((0.1, 0.2), (0.1, 0.2)).v.x == 0.0
    assert isinstance(body.vector((0.0, 0.0), (0.1, 0.2)).v, Vec)
