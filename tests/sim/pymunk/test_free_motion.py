"""Free motion in pymunk, and its errors by the step: what acts belongs to the end of a step, and
pins are closed for the arcs of their points; and the forces of its joints, with constant friction.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.free.release import release
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.scene import GROUND, Driver, Scene
from models.scene.characteristics import Constant, Polynomial, Sine, Staircase
from models.scene.driver import Released
from models.scene.hard import WindowChain, double_parallelogram
from models.scene.loads import LineSpring, Load, PinSpring, SlideSpring, Spring
from models.scene.tabulated import Tabulated
from sim.engine import Drive, Run
from sim.engine.momentum_balance import MomentumGain, joint_pushes
from sim.engine.ties import Hinge
from sim.pymunk.engine import ENGINE
from sim.pymunk.spoiler import SPOILER
from sim.run import run
from tests.worlds.let_go import released
from tests.worlds.reported_forces import misses
from tests.worlds.runs import acted_on, opened, ran, rubbing, start_of

INERTIA = 1.0 / 3.0
"""Of a rod of 1 m and 1 kg about its end [kg m^2]."""


def rod(*acting: Load | Spring) -> Scene:
    """One rod on a pin, without weight, let go at an angle of 0."""
    bare = WindowChain(0, gravity_m_s2=0.0).scene()
    still = replace(bare, driver=Driver("rocker0", Released(0.0, 0.0, 1.0)))
    return acted_on(still, *acting)


def let_go(scene: Scene, dt_s: float) -> Run:
    given = {"dt_s": dt_s, "steps": round(1.0 / dt_s), "drive": "free"}
    return ran(scene, ENGINE, start=released(scene)[0], **given)


def angle(result: Run) -> Array:
    return next(iter(result.motion.links.values())).theta


def of_second_order(scene: Scene, exact: Callable[[Array], Array], most: float) -> None:
    """Sixteen times as good with a quarter of the step."""
    rough, fine = (
        float(np.abs(angle(ran) - exact(ran.motion.time_s)).max())
        for ran in (let_go(scene, dt_s) for dt_s in (4e-3, 1e-3))
    )
    assert fine < most
    assert 13.0 < rough / fine < 19.0


def test_a_motor_pulls_by_the_speed_of_the_end_of_the_step_past_its_table_by_the_last_row() -> None:
    """Torque 2 - 0.7 omega; by the speed of half a step before errors are of first order."""
    tau, motor = INERTIA / 0.7, Load("motor", "rocker0", None, Polynomial((2.0, -0.7)), "omega")
    of_second_order(rod(motor), lambda t: 2.0 / 0.7 * (t + tau * np.expm1(-t / tau)), 3e-6)
    table = Load("m", "rocker0", None, Tabulated((0.0, 1.0), (2.0, 1.0)), over="omega")
    theta = angle(let_go(rod(table), 1e-3))
    assert np.diff(theta, 2)[-1] == pytest.approx(1e-6 * 1.0 / INERTIA, rel=1e-4)


def test_a_spring_with_a_damper_in_a_pin_swings_as_its_equation() -> None:
    decay = 0.8 / (2.0 * INERTIA)
    pace = math.sqrt(10.0 / INERTIA - decay**2)

    def exact(t: Array) -> Array:
        wave = np.cos(pace * t) + decay / pace * np.sin(pace * t)
        return 1.0 - np.exp(-decay * t) * wave

    knee = PinSpring("knee", 10.0, 0.8, 1.0, "A0", (GROUND, "rocker0"))
    of_second_order(rod(knee), exact, 3e-5)


@pytest.mark.parametrize(
    "places", [(0.0, 0.3, 0.5), (0.0, 0.3004, 0.5007), (0.0003, 0.0012, 0.0017)]
)
def test_a_jump_counts_with_its_share_of_a_step(places: tuple[float, float, float]) -> None:
    """On the grid, beside it, in the first half step, and two of them in one."""
    steps = Staircase(places, (2.0, -3.0, 1.0))
    scene = rod(Load("switched", "rocker0", None, steps))
    result = let_go(scene, 1e-3)
    time_s = result.motion.time_s
    exact = sum(
        rise / INERTIA * np.maximum(time_s - place, 0.0) ** 2 / 2.0
        for place, rise in zip(places, (2.0, -5.0, 4.0), strict=True)
    )
    off = np.abs(angle(result) - exact)
    # In the step of a jump the place is off by a part of rise dt^2 / 2, and from there on as well.
    assert off.max() < 3.0 * 5.0 / INERTIA * 1e-6 / 8.0
    assert off[-1] < 1.01 * np.abs(off[100:]).max()


ALONG = SlideSpring("along", 200.0, 2.0, 0.3, "C")
ACROSS = LineSpring("across", 60.0, 1.0, 0.1, ("A", "C"))
KNEE = PinSpring("knee", 1.5, 0.02, -0.3, "B", ("crank", "rod"))


def cranking(*springs: Spring, name: str = "slider-crank-offset") -> Scene:
    """A slider-crank without weight, let go at 1 rad with 2 rad/s."""
    scene = load_scene(name)
    driver = Driver(scene.driver.link, Released(1.0, 2.0, 1.0))
    return acted_on(replace(scene, driver=driver, gravity_m_s2=(0.0, 0.0)), *springs)


def off_by(scene: Scene, dt_s: float, **settings: str) -> float:
    """The largest error of the crank's angle in 0.2 s [rad]."""
    motion = release(scene, 0.2)
    given = {"dt_s": dt_s, "steps": round(0.2 / dt_s), "drive": "free", "settings": settings}
    result = ran(scene, ENGINE, start=motion.at(np.zeros(1), bound=False).state(), **given)
    exact = motion.at(result.motion.time_s, bound=False).links["crank"].theta
    return float(np.abs(angle(result) - exact).max())


