"""From poses to the motion of the mechanism and the lengths of its springs: exact poses give the
exact ones, faults show; and the streams that put the crank exactly where the law has it.
"""

from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from analytic.forces.force_elements import spring_lengths as true_lengths
from analytic.free.machine import Machine
from analytic.kinematics import chunks, solve
from models.errors import EngineError
from models.files.reading import load_scene, shipped
from models.mjcf.tree import plan
from models.scene import GROUND, Scene
from models.scene.joints import line_ends, whole_turns
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from models.scene.loads import LineSpring, PinSpring, SlideSpring
from sim.engine import Poses
from sim.engine.drive import chords, pushes, start_speed
from sim.engine.measure import energy, gaps, motion, spring_lengths
from sim.engine.tree_poses import body_poses
from sim.run.check import refuse_other_model
from tests.worlds.engines import FULL
from tests.worlds.runs import acted_on, ran, start_of


def exact(scene: Scene, fake: ModuleType, samples: int = 97, lag_s: float = 0.0) -> Poses:
    """True poses over 1.2 periods, with the velocities of ``lag_s`` later."""
    time_s = np.linspace(0.0, 1.2 * scene.driver.law.period_s, samples)
    engine = fake.FakeEngine(solve, velocity_shift=lag_s / 1e-3)
    return fake.exact_poses(scene, engine, time_s, 1e-3)


@pytest.mark.parametrize("name", sorted(shipped()))
def test_exact_poses_give_the_exact_motion_without_gaps(name: str, fake_engine: ModuleType) -> None:
    scene = load_scene(name)
    poses = exact(scene, fake_engine)
    found, wanted = motion(scene, poses), solve(scene, poses.time_s)
    assert set(found.points) == set(wanted.points)
    for kind in ("links", "points", "sliders"):
        for key, track in getattr(wanted, kind).items():
            for quantity, array in vars(track).items():
                got = getattr(getattr(found, kind)[key], quantity)
                scale = max(np.abs(array).max(), scene.longest_m)
                np.testing.assert_allclose(
                    got, array, atol=1e-11 * scale, err_msg=f"{key} {quantity}"
                )
    open_by = gaps(scene, poses)
    assert set(scene.sliders) <= set(open_by)
    assert max(gap.max() for gap in open_by.values()) < 1e-13


@pytest.mark.parametrize(("name", "body", "key", "by", "open_by"), [
    ("fourbar-lecture-1", "rocker", "origin", [3e-4, 4e-4], {"C": 5e-4, "D": 5e-4, "B": 0.0}),
    ("slider-crank-excel-350", "rod", "origin", [3e-4, -4e-4], {"C": 4e-4, "B": 5e-4}),
    ("fourbar-lecture-1", "rocker", "theta", 1e-3, {"C": 0.8e-3}),  # at 0.2 m, of 0.25 m
    ("scotch-yoke", "yoke", "theta", 1e-5, {"Y": 1e-5}),
    ("scotch-yoke", "block B", "theta", -2e-5 + 4 * np.pi, {"B": 2e-5}),
], ids=["of copies", "from a line, not along", "of an arm", "of a turn", "of turns"])  # fmt: skip
def test_a_gap_is_the_largest_distance_of_what_is_joined(
    name: str, body: str, key: str, by: Any, open_by: dict[str, float], fake_engine: ModuleType
) -> None:
    """What turns against its line is open by the angle times the longest link."""
    scene = load_scene(name)
    poses = exact(scene, fake_engine)
    own = poses.bodies[body]
    moved = replace(own, **{key: getattr(own, key) + np.array(by)})
    wrong = replace(poses, bodies={**poses.bodies, body: moved})
    found = gaps(scene, wrong)
    for joint, size in open_by.items():
        size_m, rtol = (size * scene.longest_m, 1e-6) if key == "theta" else (size, 1e-9)
        np.testing.assert_allclose(found[joint], size_m, rtol=rtol, atol=1e-15)
    if key == "theta" and body in scene.links:
        off = motion(scene, wrong).links[body].theta - motion(scene, poses).links[body].theta
        np.testing.assert_allclose(off, by, rtol=1e-9, atol=1e-15)


def test_speed_and_acceleration_along_a_moving_line_are_rates_of_the_displacement(
    fake_engine: ModuleType,
) -> None:
    """For a point off its line, where the Coriolis term has a part along it."""
    scene = load_scene("slotted-lever")
    turned = fake_engine.turned_link("lever", lambda t: np.full_like(t, 0.3))
    poses = turned(exact(scene, fake_engine, 4001))
    found = motion(scene, poses).sliders["B"]
    for rate, of in ((found.speed, found.displacement), (found.acceleration, found.speed)):
        by_hand = np.gradient(of, poses.time_s, edge_order=2)
        np.testing.assert_allclose(rate, by_hand, atol=1e-4 * np.abs(rate).max())


