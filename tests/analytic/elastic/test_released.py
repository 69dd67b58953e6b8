"""Mechanisms with elastic links that are let go, by ways that have no integration in common; and a
crank that a controller holds to its speed: it gives way, and the vibration goes."""

import math
import tomllib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.elastic.control import ControlledForces, control_elastic, released_under_control
from analytic.elastic.discretisation import Modes, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion, fastest_rad_s
from analytic.elastic.released import assembled, release_elastic
from analytic.forces.kinetostatics import forces
from analytic.free.release import release
from analytic.kinematics import solve
from analytic.multibody.release_multibody import release_multibody
from models.errors import CrankcheckError, SceneError
from models.files.assemble import scene_text
from models.files.reading import find_scene, load_scene, parse_scene
from models.mjcf.document import build
from models.scene import Scene
from models.scene.characteristics import FourierSum, Pulse
from models.scene.driver import Controlled
from models.scene.laws import ConstantSpeed
from models.scene.loads import Load
from sim.registry import engine
from sim.run.check import refuse_unknown_forces
from tests.analytic.elastic.driven import apart, by_multipliers, following, largest, with_elastic
from tests.analytic.multibody.scenes import FIVE_BAR, PARALLELOGRAM, SLIDER_CRANK, scene
from tests.worlds.engines import FULL
from tests.worlds.tiers import slow, slowly

PULSE = load_scene("fourbar-elastic-pulse")
PULSE_TEXT = find_scene("fourbar-elastic-pulse").read_text(encoding="utf-8")
AXIAL_N = 200e9 * 0.01 * 0.0012
STRIP = "[elastic.rod]\nflexural_n_m2 = 0.3\ndamping_s = 1e-4\n"
AXIAL = with_elastic(PULSE, flexural_n_m2=math.inf, axial_n=AXIAL_N)
DAMPED = scene(SLIDER_CRANK + "start_deg = 30.0\nspeed_rad_s = 12.0\n" + STRIP)
FIVE = scene(FIVE_BAR + "[elastic.first]\nflexural_n_m2 = 2.0\n")


@pytest.mark.parametrize(
    "mechanism", [DAMPED, slowly(FIVE, reason="half a second and more: two freedoms")]
)
def test_both_methods_agree(mechanism: Scene) -> None:
    """Collocation without multipliers, an explicit method with them."""
    time_s = np.linspace(0.0, 0.02, 41)
    (link,) = mechanism.elastic
    multibody, free = (f(mechanism, 0.02, Modes(1)) for f in (by_multipliers, release_elastic))
    assert apart(free.at(time_s), multibody.at(time_s), link) < 1e-8


@slow("rare: vibration along a link, asked for; across both methods agree above")
def test_what_rings_along_itself_is_followed_if_asked() -> None:
    """At 1e4 rad/s, by a hundredth of a micrometre; else it is left to a method that is stable."""
    by, until_s, time_s = Modes(0, 1), 0.0015, np.linspace(0.0, 0.0015, 21)
    true = by_multipliers(AXIAL, until_s, by).at(time_s).elastic["coupler"].extension
    for tolerance, most in ((None, 1e-9), (1e-15, 1e-4 * largest(true))):
        found = release_elastic(AXIAL, until_s, by, tolerance=tolerance).at(time_s)
        assert largest(found.elastic["coupler"].extension - true) < most


def test_energy_is_the_work_of_the_pulse() -> None:
    time_s = np.linspace(0.0, 0.22, 66)
    pulse = replace(PULSE.loads["pulse"], characteristic=Pulse(0.03, 0.2))
    energy = release_elastic(replace(PULSE, loads={"pulse": pulse}), 0.22, Modes(1)).energy(time_s)
    scale = float(energy.kinetic.max())
    after = (energy.kinetic + energy.potential)[time_s > 0.201]
    assert np.ptp(after) < 1e-9 * scale
    assert np.ptp(energy.balance) < 1e-9 * scale
    assert energy.work[-1] > 0.1 * scale


@pytest.mark.parametrize(
    "release_by", [release_elastic, slowly(by_multipliers, reason="both methods agree above")]
)
def test_energy_is_what_damping_takes(release_by: Callable[..., Any]) -> None:
    energy = release_by(DAMPED, 0.05, Modes(1)).energy(np.linspace(0.0, 0.05, 31))
    assert np.ptp(energy.balance) < 1e-9 * energy.kinetic.max()
    assert energy.work[-1] < -1e-6 * energy.kinetic.max()


@slow("a limit of what two methods agree upon below")
def test_a_stiff_link_moves_as_a_rigid_one() -> None:
    """With an error of the first order in 1/E."""
    time_s = np.linspace(0.0, 0.04, 6)
    rigid = release(replace(PULSE, elastic={}, start=replace(PULSE.start, shape=None)), 0.04)
    true = rigid.at(time_s, bound=False).links["crank"].theta
    off, flexural = [], PULSE.elastic["coupler"].flexural_n_m2
    for times in (1e2, 1e4):
        stiff = with_elastic(PULSE, flexural_n_m2=times * flexural)
        motion = release_elastic(stiff, 0.04, Modes(1)).at(time_s)
        off.append(largest(motion.links["crank"].theta - true))
    assert off[1] < 0.02 * off[0] < 1e-4


