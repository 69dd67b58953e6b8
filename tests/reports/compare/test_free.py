"""Runs of free motion whose errors are known: a phase that lags, a linkage that is open, a truth
that ends, another assembly; drifts; and loads over time that end with the run. And a chain of
windows against its closed form: what is measured, and what is seen."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.kinematics import solve, solve_driven
from benchmarks.window_chain import energy_drift, hold, place_until, speed_error
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene, parse_scene
from models.motion import Motion
from models.scene import Scene
from models.scene.hard import WindowChain
from models.scene.loads import Load
from models.scene.tabulated import Tabulated
from reports.compare.compare import compare
from reports.compare.errors import Errors
from reports.compare.free_facts import drift, kept_about, momentum, window_means, window_s
from reports.compare.free_truth import FreeTruth, free_truth
from reports.compare.hard_runs import ChainErrors, compared
from sim.engine import BodyPose, Poses, Run
from sim.run import run
from tests.worlds.fake.engine import FakeEngine, turned_link
from tests.worlds.tiers import slowly

DT_S, STEPS = 1e-3, 160
SWING = load_scene("fourbar-swing")


@pytest.fixture(scope="module")
def truth() -> FreeTruth:
    return free_truth(SWING, STEPS, DT_S)


@pytest.fixture(scope="module")
def done(truth: FreeTruth) -> Run:
    return run(SWING, truth.start, "pymunk", dt_s=DT_S, steps=STEPS, drive="free")


def found(truth: FreeTruth, of: Run) -> Errors:
    return compare(truth.beside(of))


def moved(of: Run, motion: Motion) -> Run:
    """The run, as if it had logged a motion whose rates belong to the instants of its places."""
    times = motion.time_s
    return replace(of, motion=motion, velocity_time_s=times, acceleration_time_s=times)


def late(truth: FreeTruth, by_s: float) -> Motion:
    times = DT_S * np.arange(STEPS + 1.0)
    return replace(truth.at(times * (1.0 - by_s / times[-1])), time_s=times, bound=None)


def test_a_phase_that_lags_is_told_from_a_linkage_that_is_open(truth: FreeTruth, done: Run) -> None:
    errors = found(truth, moved(done, late(truth, 2e-4)))
    phase, raw = errors.worst("phase"), errors.worst("phase", kind="raw")
    speed = truth.at(np.array([DT_S * STEPS])).links["crank"].omega[0]
    assert raw.maximum == pytest.approx(2e-4 * abs(speed), rel=1e-2)
    assert raw.maximum / errors.of_motion.sensitivity <= phase.maximum <= raw.maximum
    assert errors.worst("geometry").maximum < 1e-12
    assert errors.departure is None
    motion = late(truth, 0.0)
    rocker = motion.links["rocker"]
    bent = replace(rocker, theta=rocker.theta + 1e-5)
    opened = found(truth, moved(done, replace(motion, links={**motion.links, "rocker": bent})))
    geometry = opened.worst("geometry")
    assert (geometry.body, geometry.maximum) == ("rocker", pytest.approx(1e-5, rel=1e-6))
    assert opened.worst("phase", kind="raw").maximum < 1e-14
    # Horizons are the times to which a class holds.
    facts = errors.of_motion
    assert (facts.horizon_s(1.0), facts.horizon_s(0.0)) == (DT_S * STEPS, 0.0)
    held = facts.horizon_s(1e-4)
    assert 0.0 < held < DT_S * STEPS
    assert held < facts.horizon_s(2e-4) <= facts.judged_horizon_s(2e-4)


class _Changed:
    """A free motion of which something else is said."""

    def __init__(self, motion: object, **said: object) -> None:
        self._motion, self._said = motion, said

    def __getattr__(self, name: str) -> object:
        return self._said[name] if name in self._said else getattr(self._motion, name)


def test_errors_at_one_time_are_over_the_growth_of_that_time(truth: FreeTruth, done: Run) -> None:
    steeper = _Changed(truth.free, sensitivity=lambda time_s: 1.0 + 1e3 * time_s)
    growing = replace(truth, free=steeper, known_rad=1.0)
    plain, over = (found(each, moved(done, late(truth, 2e-4))) for each in (truth, growing))
    assert over.of_motion.sensitivity == pytest.approx(1.0 + 1e3 * DT_S * STEPS)
    for name in ("phase", "angle", "position", "velocity"):
        assert over.worst(name).maximum < 0.1 * plain.worst(name).maximum, name
    for name, kind in (("geometry", "total"), ("gap", "total"), ("phase", "raw")):
        assert plain.worst(name, kind=kind) == over.worst(name, kind=kind), name


def test_samples_of_uncertain_truth_are_left_out_and_counted(truth: FreeTruth, done: Run) -> None:
    unsure = _Changed(truth.free, error_rad=lambda time_s: np.where(time_s < 0.1 - 1e-9, 0.0, 1.0))
    errors = found(replace(truth, free=unsure), done)
    assert errors.of_motion.until_s == pytest.approx(0.099)
    assert errors.of_motion.left_out == STEPS + 1 - 100
    assert any("reference ends at t = 0.099 s" in note for note in errors.notes)
    assert all(row.samples <= 100 for row in errors.rows)
    assert errors.incomplete == ""


def test_an_assembly_that_the_truth_is_not_in_is_a_departure(truth: FreeTruth, done: Run) -> None:
    right = late(truth, 0.0)
    theta, still = right.links["crank"].theta, np.zeros(STEPS + 1)
    other = replace(truth.scene, branch={"C": -1})
    wrong = solve_driven(other, theta, still, still, right.time_s, bound=False)
    half = right.each_series(lambda series: series.copy())
    for name, link in half.links.items():
        link.theta[80:] = wrong.links[name].theta[80:]
    errors = found(truth, replace(moved(done, half), gaps=dict.fromkeys(done.gaps, still)))
    assert errors.departure.time_s == pytest.approx(0.079)


def test_a_loss_that_goes_on_is_the_drift_and_an_offset_that_swings_is_none() -> None:
    time_s = np.linspace(0.0, 10.0, 10_001)
    swinging = 1e-3 * np.sin(2.0 * np.pi * time_s) ** 2
    assert abs(drift(swinging, time_s, 1.0)) < 1e-8
    assert drift(swinging - 1e-5 * time_s, time_s, 1.0) == pytest.approx(-9e-5, rel=1e-2)


def test_a_window_is_a_tenth_of_the_run_or_a_swing_of_the_longest_link() -> None:
    swing_s = pytest.approx(2.0 * np.pi * np.sqrt(0.25 / 9.81))
    assert [window_s(SWING, lasts_s) for lasts_s in (100.0, 4.0, 0.5)] == [10.0, swing_s, 0.25]
    assert window_s(replace(SWING, gravity_m_s2=(0.0, 0.0)), 4.0) == 0.4
    # Means over windows begin and end with those of the drift.
    time_s = np.linspace(0.0, 10.0, 1001)
    series = 0.1 * time_s + np.sin(7.0 * time_s)
    means = window_means(SWING, time_s, series)
    known = means[np.isfinite(means)]
    of_drift = drift(series, time_s, window_s(SWING, 10.0))
    assert known[-1] - known[0] == pytest.approx(of_drift, abs=0.02)
    assert np.isnan(means[[0, -1]]).all()


BAR = """
name = "bar"
source = "ours"
ground = { points = { A = [0.1, 0.2] } }
links = { rod = { bar = ["A", "B"], length_m = 0.3, mass_kg = 2.0 } }
[driver]
link = "rod"
law = "free"
start_deg = 20.0
speed_rad_s = 3.0
duration_s = 1.0
"""


def test_a_rod_has_the_momentum_of_its_inertia_about_its_pin_and_keeps_it() -> None:
    rod, time_s = parse_scene(BAR, "here"), np.linspace(0.0, 1.0, 5)
    motion = solve_driven(rod, 0.3 + 3.0 * time_s, np.full(5, 3.0), np.zeros(5), time_s)
    assert momentum(rod, motion, time_s, "A") == pytest.approx(2.0 * 0.3**2 / 3.0 * 3.0)
    late = momentum(rod, motion, time_s + 1e-4, "A")  # to the second order of the delay
    assert late == pytest.approx(0.18, rel=1e-6)
    assert kept_about(rod) == "A"
    # Only where nothing else acts from outside.
    assert kept_about(replace(rod, gravity_m_s2=(0.0, -9.81))) is None
    four = load_scene("fourbar-lecture-1")
    assert kept_about(four) is None
    assert not any(four.gravity_m_s2)


END_S = DT_S * STEPS


def pushed(name: str, link: str, *more: tuple[float, float]) -> Scene:
    """A scene with a torque over time, whose table ends with the run but for ``more`` rows."""
    rows = ((0.0, 0.1), (0.5 * END_S, 0.2), (END_S, 0.1), *more)
    table = Tabulated(*zip(*rows, strict=True))
    return replace(load_scene(name), loads={"push": Load("push", link, None, table)})


@pytest.mark.parametrize(
    ("name", "link"),
    [
        ("fourbar-swing", "crank"),
        slowly("double-pendulum", "upper", reason="two drivers: another truth, the same table"),
    ],
)
def test_what_follows_a_table_ending_with_the_run_is_as_if_it_went_on(name: str, link: str) -> None:
    ends = free_truth(pushed(name, link), STEPS, DT_S)
    goes_on = free_truth(pushed(name, link, (2.0 * END_S, -0.1)), STEPS, DT_S)
    assert ends.free.until_s == END_S < goes_on.free.until_s
    time_s = DT_S * (np.arange(STEPS + 1.0) + 0.5)  # as some engines have their velocities
    own, other = (truth.at(time_s).links[link] for truth in (ends, goes_on))
    np.testing.assert_allclose(own.omega, other.omega, rtol=0, atol=1e-7)
    np.testing.assert_allclose(own.theta, other.theta, rtol=0, atol=1e-10)


CHAIN = WindowChain(2)


def held(disturb: Callable[[Poses], Poses] = lambda poses: poses, **given: Any) -> ChainErrors:
    """The chain for 2 s in an engine that follows the closed form but for what is told."""
    exact = ChainMotion(CHAIN)
    fake = FakeEngine(lambda _, t: exact.motion(t), disturb=disturb, **given)
    return hold(CHAIN, fake, dt_s=1e-3, duration_s=2.0, every=5)


def changed(change: Callable[[BodyPose, Array], BodyPose], *names: str) -> Callable[[Poses], Poses]:
    def disturb(poses: Poses) -> Poses:
        own = {name: poses.bodies[name] for name in names or poses.bodies}
        other = {name: change(body, poses.time_s) for name, body in own.items()}
        return replace(poses, bodies={**poses.bodies, **other})

    return disturb


def test_an_exact_run_has_no_error_and_keeps_its_energy() -> None:
    found = held()
    assert found.run.drive == "free"
    np.testing.assert_array_equal(found.time_s, 5e-3 * np.arange(401))
    assert place_until(found, 2.0) < 1e-14
    assert np.max([found.lean_rad.max(), found.gap_m.max(), energy_drift(found)]) < 1e-14
    assert found.left is None
    # Velocities half a step late are no drift, where that is said.
    assert 1e-9 < energy_drift(held(velocity_shift=0.5)) < 2e-6
    unsaid = held(lambda poses: replace(poses, lag_s=0.0), velocity_shift=0.5)
    assert energy_drift(unsaid) > 1e-3


def test_a_rod_that_leaves_the_others_is_seen_where_it_began() -> None:
    apart = held(turned_link("rocker2", lambda t: np.clip(t - 1.0, 0.0, 0.6)))
    assert apart.gap_m.max() == pytest.approx(2.0 * np.sin(0.3), abs=1e-3)
    assert apart.left is None  # its pins are open: it has not left its branch, but come apart
    shut = {pin: 0.0 * gap for pin, gap in apart.run.gaps.items()}
    left = compared(CHAIN, replace(apart.run, gaps=shut)).left
    assert left.link == "rocker2"
    assert left.time_s == pytest.approx(1.02, abs=0.006)
    truth = ChainMotion(CHAIN).at(np.array([left.time_s]))[0]
    assert left.driver_rad == pytest.approx(truth[0], abs=0.03)
    # One that gives way a little has not left.
    little = held(turned_link("coupler0", lambda t: 0.1 * np.sin(9.0 * t)))
    assert little.left is None
    assert little.lean_rad.max() == pytest.approx(0.1, abs=1e-3)


def test_energy_that_is_lost_is_measured_over_what_a_turn_exchanges() -> None:
    def less(rod: BodyPose, _: Array) -> BodyPose:
        return replace(rod, velocity=0.99 * rod.velocity, omega=0.99 * rod.omega)

    turning, found = ChainMotion(CHAIN), held(changed(less))
    speed = turning.at(found.time_s)[1]
    lost = (1.0 - 0.99**2) * (0.5 * turning.inertia * speed**2).max()
    assert energy_drift(found) == pytest.approx(lost / turning.exchanged_j, rel=1e-9)
    assert found.energy_j[-1] < 0.0
    assert speed_error(found) == pytest.approx(0.01 * CHAIN.length_m * np.abs(speed), rel=1e-9)


def test_the_error_of_b0_is_the_largest_so_far_and_none_after_the_end() -> None:
    def aside(rod: BodyPose, time_s: Array) -> BodyPose:
        return replace(rod, origin=rod.origin + np.outer(time_s, (1e-3, 0.0)))

    found = held(changed(aside, "rocker0"), diverges_after=1500)
    assert found.run.status == "diverged"
    assert place_until(found, 1.0) == pytest.approx(1e-3)
    assert place_until(found, 1.5) == pytest.approx(1.5e-3)
    assert np.isnan(place_until(found, 2.0))


def test_a_run_that_was_driven_or_never_started_is_not_compared() -> None:
    scene = load_scene("fourbar-lecture-1")
    start = solve(scene, np.array([0.0])).state(0)
    driven = run(scene, start, FakeEngine(solve), dt_s=1e-3, steps=10)
    with pytest.raises(CrankcheckError, match=r"no free motion .* under the drive prescribed"):
        compared(CHAIN, driven)
    with pytest.raises(CrankcheckError, match="no free motion to compare: not today"):
        held(refuses="not today")


def test_mujoco_tuned_falls_through_both_flat_positions_with_the_rods_parallel() -> None:
    found = hold(CHAIN, "mujoco", dt_s=1e-3, duration_s=2.0, every=10)
    assert ChainMotion(CHAIN).period_s < 2.0
    assert (found.run.status, found.left) == ("ok", None)
    assert place_until(found, 2.0) < 1e-4
    assert energy_drift(found) < 1e-5
    assert found.gap_m.max() < 1e-6