def test_springs_of_every_kind_keep_the_order_of_the_step() -> None:
    """With a block without mass: dampers of pymunk's own are of first order."""
    scene = cranking(ALONG, ACROSS, KNEE, name="slider-crank-excel-350")
    rough, fine = off_by(scene, 1e-3), off_by(scene, 2.5e-4)
    assert 12.0 < rough / fine < 20.0
    assert fine < 5e-5
    shipped, finer = (off_by(scene, dt_s, springs="native") for dt_s in (1e-3, 2.5e-4))
    assert 3.0 < shipped / finer < 8.0
    assert finer > 3.0 * fine


@pytest.mark.parametrize("springs", ["forces", "native"])
@pytest.mark.parametrize("name", ["slider-crank-offset", "slider-crank-excel-350"])
def test_springs_are_no_part_of_what_joints_bear(name: str, springs: str) -> None:
    """Nor of the torque of a drive that is not there."""
    scene = cranking(ALONG, ACROSS, KNEE, name=name)
    given = {"dt_s": 1e-3, "steps": 100, "drive": "free", "settings": {"springs": springs}}
    found = ran(scene, ENGINE, start=released(scene)[0], with_forces=True, **given).motion
    assert found.forces.contradictions == ()
    assert not found.forces.torque[1:].any()


def test_what_almost_rests_at_the_start_is_not_taken_to_run_away() -> None:
    """sin(pi) is 1e-16: by the pace of that start any speed would be a million times too fast."""
    later = rod(Load("wave", "rocker0", None, Sine(3.0, 1.0, math.pi)))
    assert np.ptp(angle(let_go(later, 1e-3))) > 1.0


def test_a_load_of_a_stroke_counts_with_its_share_of_the_step_that_turns_back() -> None:
    """With all or nothing of it there, a quarter of the step makes the error a fifth."""
    push = Load("push", "block C", "C", Constant(4.0), slider="C", stroke="forward")
    scene = replace(cranking(replace(ALONG, damping=0.0)), loads={"push": push})
    state = released(scene)[0]
    angles = [
        angle(run(scene, state, ENGINE, dt_s=1e-3 / n, steps=240 * n, every=8 * n, drive="free"))
        for n in (1, 4, 16)
    ]
    rough, fine = (np.abs(one - angles[-1]).max() for one in angles[:2])
    assert rough / fine > 10.0


def off(name: str, dt_s: float, paths: str) -> float:
    """How far pins are open, over the longest link, after the first steps of half a second."""
    scene = load_scene(name)
    given = {"dt_s": dt_s, "steps": round(0.5 / dt_s), "settings": {"free_paths": paths}}
    done = ran(scene, "pymunk", drive="free", **given)
    return max(float(np.max(gap[8:])) for gap in done.gaps.values()) / scene.longest_m


@pytest.mark.parametrize("name", ["fourbar-swing", "slider-crank-spring"])
def test_pins_are_open_by_a_cube_of_the_step_where_chords_leave_a_square(name: str) -> None:
    arcs, chords = ([off(name, dt, paths) for dt in (2e-3, 1e-3)] for paths in ("arcs", "chords"))
    assert math.log2(arcs[0] / arcs[1]) > 2.7
    assert math.log2(chords[0] / chords[1]) == pytest.approx(2.0, abs=0.2)
    assert arcs[1] < 0.1 * chords[1]


@pytest.mark.parametrize(("profile", "order"), [("as-shipped", 1.0), ("tuned", 2.0)])
def test_a_driven_pin_of_two_moving_links_converges_as_its_profile_does(
    profile: str, order: float
) -> None:
    scene = load_scene("fourbar-by-coupler")
    errors = []
    for steps in (720, 2880):
        done = ran(scene, "pymunk", profile, per_turn=steps, turns=2.0)
        true = solve(scene, done.motion.time_s, bound=False).links["rocker"].theta
        errors.append(float(np.max(np.abs(done.motion.links["rocker"].theta - true))))
    assert errors[0] < 1e-2
    assert math.log2(errors[0] / errors[-1]) / 2.0 == pytest.approx(order, abs=0.1)


