"""A crank that a controller holds to its speed: it gives way, and the vibration goes."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.control import ControlledForces, control_elastic, released_under_control
from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.released import release_elastic
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.controlled import Controlled
from models.elastic import Shape
from models.errors import CrankcheckError, SceneError
from models.files import find_scene, load_scene, parse_scene
from models.laws import ConstantSpeed
from models.loads import Load
from models.mjcf import build
from models.scene import Scene
from models.scene_text import scene_text
from models.waves import FourierSum, Pulse
from sim.check import refuse_unknown_forces
from sim.registry import ENGINES, engine
from tests.analytic.elastic.driven import apart, by_multipliers, following, largest, with_elastic
from tests.worlds.tiers import slowly

SCENE = load_scene("fourbar-elastic-controlled")
LAW = SCENE.driver.law
assert isinstance(LAW, Controlled)
TURN_S = LAW.period_s


def with_gains(scene: Scene, kp: float, kd: float) -> Scene:
    """The scene with another controller."""
    return following(scene, Controlled(LAW.start_rad, LAW.speed_rad_s, kp, kd))


@pytest.mark.parametrize(
    ("begin", "end"), [(0.65, 0.8), slowly(1.0, 1.3, reason="a second: that it stays so")]
)
def test_it_quells_what_rings_for_ever_under_a_crank_of_constant_speed(
    begin: float, end: float
) -> None:
    """Both start straight; the periodic motion is what is left when nothing rings."""
    driven = following(SCENE, ConstantSpeed(LAW.start_rad, LAW.speed_rad_s))
    time_s, until_s = TURN_S * np.linspace(begin, end, 31), end * TURN_S

    def bent(start: Shape) -> Array:
        by = DrivenElasticMotion(driven, until_s, Modes(1), start, stiffened=True)
        return by.at(time_s).elastic["coupler"].middle

    periodic = bent("periodic")
    controlled = control_elastic(SCENE, until_s, Modes(1)).at(time_s)
    assert largest(bent("straight") - periodic) > 0.5 * largest(periodic)
    assert largest(controlled.elastic["coupler"].middle - periodic) < 0.01 * largest(periodic)


@pytest.mark.parametrize("turns", [0.05, slowly(0.1, reason="errors that grow with time")])
def test_with_multipliers_it_is_the_same_motion(turns: float) -> None:
    until_s = turns * TURN_S
    time_s = np.linspace(0.0, until_s, 11)
    motion = control_elastic(SCENE, until_s, Modes(1)).at(time_s)
    other = by_multipliers(SCENE, until_s, Modes(1), acting=ControlledForces).at(time_s)
    assert apart(motion, other, "coupler") < 1e-8


def test_the_torque_is_that_of_the_controller_and_all_work_there_is() -> None:
    motion = control_elastic(SCENE, 0.2 * TURN_S, Modes(1))
    time_s = np.linspace(0.0, 0.2 * TURN_S, 11)
    own, energy = motion.at(time_s), motion.energy(time_s)
    crank = own.links["crank"]
    needed = forces(replace(SCENE, elastic={}), time_s, bound=False).torque
    told, speed, _ = LAW.at(time_s)
    wanted = needed - 10.0 * (crank.theta - told) - 0.1 * (crank.omega - speed)
    np.testing.assert_allclose(own.forces.torque, wanted, atol=1e-12)
    assert np.ptp(energy.balance) < 1e-9 * energy.kinetic.max()
    assert np.ptp(energy.work) > 1e-3 * energy.kinetic.max()


def test_with_a_stiff_link_the_crank_keeps_to_its_law() -> None:
    """From the quasi-static shape, as a rigid mechanism that starts on its way does."""
    stiff = with_elastic(SCENE, flexural_n_m2=4.725e6)
    stiff = replace(stiff, start=replace(SCENE.start, shape="quasi-static"))
    time_s = np.linspace(0.0, 0.1 * TURN_S, 6)
    crank = control_elastic(stiff, 0.1 * TURN_S, Modes(1)).at(time_s).links["crank"]
    assert largest(crank.theta - LAW.at(time_s)[0]) < 1e-8


def test_without_gains_what_it_needs_is_not_enough() -> None:
    """The torque of the rigid mechanism alone lets the crank drift off."""
    alone = control_elastic(with_gains(SCENE, 0.0, 0.0), 0.35 * TURN_S, Modes(1))
    end = np.array([0.35 * TURN_S])
    assert largest(alone.at(end).links["crank"].theta - LAW.at(end)[0]) > 1e-3


def test_a_file_says_it_and_reads_back() -> None:
    text = find_scene("fourbar-elastic-controlled").read_text(encoding="utf-8")
    table = tomllib.loads(text)["driver"]
    assert Controlled(LAW.start_rad, 7.3686, table["kp_n_m_rad"], table["kd_n_m_s"]) == LAW
    assert parse_scene(scene_text(SCENE), "again").driver == SCENE.driver
    for old, new, words in [
        ("kp_n_m_rad = 10.0", "kp_n_m_rad = -1.0", "driver.kp_n_m_rad: found -1"),
        ("kd_n_m_s = 0.1\n", "", "driver.kd_n_m_s"),
        ('shape = "straight"', 'shape = "periodic"', "whose angle is not told"),
    ]:
        with pytest.raises(SceneError, match=words.replace(".", r"\.")):
            parse_scene(text.replace(old, new), "file.toml")
    with pytest.raises(ValueError, match="gains of 0 or more"):
        with_gains(SCENE, 1.0, -1.0)


def test_nobody_takes_it_for_a_crank_that_is_told() -> None:
    with pytest.raises(CrankcheckError, match="is controlled, and gives way"):
        assert DrivenElasticMotion(SCENE, 1.0, Modes(1), "straight", stiffened=True).form
    state = solve(SCENE, np.zeros(1), bound=False).state()
    with pytest.raises(CrankcheckError, match="without giving way"):
        build(SCENE, state)
    for name in ENGINES:
        with pytest.raises(CrankcheckError, match="its driver is controlled"):
            refuse_unknown_forces(SCENE, engine(name), with_forces=False)


def test_let_go_it_has_no_controller() -> None:
    free = release_elastic(SCENE, 0.01, Modes(1)).at(np.array([0.0, 0.01]))
    assert largest(free.forces.torque) == 0.0


@pytest.mark.parametrize(
    ("kp", "kd", "until_s"),
    [
        (10.0, 0.1, 0.05),
        *(
            slowly(*gains, 0.1, reason="one gain alone, and errors that grow with time")
            for gains in ((10.0, 0.1), (10.0, 0.0), (0.0, 0.1))
        ),
    ],
)
def test_let_go_with_the_controllers_torque_as_loads_it_moves_as_under_control(
    kp: float, kd: float, until_s: float
) -> None:
    scene = with_gains(replace(SCENE, gravity_m_s2=(0.0, -9.81)), kp, kd)
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
        (Load("kick", "rocker", None, Pulse(0.1, 0.3)), "not go evenly on from turn to turn"),
        (Load("kick", "rocker", None, LONG), "not go evenly on from turn to turn"),
        (Load("controller-speed", "rocker", None, FourierSum(0.1, (), (), 1.0)),
         "controller-speed has the name"),
    ],
    ids=["a pulse", "another wave in each turn", "the name of the controller's"],
)  # fmt: skip
def test_a_load_that_the_controllers_torque_can_not_stand_beside_is_refused(
    load: Load, words: str
) -> None:
    with pytest.raises(CrankcheckError, match=words):
        released_under_control(replace(SCENE, loads={load.name: load}))


def test_what_is_told_is_not_taken_for_controlled() -> None:
    with pytest.raises(CrankcheckError, match="its driver is not controlled"):
        control_elastic(load_scene("fourbar-elastic"), 1.0)
    with pytest.raises(CrankcheckError, match="its driver is not controlled"):
        released_under_control(load_scene("fourbar-elastic"))
