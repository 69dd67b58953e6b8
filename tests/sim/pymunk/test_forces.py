"""The forces of pymunk's joints, and constant friction in them: the reference's, to the order of
its step, and pymunk's own.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from models.files.reading import load_scene
from models.scene import GROUND, Scene
from models.scene.characteristics import Constant, Sine
from models.scene.hard import double_parallelogram
from models.scene.loads import Load
from sim.engine import Drive, Run
from sim.engine.momentum_balance import MomentumGain, joint_pushes
from sim.engine.ties import Hinge
from sim.pymunk.engine import ENGINE
from sim.pymunk.spoiler import SPOILER
from sim.run import run
from tests.worlds.reported_forces import misses
from tests.worlds.runs import acted_on, opened, ran, rubbing, start_of

START = 4
"""The samples that the start takes: of the first there are no forces, in the next two the joints
make up for half a step, and in one more for what that has left of places."""


def of_a_turn(scene: Scene, steps: int, **given: object) -> Run:
    return ran(scene, ENGINE, per_turn=steps, with_forces=True, **given)


def errors(scene: Scene, steps: int) -> dict[str, float]:
    """The worst of a turn, after the start."""
    found = of_a_turn(scene, steps).motion.forces
    return {key: float(off[START:].max()) for key, off in misses(scene, found).items()}


def of_second_order(scene: Scene, most: float) -> None:
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
    of_second_order(load_scene(name), 5e-4)


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
    of_second_order(LOADED[where], 1e-3)


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
