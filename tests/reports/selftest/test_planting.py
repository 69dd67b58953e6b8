"""A plant breaks what it says, where it says, and a size of 0 changes no bit: in driven runs, in
what is let go, and in elastic links and beams. What need not be seen is not.

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
from reports.judge.cell import CellRunner, examined
from reports.selftest import elastic_faults
from reports.selftest.elastic_changes import (
    BEAM_RUNS,
    BENT,
    elastic_cell,
    truth_of_chain,
    truth_of_given,
)
from reports.selftest.fault import FOURBAR, SLIDER, Plant, in_engine
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
from reports.selftest.free_faults import FREE_RUNS, PRESS, PULSE, SQUEEZER, SWING
from reports.selftest.log_faults import WHEN, moved, output, rows
from reports.selftest.trial import FAULTS, RUNS, _passed, chosen_faults
from reports.selftest.unseen import UNSEEN_ELASTIC, UNSEEN_FREE
from sim.engine import Run
from sim.registry import engine
from sim.run import run
from sim.run.spoil import Post, rounded, spoilt

STEPS = 360
BOTH = pytest.mark.parametrize("engine_name", ["mujoco", "pymunk"])


def start(scene_name: str, engine_name: str) -> tuple[Any, ...]:
    scene = load_scene(scene_name)
    return scene, solve(scene, np.zeros(1)).state(), engine_name, "tuned"


def planted(plant: Plant, engine_name: str, size: float = 1.0, scene_name: str = FOURBAR) -> Run:
    dt_s = load_scene(scene_name).driver.law.period_s / STEPS
    return plant(size)(*start(scene_name, engine_name), dt_s=dt_s, steps=STEPS, every=1)


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
@pytest.mark.parametrize("scene_name", [FOURBAR, SLIDER])
def test_a_session_cut_into_stretches_has_the_same_bits(scene_name: str, engine_name: str) -> None:
    whole = planted(nothing, engine_name, scene_name=scene_name)
    idle = in_engine(lambda steps: range(0, steps, 50), lambda *_: None)
    cut = planted(idle, engine_name, 0.0, scene_name)
    assert np.array_equal(moved(cut).time_s, moved(whole).time_s)
    assert np.array_equal(angles(cut), angles(whole))
    assert cut.status == "ok"


@BOTH
def test_a_session_is_spoilt_once_at_each_step_whether_it_logs_or_not(engine_name: str) -> None:
    heard: list[int] = []
    adapter = engine(engine_name)
    broken = spoilt(adapter, (0, 5, 7), lambda _t, _s, _o, done: heard.append(done))
    settings = {name: one.value for name, one in adapter.profiles["tuned"].settings.items()}
    session = broken.open(*start(FOURBAR, engine_name)[:2], settings, 1e-3, "prescribed")
    session.step(6)
    session.record(4, 2)
    assert heard == [0, 5, 8]  # samples are logged at 6, 8 and 10


@BOTH
def test_a_dropped_joint_holds_until_it_is_dropped(engine_name: str) -> None:
    gap = ran("joint-dropped", engine_name, 0.1).gaps["C"] / 0.25
    assert gap[: STEPS - 35].max() < 2e-4
    assert gap[-1] > 0.02


@BOTH
def test_joints_soften_with_time(engine_name: str) -> None:
    healthy, soft = (ran("joint-softens", engine_name, size).gaps["C"] for size in (0.0, 0.98))
    assert np.array_equal(soft[:5], healthy[:5])
    assert soft[-60:].max() > 3.0 * soft[40:100].max()


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


@BOTH
def test_a_post_aside_touches_nothing(engine_name: str) -> None:
    aside = Post((10.0, 10.0), 0.01)
    plant = in_engine(
        lambda _: (0,),
        lambda tools, session, opening, *_: tools.block(session, opening, "rocker", aside),
    )
    blocked, free = (angles(planted(each, engine_name)) for each in (plant, nothing))
    assert np.array_equal(blocked, free)


def test_revolutions_a_minute_are_ten_radians_a_second_of_95() -> None:
    scene = load_scene(FOURBAR)
    right, wrong = (output(scene, ran("rpm", "pymunk", size)) for size in (0.0, 1.0))
    assert np.allclose(wrong.omega, right.omega * 60.0 / math.tau)


def test_one_iteration_is_what_the_engine_holds() -> None:
    assert ran("solver-stops-early", "pymunk", 1.0).settings["iterations"] == 1
    mujoco = ran("solver-stops-early", "mujoco", 1.0).settings
    assert (mujoco["solver"], mujoco["iterations"]) == ("PGS", 1)


def test_rounding_to_24_bits_is_float32() -> None:
    values = np.random.default_rng(7).standard_normal(1000) * 10.0 ** np.arange(-5, 5).repeat(100)
    assert np.array_equal(rounded(values, 2.0**-24), values.astype(np.float32).astype(np.float64))
    assert rounded(values, 0.0) is values


def test_one_sided_accelerations_are_half_a_step_late() -> None:
    scene, done = load_scene(FOURBAR), ran("acceleration-late", "mujoco", 0.5)
    early = np.clip(moved(done).time_s - done.dt_s / 2, 0.0, None)
    reference = solve(scene, early).links["rocker"].alpha
    assert np.abs(output(scene, done).alpha - reference)[1:].max() < 2e-4 * 100.0


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
    none = let_go(FAULTS[name].plant, engine_name, 0.0)
    assert none.status == "ok"
    assert np.array_equal(joules(none), joules(let_go(nothing, engine_name)))


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
    done = let_go(nothing, "mujoco"), let_go(FAULTS["other-assembly"].plant, "mujoco")
    (crank, right), (mirrored, wrong) = (
        [moved(each).links[name].theta for name in ("crank", "rocker")] for each in done
    )
    assert np.array_equal(crank, mirrored)
    assert np.max(np.abs(right - wrong)) > 1.0


@BOTH
def test_masses_with_one_factor_move_alike_under_weight_alone(engine_name: str) -> None:
    once, twice = (
        moved(let_go(plant, engine_name)).links["rocker"].theta
        for plant in (nothing, UNSEEN_FREE[0].plant)
    )
    assert np.abs(once - twice).max() < 1e-8


def test_a_free_run_without_its_energy_is_not_whole() -> None:
    cell = RUNS["free"].cell(load_scene(SWING), "mujoco", 360, False)
    failed = examined(cell, FAULTS["energy-missing"].plant(1.0))[0].failures
    assert [(one.rule, one.text) for one in failed] == [("CC109", "missing from the log: energy")]


ENGINE, BEAM_ENGINE = "mujoco", "exudyn"
ELASTIC = {fault.name for fault in chosen_faults((), (ENGINE,), "elastic")}
BEAMS = [
    fault.name for fault in chosen_faults((), (BEAM_ENGINE,), "elastic") if fault.kind == "beam"
]
CELL = elastic_cell(BENT, ENGINE)
GIVEN = truth_of_chain(CELL.scene).given


def test_every_option_has_faults_and_runs_of_its_own() -> None:
    assert len(ELASTIC) >= 20
    assert not ELASTIC & {fault.name for fault in chosen_faults((), (ENGINE,))}
    beams = elastic_cell(BENT, BEAM_ENGINE, runs=BEAM_RUNS)
    assert beams.springs == "beam"
    assert truth_of_given(beams.given).given.beams
    assert len(BEAMS) >= 9
    for engine_name in ("mujoco", "pymunk"):
        assert not any(FAULTS[name].possible(engine_name) for name in BEAMS)


@pytest.mark.parametrize("unseen", UNSEEN_ELASTIC, ids=lambda each: each.name)
def test_what_need_not_be_seen_of_elastic_links_is_not(unseen: object) -> None:
    passed = _passed(unseen, CELL.scene, (ENGINE,), 360, "elastic")  # type: ignore[arg-type]
    assert passed.failed == {ENGINE: ()}
    assert not passed.nothing


def test_the_exact_chain_handed_back_is_too_good_for_an_engine() -> None:
    """Its deflection is that of the chain to rounding, its places are off by the segments."""
    checked, _ = examined(CELL, FAULTS["chain-given"].plant(1.0))
    assert [finding.rule for finding in checked.failures] == ["CC111"]
    assert "segments is off by" in checked.failures[0].text


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