def test_a_quasi_static_start_does_not_ring() -> None:
    """No coefficient has a second derivative; straight links have."""
    heavy = replace(PULSE, gravity_m_s2=(0.0, -9.81))
    straight = replace(heavy, start=replace(heavy.start, shape="straight"))
    off = []
    for one in (heavy, straight):
        free = release_elastic(one, 0.01, Modes(3))
        (q, rates), form = free.start, free.form
        tangent = form.tangent(q)
        y = np.zeros((1, tangent.free.shape[1]))
        first = form.at(np.zeros(1), tangent, y, form.coordinates(tangent, rates)[None])
        off.append(largest(first.all_seconds[0, free.dynamics.assembly.coefficients]))
    assert off[0] < 1e-9 * off[1]
    assert off[1] > 1.0


def test_a_driven_mechanism_goes_on_with_its_speed() -> None:
    driven = load_scene("fourbar-elastic")
    driven = replace(driven, start=replace(driven.start, shape="straight"))
    motion = release_elastic(driven, 0.01, Modes(1)).at(np.zeros(1))
    assert motion.links["crank"].omega[0] == pytest.approx(7.3686, rel=1e-12)


KINKED = scene(
    SLIDER_CRANK + "start_deg = 30.0\n" + STRIP + '[loads.stop]\nblock = "C"\nslider = "C"\n'
    'law = "constant"\nstroke = "forward"\nforce_n = 1.0\ndirection_deg = 180.0\n'
)