@pytest.mark.parametrize("name", ["slotted-lever", "shaper"])
def test_velocities_that_lag_are_those_of_their_own_instant(
    name: str, fake_engine: ModuleType
) -> None:
    scene = load_scene(name)

    def worst(lag_s: float, level: int) -> float:
        poses = exact(scene, fake_engine, lag_s=lag_s)
        found = motion(scene, poses)
        wanted = solve(scene, poses.time_s + (lag_s if level == 1 else 0.0))
        errors = []
        for kind in ("points", "sliders"):
            for key, track in getattr(wanted, kind).items():
                quantity = list(vars(track))[level]
                got = getattr(getattr(found, kind)[key], quantity)
                errors.append(float(np.abs(got - getattr(track, quantity)).max()))
        return max(errors)

    period = scene.driver.law.period_s
    for level in (1, 2):
        coarse, fine = worst(period / 200, level), worst(period / 400, level)
        assert fine < 2e-3 * scene.longest_m * scene.driver.law.peak_speed_rad_s**level
        assert 3.5 < coarse / fine < 4.5, level


DT_S = 1e-3
FOURBAR = acted_on(
    load_scene("fourbar-lecture-1"),
    LineSpring("across", 100.0, 1.0, 0.05, ("A", "C")),
    LineSpring("diagonal", 10.0, 0.0, 0.0, ("B", "D")),
    PinSpring("knee", 5.0, 0.1, 0.3, "C", ("coupler", "rocker")),
    PinSpring("crank", 0.1, 0.0, 0.0, "A", (GROUND, "crank")),
)
SLIDERS = (
    acted_on(
        load_scene("slider-crank-offset"), SlideSpring("along", 300.0, 3.0, 0.1, "C"),
        LineSpring("block", 20.0, 0.0, 0.0, ("C", "A"))),
    acted_on(load_scene("slotted-lever"), SlideSpring("along", 300.0, 3.0, 0.1, "B")),
)  # fmt: skip
"""Springs along lines of the ground and of a link, of blocks with and without mass."""


def poses_of(fake: ModuleType, scene: Scene, shift: float = 0.0) -> Any:
    time_s = np.linspace(0.0, 1.2 * scene.driver.law.period_s, 301)
    return fake.exact_poses(scene, fake.FakeEngine(solve, velocity_shift=shift), time_s, DT_S)


@pytest.mark.parametrize("scene", [FOURBAR, *SLIDERS], ids=lambda scene: scene.name)
def test_lengths_are_those_of_the_reference(scene: Scene, fake_engine: ModuleType) -> None:
    poses = poses_of(fake_engine, scene)
    found = spring_lengths(scene, poses)
    ((_, chunk),) = chunks(scene, poses.time_s, bound=False)
    for spring, true, _ in true_lengths(scene, chunk):
        off = found[spring.name] - true
        if isinstance(spring, PinSpring):  # turns are counted on here
            assert off[0] == pytest.approx(0.0, abs=1e-12)
            off = np.remainder(off + np.pi, 2.0 * np.pi) - np.pi
        np.testing.assert_allclose(off, 0.0, atol=1e-12)
    assert list(found) == list(scene.springs)


def test_springs_are_wound_up_and_keep_their_energy_as_the_velocities_are(
    fake_engine: ModuleType,
) -> None:
    late, crank = poses_of(fake_engine, FOURBAR, 0.5), FOURBAR.springs["crank"]
    alone, bare = (replace(FOURBAR, springs=springs) for springs in ({"crank": crank}, {}))
    shift = energy(alone, late).potential_j - energy(bare, late).potential_j
    moved = spring_lengths(FOURBAR, late)["crank"] + 0.5 * DT_S * late.bodies["crank"].omega
    np.testing.assert_allclose(shift, 0.05 * moved**2, rtol=1e-12)
    # Wound up, and not let go after half a turn.
    q = spring_lengths(FOURBAR, poses_of(fake_engine, FOURBAR))["crank"]
    assert abs(q[0]) <= np.pi
    assert q[-1] - q[0] == pytest.approx(2.4 * np.pi)
    spring = PinSpring("turned", 1.0, 0.0, 4.0, "A", (GROUND, "crank"))
    assert 0.5 + whole_turns(spring, 0.5) == pytest.approx(0.5 + 2.0 * np.pi)


DRIVEN = {
    "shaft": ("fourbar-lecture-1", PinSpring("p", 5.0, 0.1, 0.3, "A", ("ground", "crank"))),
    "on a link, without mass": ("slotted-lever", SlideSpring("s", 300.0, 3.0, 0.1, "B")),
    "on a link, with mass": ("scotch-yoke", SlideSpring("s", 300.0, 3.0, 0.1, "B")),
}