START = 4
"""The samples that the start takes: of the first there are no forces, in the next two the joints
make up for half a step, and in one more for what that has left of places."""


def of_a_turn(scene: Scene, steps: int, **given: object) -> Run:
    return ran(scene, ENGINE, per_turn=steps, with_forces=True, **given)


def errors(scene: Scene, steps: int) -> dict[str, float]:
    """The worst of a turn, after the start."""
    found = of_a_turn(scene, steps).motion.forces
    return {key: float(off[START:].max()) for key, off in misses(scene, found).items()}


def forces_of_second_order(scene: Scene, most: float) -> None:
    """All errors at 720 steps a turn are below ``most``, and a quarter of those at 360."""
    coarse, fine = errors(scene, 360), errors(scene, 720)
    for key, least in fine.items():
        assert least < most, key
        assert least < 1e-12 or 3.0 < coarse[key] / least < 5.0, key  # or there is none


@pytest.mark.parametrize("name", [
    "fourbar-lecture-1",
    "sixbar-stephenson",  # two loops
    "slider-crank-excel-350",  # a block without mass, on a rail
    "slider-crank-offset",  # one with mass, in a groove
    "scotch-yoke",  # a gear on a moving guide
    "slotted-lever",  # a block without mass on a moving guide
    "slider-crank-by-piston",  # a slider that drives
])  # fmt: skip
def test_forces_are_the_reference_s_to_the_second_order(name: str) -> None:
    forces_of_second_order(load_scene(name), 5e-4)


def test_no_step_leads_to_the_first_sample_and_it_has_no_forces() -> None:
    found = of_a_turn(load_scene("fourbar-lecture-1"), 90).motion.forces
    assert np.isnan(found.torque[0])
    assert np.isfinite(found.torque[1:]).all()
    assert np.isnan(found.pins["C"]["rocker"][0]).all()
    session = opened(load_scene("fourbar-lecture-1"), ENGINE, dt_s=1e-3, drive="servo")
    log = session.record_forces(5, 10)  # no step is logged
    np.testing.assert_array_equal(log.forces.torque, [np.nan])
    SPOILER.lose(session)
    assert session.record_forces(5, 1).diverged


@pytest.mark.parametrize("drive", ["prescribed", "servo", "free"])
@pytest.mark.parametrize("name", ["sixbar-watt", "scotch-yoke"])
def test_momentum_says_of_every_joint_what_its_impulse_does(name: str, drive: Drive) -> None:
    """Converged or not: iterations change what the joints bear, not what they did."""
    given = {"settings": {"iterations": 5}, "well": False}
    result = of_a_turn(load_scene(name), 180, drive=drive, **given)
    assert result.motion.forces.contradictions == ()
    if drive == "free":
        assert not result.motion.forces.torque[1:].any()


def test_an_impulse_that_momentum_does_not_confirm_is_said() -> None:
    session = opened(load_scene("fourbar-lecture-1"), ENGINE, dt_s=1e-3, drive="servo")
    assert session.record_forces(20, 1).forces.contradictions == ()
    SPOILER.slip(session, 0.01)
    slipped = session.record_forces(20, 1).forces
    said = "; ".join(slipped.contradictions)
    assert "pymunk's impulse on the pin C of coupler and rocker is" in said
    assert "by the momentum of the bodies" in said


def test_weights_are_shared_as_levers_say_and_angles_that_are_lost_spoil_no_other_sample() -> None:
    """Crank upright, coupler level, rocker hanging; their joints hold up 1, 2 and 3 N in their
    middles. What stands upright bears no side force."""
    scene, gains = load_scene("fourbar-lecture-1"), {}
    ends = {"A": (GROUND, "crank"), "D": (GROUND, "rocker")}
    ends |= {"B": ("crank", "coupler"), "C": ("coupler", "rocker")}
    hinges = [Hinge(point, *bodies) for point, bodies in ends.items()]
    angles = zip(scene.links.values(), (np.pi / 2, 0.0, np.pi / 2), strict=True)
    for weight, (link, theta) in enumerate(angles, 1):
        turned, force = np.array([theta, theta, np.nan]), np.tile([0.0, float(weight)], (3, 1))
        held = (link.centre_m, np.zeros((3, 2)), turned, force, np.zeros(3))
        gains[link.name] = MomentumGain(*held)
    for driven in (True, False):
        pushes = joint_pushes(scene, hinges, gains, driven=driven)
        for hinge, upwards in zip(hinges, (2.0, 4.0, 1.0, -1.0), strict=True):
            np.testing.assert_allclose(pushes.hinges[hinge][:2], [[0.0, upwards]] * 2, atol=1e-12)
            assert np.isnan(pushes.hinges[hinge][2]).all()
        assert pushes.spare == 0
        np.testing.assert_allclose(pushes.torque[: 2 if driven else 3], 0.0, atol=1e-12)


