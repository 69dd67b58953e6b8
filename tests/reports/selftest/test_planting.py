"""A plant breaks what it says, where it says, and a size of 0 changes no bit: in driven runs, in
what is in free motion, and in elastic links and beams. What need not be seen is not.

That each fault is caught by its rule and its size of 0 is not, `test_faults.py` says of all kinds.
"""

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.scene.joints import line_ends, mass_of
from models.scene.loads import PinSpring
from reports.compare.free_truth import free_truth
from reports.judge.cell import CellRunner
from reports.selftest import elastic_faults
from reports.selftest.elastic_changes import BENT, elastic_cell, truth_of_chain
from reports.selftest.fault import FOURBAR, Plant, in_engine
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
)
from reports.selftest.free_faults import FREE_RUNS, PRESS, PULSE, SQUEEZER, SWING
from reports.selftest.log_faults import moved, output
from reports.selftest.trial import FAULTS, _passed
from reports.selftest.unseen import UNSEEN_ELASTIC
from sim.engine import Run
from sim.registry import engine
from sim.run import run
from sim.run.spoil import rounded, spoilt
from tests.worlds.tiers import few

STEPS = 360
BOTH = pytest.mark.parametrize("engine_name", ["mujoco", "pymunk"])


def start() -> tuple[Any, ...]:
    scene = load_scene(FOURBAR)
    return scene, solve(scene, np.zeros(1)).state()


@cache
def planted(plant: Plant, engine_name: str, size: float = 1.0) -> Run:
    dt_s = load_scene(FOURBAR).driver.law.period_s / STEPS
    return plant(size)(*start(), engine_name, "tuned", dt_s=dt_s, steps=STEPS, every=1)


def nothing(_: float) -> CellRunner:
    return run


def angles(done: Run) -> Array:
    return np.stack([link.theta for link in moved(done).links.values()])


def rocker(done: Run) -> Array:
    return output(load_scene(FOURBAR), done).theta


@BOTH
def test_a_session_cut_into_stretches_has_the_same_bits(engine_name: str) -> None:
    whole = planted(nothing, engine_name)
    cut = planted(in_engine(lambda steps: range(0, steps, 50), lambda *_: None), engine_name, 0.0)
    assert np.array_equal(moved(cut).time_s, moved(whole).time_s)
    assert np.array_equal(angles(cut), angles(whole))


@BOTH
def test_a_session_is_spoilt_once_at_each_step_whether_it_logs_or_not(engine_name: str) -> None:
    heard: list[int] = []
    adapter = engine(engine_name)
    broken = spoilt(adapter, (0, 5, 7), lambda _t, _s, _o, done: heard.append(done))
    settings = {name: one.value for name, one in adapter.profiles["tuned"].settings.items()}
    session = broken.open(*start(), settings, 1e-3, "prescribed")
    session.step(6)
    session.record(4, 2)
    assert heard == [0, 5, 8]  # samples are logged at 6, 8 and 10


@BOTH
def test_a_link_meets_the_post_in_mid_turn_and_not_before(engine_name: str) -> None:
    clear, met = (planted(FAULTS["body-collides"].plant, engine_name, size) for size in (0.0, 0.03))
    free, held = rocker(clear), rocker(met)
    first = int(np.argmax(free > free.max() - 0.031))  # the engine may be off by 1e-4
    assert 60 < first < STEPS
    assert np.array_equal(held[:first], free[:first])
    assert not np.allclose(held[first : first + 20], free[first : first + 20], atol=1e-5)
    opened, shut = (max(gap.max() for gap in done.gaps.values()) for done in (met, clear))
    assert opened > 5.0 * shut


def test_revolutions_a_minute_are_ten_radians_a_second_of_95_and_24_bits_float32() -> None:
    scene = load_scene(FOURBAR)
    plant = FAULTS["rpm"].plant
    right, wrong = (output(scene, planted(plant, "pymunk", size)) for size in (0.0, 1.0))
    assert np.allclose(wrong.omega, right.omega * 60.0 / math.tau)
    values = np.random.default_rng(7).standard_normal(1000) * 10.0 ** np.arange(-5, 5).repeat(100)
    assert np.array_equal(rounded(values, 2.0**-24), values.astype(np.float32).astype(np.float64))
    assert rounded(values, 0.0) is values


INSIDE = [
    name
    for name, fault in FAULTS.items()
    if fault.group == "stepping" and fault.possible("mujoco") and fault.possible("pymunk")
]
THIRD = 200
"""A third of the steps of the runs that are let go."""


@cache
def let_go(plant: Plant, engine_name: str, size: float = 1.0) -> Run:
    scene, (dt_s, _) = load_scene(SWING), FREE_RUNS[SWING]
    begun = free_truth(scene, 3 * THIRD, dt_s).start
    options = {"dt_s": dt_s, "steps": 3 * THIRD, "every": 1, "drive": "free"}
    return plant(size)(scene, begun, engine_name, "tuned", **options)