@pytest.mark.parametrize(
    ("let_go", "words"),
    [
        (lambda: release(PULSE, 1.0), "coupler is elastic"),
        (lambda: release_multibody(PULSE, 1.0, near=assembled(PULSE)),
         "coupler is elastic"),
        (lambda: release_elastic(load_scene("fourbar-elastic"), 0.1), "no known period"),
        (lambda: release_elastic(PULSE, -1.0), "free for -1 s"),
        (lambda: release_elastic(PULSE, 0.1, Modes(1)).at(np.array([0.2])),
         r"integrated up to 0\.1 s"),
        (lambda: release_elastic(KINKED, 0.1, Modes(1)).at(np.zeros(1)),
         r"loads\.stop is not smooth over the motion"),
        (lambda: parse_scene(PULSE_TEXT.replace('"quasi-static"', '"periodic"'), "file.toml"),
         'found "periodic" with a free driver'),
        (lambda: control_elastic(load_scene("fourbar-elastic"), 1.0), "driver is not controlled"),
        (lambda: released_under_control(load_scene("fourbar-elastic")), "driver is not controlled"),
    ],
)  # fmt: skip
def test_what_can_not_be_let_go_says_why(let_go: Callable[[], object], words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        let_go()


def test_a_link_that_others_hold_in_shape_can_start_straight_alone() -> None:
    """A third rod of a parallelogram that stretches: the others leave it no length of its own."""
    text = PARALLELOGRAM + "SHAPE[elastic.spare]\nbends = false\nstretches = true\naxial_n = 2e3\n"
    straight = scene(text.replace("SHAPE", 'shape = "straight"\n'))
    ways, ends = (release_elastic, by_multipliers), np.array([0.0, 0.1])
    motion, other = (way(straight, 0.1, Modes(0, 1)).at(ends) for way in ways)
    assert motion.links["crank"].theta == pytest.approx(other.links["crank"].theta, rel=1e-10)
    assert largest(motion.elastic["spare"].extension) < 1e-14
    with pytest.raises(CrankcheckError, match="its joints hold spare in shape"):
        release_elastic(scene(text.replace("SHAPE", "")), 0.1, Modes(0, 1))


def test_next_to_its_start_and_its_end_it_goes_on_as_it_does_there() -> None:
    """What an engine with velocities of half a step later, or before, is held to."""
    motion, longer = (release_elastic(PULSE, until_s, Modes(2)) for until_s in (0.1, 0.2))
    after = np.array([0.1003])
    assert apart(motion.outside(after), longer.at(after), "coupler") < 1e-5
    rest = motion.at(np.zeros(1)).links["crank"]
    before = motion.outside(np.array([-1e-3])).links["crank"]
    assert before.omega == pytest.approx(rest.omega - 1e-3 * rest.alpha, abs=1e-3)


def test_its_fastest_frequency_is_that_of_what_nothing_holds() -> None:
    """A light crank gives way: it is higher than with one that is held."""
    held = following(PULSE, ConstantSpeed(PULSE.driver.law.offset_rad, 1.0))
    for by in (Modes(2), Segments(4)):
        assert fastest_rad_s(held, by) < fastest_rad_s(PULSE, by) < 1.2 * fastest_rad_s(held, by)


SCENE = load_scene("fourbar-elastic-controlled")
LAW = SCENE.driver.law
assert isinstance(LAW, Controlled)
TURN_S = LAW.period_s


def with_gains(scene: Scene, kp: float, kd: float) -> Scene:
    return following(scene, Controlled(LAW.start_rad, LAW.speed_rad_s, kp, kd))


@slow("without control both methods are compared below; the controller's torque as well")
def test_under_control_multipliers_give_the_same_motion() -> None:
    until_s = 0.02 * TURN_S
    time_s = np.linspace(0.0, until_s, 11)
    motion = control_elastic(SCENE, until_s, Modes(1)).at(time_s)
    other = by_multipliers(SCENE, until_s, Modes(1), acting=ControlledForces).at(time_s)
    assert apart(motion, other, "coupler") < 1e-8


def test_the_controllers_torque_is_all_work_there_is_and_none_when_let_go() -> None:
    motion = control_elastic(SCENE, 0.1 * TURN_S, Modes(1))
    time_s = np.linspace(0.0, 0.1 * TURN_S, 11)
    own, energy = motion.at(time_s), motion.energy(time_s)
    crank = own.links["crank"]
    needed = forces(replace(SCENE, elastic={}), time_s, bound=False).torque
    told, speed, _ = LAW.at(time_s)
    wanted = needed - 10.0 * (crank.theta - told) - 0.1 * (crank.omega - speed)
    np.testing.assert_allclose(own.forces.torque, wanted, atol=1e-12)
    assert np.ptp(energy.balance) < 1e-9 * energy.kinetic.max()
    assert np.ptp(energy.work) > 1e-3 * energy.kinetic.max()
    free = release_elastic(SCENE, 0.01, Modes(1)).at(np.array([0.0, 0.01]))
    assert largest(free.forces.torque) == 0.0


def test_a_file_names_a_controller_and_reads_back() -> None:
    text = find_scene("fourbar-elastic-controlled").read_text(encoding="utf-8")
    table = tomllib.loads(text)["driver"]
    assert Controlled(LAW.start_rad, 7.3686, table["kp_n_m_rad"], table["kd_n_m_s"]) == LAW
    assert parse_scene(scene_text(SCENE), "again").driver == SCENE.driver
    for old, new, words in [
        ("kp_n_m_rad = 10.0", "kp_n_m_rad = -1.0", "driver.kp_n_m_rad: found -1"),
        ("kd_n_m_s = 0.1\n", "", "driver.kd_n_m_s"),
        ('shape = "straight"', 'shape = "periodic"', "with a free driver"),
    ]:
        with pytest.raises(SceneError, match=words.replace(".", r"\.")):
            parse_scene(text.replace(old, new), "file.toml")
    with pytest.raises(ValueError, match="gains of 0 or more"):
        with_gains(SCENE, 1.0, -1.0)


def test_nobody_takes_a_controlled_crank_for_one_that_is_told() -> None:
    with pytest.raises(CrankcheckError, match="is controlled, and gives way"):
        assert DrivenElasticMotion(SCENE, 1.0, Modes(1), "straight", stiffened=True).form
    state = solve(SCENE, np.zeros(1), bound=False).state()
    with pytest.raises(CrankcheckError, match="would keep its speed exactly"):
        build(SCENE, state)
    for name in FULL:
        with pytest.raises(CrankcheckError, match="its driver is controlled"):
            refuse_unknown_forces(SCENE, engine(name), with_forces=False)


@pytest.mark.parametrize(
    "kp",
    [
        slowly(10.0, reason="half a second: the torque itself is compared above"),
        slowly(0.0, reason="one gain alone"),
    ],
)
def test_a_controllers_torque_as_loads_does_the_same(kp: float) -> None:
    scene, until_s = with_gains(replace(SCENE, gravity_m_s2=(0.0, -9.81)), kp, 0.1), 0.02
    times = np.linspace(0.0, until_s, 50)
    loose = released_under_control(scene)
    assert loose.is_free
    ours = release_elastic(loose, until_s, Modes(2)).at(times)
    theirs = control_elastic(scene, until_s, Modes(2)).at(times)
    assert largest(ours.links["crank"].theta - theirs.links["crank"].theta) < 1e-12
    assert largest(ours.links["crank"].alpha - theirs.links["crank"].alpha) < 1e-8


# Two waves in three turns: smooth, and another in each of them.
LONG = FourierSum(0.0, (0.1,), (0.0,), 1.5 * TURN_S)


@pytest.mark.parametrize(
    ("load", "words"),
    [
        (Load("kick", "rocker", None, Pulse(0.1, 0.3)), "does not continue smoothly"),
        (Load("kick", "rocker", None, LONG), "does not continue smoothly"),
        (Load("controller-speed", "rocker", None, FourierSum(0.1, (), (), 1.0)),
         "controller-speed has the name"),
    ],
)  # fmt: skip
def test_a_load_that_can_not_stand_beside_its_torque_is_refused(load: Load, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        released_under_control(replace(SCENE, loads={load.name: load}))
