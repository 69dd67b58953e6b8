"""What is planted in free motion does what it says, and with a size of 0 changes no bit."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from models.files import load_scene
from models.poses import mass_of
from models.spring_ends import line_ends
from reports.compare.free.free_truth import free_truth
from reports.selftest.all_faults import FAULTS
from reports.selftest.free_changes import (
    about_pin,
    along_lines,
    held_at_start,
    lasting,
    of_coupler,
    of_load,
    off_centre,
    on_last_link,
    spring_elsewhere,
    turned_gravity,
)
from reports.selftest.free_runs import FREE_RUNS, PRESS, PULSE, SQUEEZER, SWING
from reports.selftest.logs import moved, output
from reports.selftest.trial import _cell, examined
from reports.selftest.unseen_free import UNSEEN_FREE
from sim.engine import Run
from sim.run import run

ENGINES = ("mujoco", "pymunk")
INSIDE = [
    name
    for name, fault in FAULTS.items()
    if fault.group == "stepping" and fault.possible("mujoco") and fault.possible("pymunk")
]
THIRD = 200
"""A third of the steps of these runs."""


def given(engine: str, scene: str = SWING) -> tuple[tuple[Any, ...], dict[str, Any]]:
    mechanism = load_scene(scene)
    dt_s, _ = FREE_RUNS[scene]
    options = {"dt_s": dt_s, "steps": 3 * THIRD, "every": 1, "drive": "free"}
    start = free_truth(mechanism, 3 * THIRD, dt_s).start
    return (mechanism, start, engine, "tuned"), options


@cache
def sound(engine: str) -> Run:
    names, options = given(engine)
    return run(*names, **options)


def planted(name: str, engine: str, size: float) -> Run:
    names, options = given(engine)
    return FAULTS[name].plant(size)(*names, **options)


def joules(done: Run) -> np.ndarray[Any, Any]:
    return np.asarray(done.energy.total_j)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", INSIDE)
def test_inside_an_engine_a_size_of_0_changes_no_bit(name: str, engine: str) -> None:
    none = planted(name, engine, 0.0)
    assert none.status == "ok"
    assert np.array_equal(joules(none), joules(sound(engine)))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("name", "size", "sign"),
    [
        *(("damping-left-on", 0.1, -1), ("explicit-euler", 1.0, 1), ("energy-fed", 1e-3, 1)),
        ("loose-damped", 0.1, -1),  # of elastic links, whose runs are slow: the same inside
    ],
)
def test_energy_is_taken_or_fed(name: str, size: float, sign: int, engine: str) -> None:
    before, after = joules(sound(engine)), joules(planted(name, engine, size))
    assert sign * (after - before)[-1] > 1e-4
    half = joules(planted(name, engine, 0.5 * size))
    assert (half - before)[-1] == pytest.approx(0.5 * (after - before)[-1], rel=0.2)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["mass-later", "gravity-later"])
def test_what_comes_later_changes_nothing_before(name: str, engine: str) -> None:
    healthy, later = sound(engine), planted(name, engine, 1.0)
    scene = load_scene(SWING)
    theta, other = output(scene, healthy).theta, output(scene, later).theta
    assert np.array_equal(theta[: THIRD + 1], other[: THIRD + 1])
    assert np.abs(theta - other)[-1] > 1e-3


@pytest.mark.parametrize("engine", ENGINES)
def test_damping_takes_about_its_share_of_the_speed(engine: str) -> None:
    """A quarter of a second at 0.1 1/s: some hundredths of the energy that moves."""
    lost = joules(sound(engine))[-1] - joules(planted("damping-left-on", engine, 0.1))[-1]
    done = sound(engine)
    assert 0.003 < lost / done.energy.kinetic_j.max() < 0.3


def test_the_inertia_about_a_pin_is_that_of_a_rod_about_its_end() -> None:
    rod = load_scene(SWING).links["coupler"]
    assert about_pin(rod, 1.0).inertia_kg_m2 == pytest.approx(rod.mass_kg * 0.25**2 / 3.0)
    assert about_pin(rod, 0.0) == rod
    assert off_centre(rod, 0.1).centre_m == pytest.approx((0.6 * 0.25, 0.0))


def test_gravity_is_turned_and_as_strong() -> None:
    x, y = turned_gravity(load_scene(SWING), 0.01).gravity_m_s2
    assert np.hypot(x, y) == pytest.approx(9.81)
    assert x == pytest.approx(9.81 * np.sin(0.01))


def test_loads_act_elsewhere_or_stay_as_at_the_start() -> None:
    pulse = load_scene(PULSE)
    assert of_load("pulse", on_last_link)(pulse, 1.0).loads["pulse"].body == "rocker"
    assert of_load("pulse", on_last_link)(pulse, 0.0) == pulse
    motor = of_load("motor", held_at_start)(load_scene(PRESS), 1.0).loads["motor"]
    assert motor.magnitude(np.array([0.0, 1.0])) == pytest.approx([480.0, 480.0])


def test_a_pulse_ends_later_and_a_table_has_corners() -> None:
    pulse = load_scene(PULSE)
    longer = of_load("pulse", lasting(0.1))(pulse, 2.0).loads["pulse"].characteristic
    assert list(longer.kinks) == pytest.approx([0.0, 1.2])
    assert of_load("pulse", lasting(0.1))(pulse, 0.0) == pulse
    press = load_scene(PRESS)
    between = np.array([0.4])
    cornered = of_load("work", along_lines)(press, 1.0).loads["work"]
    assert cornered.magnitude(np.array([0.46])) == pytest.approx([1e4])
    assert cornered.magnitude(between) == press.loads["work"].magnitude(between)


def test_a_spring_pulls_beside_its_point_which_stays_where_it_is() -> None:
    scene = load_scene(SQUEEZER)
    other = spring_elsewhere(scene, 1e-2)
    (name, place), _ = line_ends(other, other.springs["return"])
    assert (name, place) == ("lever", pytest.approx((0.21, 0.18)))
    assert other.links["lever"].points["S"] == scene.links["lever"].points["S"]


def test_the_other_assembly_has_the_driver_where_it_was_logged() -> None:
    done = sound("mujoco")
    names, options = given("mujoco")
    other = FAULTS["other-assembly"].plant(1.0)(*names, **options)
    crank, mirrored = (moved(one).links["crank"].theta for one in (done, other))
    assert np.array_equal(crank, mirrored)
    rocker, turned = (moved(one).links["rocker"].theta for one in (done, other))
    assert np.max(np.abs(rocker - turned)) > 1.0


def test_another_coupler_is_another_scene_and_the_rest_the_same() -> None:
    scene = load_scene(SWING)
    other = of_coupler(about_pin)(scene, 1.0)
    assert mass_of(other, "coupler") != mass_of(scene, "coupler")
    assert mass_of(other, "rocker") == mass_of(scene, "rocker")


@pytest.mark.parametrize("engine", ENGINES)
def test_masses_with_one_factor_move_alike_under_weight_alone(engine: str) -> None:
    names, options = given(engine)
    twice = UNSEEN_FREE[0].plant(1.0)(*names, **options)
    places, other = (moved(done).links["rocker"].theta for done in (sound(engine), twice))
    assert np.abs(places - other).max() < 1e-8


def test_a_free_run_without_its_energy_is_not_whole() -> None:
    cell = _cell(load_scene(SWING), "mujoco", 360, converge=False, kind="free")
    failed = examined(cell, FAULTS["energy-missing"].plant(1.0))[0].failures
    assert [(one.rule, one.text) for one in failed] == [("CC109", "missing from the log: energy")]