def test_of_redundant_links_the_torque_alone_is_given() -> None:
    scene = double_parallelogram("double-parallelogram", source="test")
    scene = replace(scene, gravity_m_s2=(0.0, -9.81))
    found = ran(scene, ENGINE, dt_s=1e-3, steps=200, with_forces=True).motion.forces
    exact = forces(scene, found.time_s, bound=False)
    assert not found.pins
    assert "redundant links" in found.undetermined
    off = np.abs(found.torque - exact.torque)[START:]
    assert off.max() < 1e-3 * np.abs(exact.torque).max()


def loaded(name: str, *loads: Load) -> Scene:
    return acted_on(load_scene(name), *loads)


TURN = Sine(2.0, math.tau, 0.3)
LOADED = {
    "over the crank's angle, and on the crank": loaded(
        "fourbar-lecture-1", Load("a", "coupler", None, Sine(0.5, math.tau), over="angle"),
        Load("b", "crank", "B", TURN, direction_rad=1.0)),
    "on a block without mass on a moving guide": loaded(
        "slotted-lever", Load("a", "block B", "B", TURN, direction_rad=0.5, frame="body"),
        Load("b", "block B", None, Constant(0.7))),
    "on a block with mass": loaded(
        "slider-crank-offset", Load("a", "block C", "C", TURN, direction_rad=0.5),
        Load("b", "block C", None, Constant(0.7))),
}  # fmt: skip


@pytest.mark.parametrize("where", LOADED)
def test_loads_act_at_the_instant_of_the_joints(where: str) -> None:
    """Those of the start of a step are a step late: errors of first order, ten times as large."""
    forces_of_second_order(LOADED[where], 1e-3)


def test_a_load_of_a_stroke_acts_on_that_stroke() -> None:
    scene = loaded(
        "slider-crank-offset",
        Load("a", "block C", "C", Constant(5.0), slider="C", stroke="forward"),
    )
    found = of_a_turn(scene, 360).motion.forces
    exact = forces(scene, found.time_s, bound=False)
    off = np.abs(found.torque - exact.torque)[START:] > 1e-3 * np.abs(exact.torque).max()
    assert off.sum() <= 2  # at the ends of the stroke


def renamed(name: str, slider: str) -> Scene:
    """With another name for its slider, which leaves that of the point to the pin."""
    scene = load_scene(name)
    ((old, only),) = scene.sliders.items()
    branch = {slider if key == old else key: sign for key, sign in scene.branch.items()}
    return replace(scene, sliders={slider: replace(only, name=slider)}, branch=branch)


RUBBING = {
    "pins": rubbing(load_scene("fourbar-lecture-1"), A=0.03, B=0.04, C=0.05, D=0.06),
    "a block without mass": rubbing(renamed("slider-crank-excel-350", "piston"), C=2.0, piston=3.0),
    "one with mass": rubbing(renamed("slider-crank-offset", "piston"), C=0.2, piston=3.0),
    "one on a moving guide": rubbing(renamed("slotted-lever", "die"), B=0.2, die=0.3),
}


@pytest.mark.parametrize("where", RUBBING)
def test_constant_friction_is_against_the_motion(where: str) -> None:
    """But for the samples at which a joint turns back, where it may be anything within its size."""
    scene = RUBBING[where]
    found = of_a_turn(scene, 720).motion.forces
    exact = forces(scene, found.time_s, bound=False)
    same = np.ones(len(found.time_s), dtype=bool)
    for joint, law in scene.friction.items():
        agree = np.isclose(found.friction[joint], exact.friction[joint], atol=1e-9 * law.size)
        assert (~agree).sum() <= 1 + 2, joint  # the first sample, and the ends of two strokes
        same &= agree
    same[:START] = False
    for key, off in misses(scene, found).items():
        assert off[same].max() < 1e-3, key


def test_friction_of_a_pin_brings_a_free_mechanism_to_rest_and_that_of_a_slider_is_refused() -> (
    None
):
    scene = rubbing(load_scene("slider-crank-offset"), B=5.0)
    state, given = start_of(scene), {"dt_s": 1e-3, "drive": "free"}
    result = run(scene, state, ENGINE, steps=1000, **given)
    assert np.abs(result.motion.links["crank"].omega[-100:]).max() < 1e-6
    refused = run(rubbing(scene, C=1.0), state, ENGINE, steps=10, **given)
    assert refused.status == "unsupported"
    assert "friction.C: pymunk has no friction that holds a slider at rest" in refused.reason
