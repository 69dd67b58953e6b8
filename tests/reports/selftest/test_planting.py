"""A plant breaks what it says, where it says, and a size of 0 changes no bit: in driven runs, in
what is let go, and in elastic links and beams. What need not be seen is not.

That each fault is caught by its rule and its size of 0 is not, `test_faults.py` says of all kinds.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.scene import Link, Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.joints import line_ends, mass_of
from models.scene.loads import PinSpring
from reports.compare.free_truth import free_truth
from reports.judge.cell import CellRunner
from reports.selftest import elastic_faults
from reports.selftest.elastic_changes import (
    BENT,
    LOOSE,
    elastic_cell,
    truth_of_chain,
)
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
from reports.selftest.log_faults import WHEN, moved, output, rows
from reports.selftest.trial import FAULTS, _passed
from reports.selftest.unseen import UNSEEN_ELASTIC
from sim.engine import Run
from sim.registry import engine
from sim.run import run
from sim.run.spoil import rounded, spoilt

STEPS = 360
BOTH = pytest.mark.parametrize("engine_name", ["mujoco", "pymunk"])


def start() -> tuple[Any, ...]:
    scene = load_scene(FOURBAR)
    return scene, solve(scene, np.zeros(1)).state()


def planted(plant: Plant, engine_name: str, size: float = 1.0) -> Run:
    dt_s = load_scene(FOURBAR).driver.law.period_s / STEPS
    return plant(size)(*start(), engine_name, "tuned", dt_s=dt_s, steps=STEPS, every=1)


@cache
def ran(name: str, engine_name: str, size: float) -> Run:
    return planted(FAULTS[name].plant, engine_name, size)


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
def test_a_dropped_joint_holds_until_it_is_dropped(engine_name: str) -> None:
    gap = ran("joint-dropped", engine_name, 0.1).gaps["C"] / 0.25
    assert gap[: STEPS - 35].max() < 2e-4
    assert gap[-1] > 0.02


@BOTH
def test_a_link_meets_the_post_in_mid_turn_and_not_before(engine_name: str) -> None:
    clear, met = (ran("body-collides", engine_name, size) for size in (0.0, 0.03))
    free, held = rocker(clear), rocker(met)
    first = int(np.argmax(free > free.max() - 0.031))  # the engine may be off by 1e-4
    assert 60 < first < STEPS
    assert np.array_equal(held[:first], free[:first])
    assert not np.allclose(held[first : first + 20], free[first : first + 20], atol=1e-5)
    opened, shut = (max(gap.max() for gap in done.gaps.values()) for done in (met, clear))
    assert opened > 5.0 * shut


def test_revolutions_a_minute_are_ten_radians_a_second_of_95() -> None:
    scene = load_scene(FOURBAR)
    right, wrong = (output(scene, ran("rpm", "pymunk", size)) for size in (0.0, 1.0))
    assert np.allclose(wrong.omega, right.omega * 60.0 / math.tau)


def test_rounding_to_24_bits_is_float32() -> None:
    values = np.random.default_rng(7).standard_normal(1000) * 10.0 ** np.arange(-5, 5).repeat(100)
    assert np.array_equal(rounded(values, 2.0**-24), values.astype(np.float32).astype(np.float64))
    assert rounded(values, 0.0) is values


def test_the_clock_that_is_late_shows_the_next_sample() -> None:
    sound, late = (ran("clock-late", "pymunk", size) for size in (0.0, 1.0))
    assert np.array_equal(angles(late)[:, :-1], angles(sound)[:, 1:])
    assert np.array_equal(moved(late).time_s, moved(sound).time_s)


def test_the_other_assembly_comes_from_a_run_of_it() -> None:
    one, both = (ran("branch-midway", "mujoco", size) for size in (0.0, 1.0))
    half = STEPS // 2
    assert np.array_equal(angles(both)[:, :half], angles(one)[:, :half])
    assert np.abs(angles(both)[1:, half + 1 :] - angles(one)[1:, half + 1 :]).min() > 0.1
    assert max(gap.max() for gap in both.gaps.values()) < 1e-5


def test_rows_keep_values_and_stamps_apart() -> None:
    done, stale = (ran("row-stale", "mujoco", size) for size in (0.0, 1.0))
    some = rows(done, slice(1, 4), slice(0, 3))
    assert np.array_equal(moved(some).time_s, moved(done).time_s[:3])
    assert np.array_equal(rocker(some), angles(done)[-1, 1:4])
    assert angles(stale)[0, WHEN] == angles(done)[0, WHEN - 1]


def test_a_fault_in_the_log_leaves_the_rest_of_it_alone() -> None:
    scene = load_scene(FOURBAR)
    right, wrong = (output(scene, ran("spike", "pymunk", size)) for size in (0.0, 1e-5))
    assert np.flatnonzero(wrong.theta != right.theta).tolist() == [WHEN]
    assert np.array_equal(wrong.omega, right.omega)


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


def loss(name: str, engine_name: str, size: float) -> float:
    before, after = let_go(nothing, engine_name), let_go(FAULTS[name].plant, engine_name, size)
    return float(joules(before)[-1] - joules(after)[-1])


@BOTH
@pytest.mark.parametrize("name", INSIDE)
def test_inside_an_engine_a_size_of_0_changes_no_bit(name: str, engine_name: str) -> None:
    none, sound = let_go(FAULTS[name].plant, engine_name, 0.0), let_go(nothing, engine_name)
    assert np.array_equal(joules(none), joules(sound))


@BOTH
@pytest.mark.parametrize(
    ("name", "size", "sign"),
    [
        *(("damping-left-on", 0.1, -1), ("explicit-euler", 1.0, 1), ("energy-fed", 1e-3, 1)),
        ("loose-damped", 0.1, -1),  # of elastic links, whose runs are slow: the same inside
    ],
)
def test_energy_is_taken_or_fed(name: str, size: float, sign: int, engine_name: str) -> None:
    full = loss(name, engine_name, size)
    assert -sign * full > 1e-4
    assert loss(name, engine_name, 0.5 * size) == pytest.approx(0.5 * full, rel=0.2)
    if name == "damping-left-on":
        # A quarter of a second at 0.1 1/s: some hundredths of the energy that moves.
        moving = let_go(nothing, engine_name).energy.kinetic_j.max()
        assert 0.003 < full / moving < 0.3


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


def test_loads_act_elsewhere_later_and_along_lines_or_stay_as_at_the_start() -> None:
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


def test_a_spring_pulls_beside_its_point_which_stays_where_it_is() -> None:
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


def test_a_rod_has_a_third_of_the_inertia_of_its_mass_in_two_ends() -> None:
    part = elastic_faults.segments(elastic_faults.at_its_ends)(GIVEN, 1.0).links["coupler-1"]
    length = 0.75 / 4.0
    assert part.inertia_kg_m2 == pytest.approx(part.mass_kg * length**2 / 4.0)


def test_a_moved_node_starts_with_its_segments_together() -> None:
    names = GIVEN, truth_of_chain(CELL.scene).start, ENGINE, "tuned"
    options = {"dt_s": CELL.dt_s, "steps": 8, "every": 1}
    plant = FAULTS["node-moved"].plant
    done = plant(0.1)(*names, **options)
    assert max(float(gap[0]) for gap in done.gaps.values()) < 1e-12
    none, right = (
        moved(runner(*names, **options)).links["coupler-1"].theta for runner in (plant(0.0), run)
    )
    assert np.array_equal(none, right)


CHAIN = elastic_cell(LOOSE, ENGINE).given
STEP_S = 0.4 / 1440
Given = Callable[[str, Scene], tuple[Any, Any]]


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> Given:
    """The scene and the start that an engine is given with a fault of its own size; one of 0
    gives it the right scene."""

    def find(name: str, scene: Scene) -> tuple[Any, Any]:
        asked: list[tuple[object, ...]] = []
        for module in ("fault", "elastic_changes", "elastic_faults"):
            monkeypatch.setattr(
                f"reports.selftest.{module}.run", lambda *given, **_: asked.append(given)
            )
        for size in (FAULTS[name].planted, 0.0):
            FAULTS[name].plant(size)(scene, "the start", ENGINE, "tuned", dt_s=STEP_S)
        (wrong, start, *names), (right, *_) = asked
        assert right == scene
        assert names == [ENGINE, "tuned"]
        return wrong, start

    return find


def heavier(link: Link) -> Link:
    return replace(link, mass_kg=1.01 * link.mass_kg, inertia_kg_m2=1.01 * link.inertia_kg_m2)


@pytest.mark.parametrize(
    ("name", "times", "late_s"),
    [("loose-torque-late", 1.0, STEP_S), ("loose-torque-back", -1.0, 0)],
)
def test_a_torque_of_links_that_are_let_go_is_late_or_turns_the_other_way(
    name: str, times: float, late_s: float, given: Given
) -> None:
    wrong, start = given(name, CHAIN)
    time_s = np.linspace(0.0, 1.5, 98)
    right = CHAIN.loads["pulse"].magnitude(time_s)
    assert wrong.loads["pulse"].magnitude(time_s + late_s) == pytest.approx(times * right)
    assert (replace(wrong, loads=CHAIN.loads), start) == (CHAIN, "the start")


def test_links_that_are_let_go_have_other_springs_or_masses_and_the_same_start(
    given: Given,
) -> None:
    springs, rocker = CHAIN.springs, list(CHAIN.links)[-1]
    heavy = CHAIN.links | {rocker: heavier(CHAIN.links[rocker])}
    stiff = {n: replace(s, rate=1.01 * s.rate) for n, s in springs.items()}
    damped = {n: replace(s, damping=1e-3 * s.rate) for n, s in springs.items()}
    assert given("loose-modulus-off", CHAIN) == (replace(CHAIN, springs=stiff), "the start")
    assert given("loose-damping", CHAIN) == (replace(CHAIN, springs=damped), "the start")
    assert given("loose-rocker-heavy", CHAIN) == (replace(CHAIN, links=heavy), "the start")


def test_another_elastic_machine_starts_on_its_own_periodic_motion(
    given: Given, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(elastic_faults, "segment_start", lambda *asked: asked)
    wrong, (chain, shape) = given("elastic-other", CELL.given)
    ((name, own),) = CELL.scene.elastic.items()
    soft = {name: replace(own, flexural_n_m2=own.flexural_n_m2 / 1.01)}
    links = {**CELL.scene.links, name: heavier(CELL.scene.links[name])}
    other = SegmentedScene(replace(CELL.scene, links=links, elastic=soft), 4)
    assert (chain.scene, chain.count, shape) == (other.scene, 4, "periodic")
    assert wrong == other.rigid