@pytest.mark.parametrize("engine", FULL)
@pytest.mark.parametrize("where", DRIVEN)
def test_springs_of_a_driven_mechanism_are_borne_by_its_drive(where: str, engine: str) -> None:
    """By the work of all that moves; pymunk's own springs are of first order."""
    name, spring = DRIVEN[where]
    scene = acted_on(load_scene(name), spring)
    native = [({"springs": "native"}, 3e-2)] if engine == "pymunk" else []
    for settings, within in [({}, 1e-3), *native]:
        forces = ran(scene, engine, with_forces=True, settings=settings).motion.forces
        assert forces.contradictions == ()
        machine, (theta, omega, _) = Machine(scene), scene.driver.law.at(forces.time_s)
        slope = machine.inertia(theta)[1]
        wound = {"p": theta} if where == "shaft" else {}
        exact = 0.5 * slope * omega**2 - machine.push(forces.time_s, theta, omega, wound)
        assert np.abs(forces.torque - exact)[4:].max() < within * np.abs(exact).max()


def test_what_the_engine_holds_of_a_spring_and_its_ends_is_the_scenes(
    fake_engine: ModuleType,
) -> None:
    fake = fake_engine.FakeEngine(solve)
    state = start_of(FOURBAR)
    facts = fake.open(FOURBAR, state, {}, DT_S, "prescribed").facts()
    refuse_other_model(FOURBAR, state, facts, DT_S, "prescribed")
    own = dict(facts.springs)
    stray = {**own, "stray": (1.0, 0.0, 0.0)}
    missing = {name: one for name, one in own.items() if name != "knee"}
    for springs, words in (
        ({**own, "across": (100.0, 2.0, 0.05)}, "springs.across has damping 2, not 1"),
        ({**own, "across": (100.0, 1.0, 0.0)}, "springs.across has free 0, not 0.05"),
        ({**own, "knee": (float("nan"), 0.1, 0.3)}, "springs.knee has rate nan, not 5"),
        (missing, "springs.knee is not there"),
        (stray, "springs.stray is none of the scene"),
    ):
        with pytest.raises(EngineError, match=words):
            refuse_other_model(FOURBAR, state, replace(facts, springs=springs), DT_S, "prescribed")
    across = FOURBAR.springs["across"]
    (ground, place), (body, at) = line_ends(FOURBAR, across)
    assert (ground, place) == (GROUND, FOURBAR.ground["A"])
    assert (body, at) == ("coupler", FOURBAR.links["coupler"].points["C"])
    lost = replace(across, points=("A", "Z"))
    with pytest.raises(EngineError, match=r"springs\.across: no body carries point Z"):
        line_ends(FOURBAR, lost)


def test_coordinates_beyond_numbers_are_a_run_that_came_apart_and_no_warning() -> None:
    scene = load_scene("slider-crank-offset")
    start = start_of(scene)
    limbs = plan(scene, start).limbs
    q = np.full((2, sum(len(limb.freedoms) for limb in limbs)), 1e300)
    found = body_poses(limbs, q, q, q)
    assert not all(np.isfinite(pose.origin_acceleration).all() for pose in found.values())


STEP_S, START_S, STEPS = 2e-3, 0.13, 2000
TIMES = START_S + STEP_S * np.arange(STEPS + 1)
LAWS = (
    ConstantSpeed(0.4, -3.0), Oscillating(1.0, 0.7, 6.0, 0.5), FromRest(0.2, 9.0, 0.4),
    Accelerating(0.2, 3.0, -1.3),
)  # fmt: skip


@pytest.mark.parametrize("shift", [0.0, -0.5])
@pytest.mark.parametrize("law", LAWS)
def test_pushes_make_the_angle_exact_at_every_sample(law: Law, shift: float) -> None:
    """And the start speed keeps the speed from alternating about the law's."""
    gained = STEP_S * pushes(law, START_S, STEP_S, STEPS, shift)
    omega = np.cumsum([start_speed(law, START_S, STEP_S, shift), *gained])
    mean = omega[1:] if shift else (omega[1:] + omega[:-1]) / 2.0
    theta, _, _ = law.at(TIMES)
    np.testing.assert_allclose(theta[0] + np.cumsum(STEP_S * mean), theta[1:], atol=1e-10)
    off = omega - law.at(TIMES + shift * STEP_S)[1]
    np.testing.assert_allclose(off, 0.0, atol=4e-4 * law.peak_speed_rad_s)
    if isinstance(law, Oscillating) and shift == 0.0:
        assert np.abs(np.diff(off)).max() < 0.02 * np.abs(off).max()


@pytest.mark.parametrize("law", LAWS)
def test_chords_join_the_samples(law: Law) -> None:
    joined = np.diff(law.at(TIMES[5:11])[0]) / STEP_S
    np.testing.assert_allclose(chords(law, START_S, STEP_S, 5, 9), joined, rtol=1e-10, atol=1e-12)
    assert start_speed(law, START_S, STEP_S, 0.5) == chords(law, START_S, STEP_S, 0, 0)[0]