def joules(done: Run) -> Array:
    return np.asarray(done.energy.total_j)


@BOTH
@pytest.mark.parametrize("name", few(INSIDE, [*INSIDE][::3], "another fault of size 0"))
def test_inside_an_engine_a_size_of_0_changes_no_bit(name: str, engine_name: str) -> None:
    none, sound = let_go(FAULTS[name].plant, engine_name, 0.0), let_go(nothing, engine_name)
    assert np.array_equal(joules(none), joules(sound))


@BOTH
@pytest.mark.parametrize(
    ("name", "size", "sign"),
    [("damping-left-on", 0.1, -1), ("explicit-euler", 1.0, 1), ("energy-fed", 1e-3, 1)],
)
def test_energy_is_taken_or_fed(name: str, size: float, sign: int, engine_name: str) -> None:
    runs = (let_go(FAULTS[name].plant, engine_name, each) for each in (0.0, 0.5 * size, size))
    none, half, full = (float(joules(done)[-1]) for done in runs)
    assert sign * (full - none) > 1e-4
    assert half - none == pytest.approx(0.5 * (full - none), rel=0.2)


@BOTH
@pytest.mark.parametrize("name", ["mass-later", "gravity-later"])
def test_what_comes_later_changes_nothing_before(name: str, engine_name: str) -> None:
    scene = load_scene(SWING)
    runs = let_go(nothing, engine_name), let_go(FAULTS[name].plant, engine_name)
    theta, other = (output(scene, done).theta for done in runs)
    assert np.array_equal(theta[: THIRD + 1], other[: THIRD + 1])
    assert np.abs(theta - other)[-1] > 1e-3


def test_the_inertia_about_a_pin_is_that_of_a_rod_about_its_end() -> None:
    scene = load_scene(SWING)
    rod = scene.links["coupler"]
    assert about_pin(rod, 1.0).inertia_kg_m2 == pytest.approx(rod.mass_kg * 0.25**2 / 3.0)
    assert about_pin(rod, 0.0) == rod
    assert off_centre(rod, 0.1).centre_m == pytest.approx((0.6 * 0.25, 0.0))
    other = of_coupler(about_pin)(scene, 1.0)  # another scene, and the rest the same
    assert mass_of(other, "coupler") != mass_of(scene, "coupler")
    assert mass_of(other, "rocker") == mass_of(scene, "rocker")


def test_loads_and_a_spring_act_elsewhere_later_along_lines_or_as_at_the_start() -> None:
    pulse, press = load_scene(PULSE), load_scene(PRESS)
    for change in (on_last_link, lasting(0.1)):
        assert of_load("pulse", change)(pulse, 0.0) == pulse
    assert of_load("pulse", on_last_link)(pulse, 1.0).loads["pulse"].body == "rocker"
    longer = of_load("pulse", lasting(0.1))(pulse, 2.0).loads["pulse"].characteristic
    assert list(longer.kinks) == pytest.approx([0.0, 1.2])
    motor = of_load("motor", held_at_start)(press, 1.0).loads["motor"]
    assert motor.magnitude(np.array([0.0, 1.0])) == pytest.approx([480.0, 480.0])
    cornered = of_load("work", along_lines)(press, 1.0).loads["work"]
    assert cornered.magnitude(np.array([0.46])) == pytest.approx([1e4])
    between = np.array([0.4])
    assert cornered.magnitude(between) == press.loads["work"].magnitude(between)
    scene = load_scene(SQUEEZER)
    other = spring_elsewhere(scene, 1e-2)
    (name, place), _ = line_ends(other, other.springs["return"])
    assert (name, place) == ("lever", pytest.approx((0.21, 0.18)))
    assert other.links["lever"].points["S"] == scene.links["lever"].points["S"]


ENGINE = "mujoco"
CELL = elastic_cell(BENT, ENGINE)
GIVEN = truth_of_chain(CELL.scene).given


@pytest.mark.parametrize("unseen", UNSEEN_ELASTIC, ids=lambda each: each.name)
def test_what_need_not_be_seen_of_elastic_links_is_not(unseen: object) -> None:
    passed = _passed(unseen, CELL.scene, (ENGINE,), 360, "elastic")  # type: ignore[arg-type]
    assert passed.failed == {ENGINE: ()}
    assert not passed.nothing


def test_the_springs_are_those_that_are_meant() -> None:
    first = next(iter(GIVEN.springs))

    def rate(changed: object) -> float:
        spring = elastic_faults.springs(changed)(GIVEN, 1.0).springs[first]  # type: ignore[arg-type]
        assert isinstance(spring, PinSpring)
        return spring.rate / GIVEN.springs[first].rate  # type: ignore[union-attr]

    assert rate(elastic_faults.of_as_many_springs) == pytest.approx(3.0 / 4.0)
    assert rate(elastic_faults.as_corrected) == pytest.approx(1.0 + math.pi**2 / 192.0)
