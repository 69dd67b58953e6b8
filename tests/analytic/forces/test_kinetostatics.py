"""Driving torque and reactions of mechanisms that are worked out otherwise, with springs, redundant
links and dead points; and what is refused."""

import math
import random
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.force_elements import spring_lengths
from analytic.forces.kinetostatics import forces
from analytic.kinematics import chunks, reach, solve, solve_driven
from models.errors import CrankcheckError
from models.files.reading import load_scene, parse_scene, shipped
from models.motion import Motion
from models.scene import GROUND, Scene
from models.scene.characteristics import Constant, Polynomial
from models.scene.hard import WindowChain
from models.scene.loads import ConstantFriction, LineSpring, Load, PinSpring
from models.scene.tabulated import Tabulated
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.analytic.forces.beside import AGREED, agreed, apart, at, out_of_balance, series, turn
from tests.models.scene.test_loads import PRESS, RUBBING
from tests.worlds.loading import loaded, massless, rubbed_mechanism
from tests.worlds.mutation import MUTATIONS
from tests.worlds.tiers import slowly

CENTRAL = load_scene("slider-crank-central")
ROCKING = load_scene("fourbar-double-rocker")
LEVEL = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
"""Its bars come into one line at 0 deg."""


def test_forces_are_those_of_the_times_by_motion_by_chunk_and_without_bounds() -> None:
    scene = loaded(load_scene("sixbar-stephenson"), random.Random(3))
    time_s = turn(scene)
    by_time, of_motion = forces(scene, time_s), forces(scene, solve(scene, time_s))
    bare = forces(scene, time_s, bound=False)
    assert apart(by_time, of_motion) < 1e-14
    assert np.all(of_motion.bound.torque < 3.0 * by_time.bound.torque)
    assert np.all(by_time.bound.torque < 3.0 * of_motion.bound.torque)
    assert bare.bound is None
    rubbing, _ = rubbed_mechanism(4)
    times = np.linspace(0.0, 3.0, 30_000) * rubbing.driver.law.period_s
    some = slice(25_000, 25_010)
    whole, part = (
        forces(rubbing, each, bound=bound, skip_dead_points=True)
        for each, bound in ((times, False), (times[some], True))
    )
    for (name, a), (_, b) in zip(series(whole), series(part), strict=True):
        np.testing.assert_allclose(a[some], b, rtol=1e-13, err_msg=name)


HANGING = """
name = "hanging"
source = "test"
gravity_m_s2 = [0.0, -9.81]
ground = { points = { A = [0.0, 0.0] } }
links = { crank = { bar = ["A", "B"], length_m = 0.4, mass_kg = 3.0 } }
driver = { link = "crank", speed_rad_s = 1.0 }
"""


def test_forces_of_a_pin_add_up_to_nothing_and_hold_a_hanging_weight() -> None:
    """A crank that hangs: the pin holds m g - m omega^2 r up, the drive keeps it where it is."""
    scene = parse_scene(HANGING, "hanging")
    found = forces(scene, at(scene, -0.5 * math.pi, 0.0, speed=2.0))
    down, level = found.pins["A"]["crank"]
    assert down == pytest.approx([0.0, 3.0 * (9.81 + 4.0 * 0.2)], abs=1e-14)
    assert level == pytest.approx([-3.0 * 4.0 * 0.2, 3.0 * 9.81], abs=1e-14)
    assert found.torque == pytest.approx([0.0, 3.0 * 9.81 * 0.2], abs=1e-14)
    np.testing.assert_array_equal(found.pins["A"]["ground"], -found.pins["A"]["crank"])
    # Of three bodies too; the ground stands first: what it exerts on the link is the second.
    scene = WindowChain(2).scene()
    assert len(scene.pins["B1"]) == 3
    found = forces(scene, at(scene, 1.0, 0.3))
    largest = max(np.abs(force).max() for name, force in series(found) if name.startswith("pin"))
    for by_body in found.pins.values():
        assert np.abs(sum(by_body.values())).max() < 1e-14 * largest
    assert next(iter(found.pins["A0"])) == "ground"


def test_where_a_stroke_turns_the_bound_holds_the_whole_force() -> None:
    """Rounding may have the speed on either side of 0."""
    cut = Load("cut", "block C", "C", Constant(500.0), "time", "C", "forward")
    heavy = {"C": replace(CENTRAL.sliders["C"], mass_kg=1.0)}
    scene = replace(CENTRAL, loads={"cut": cut}, sliders=heavy)
    bound = forces(scene, at(scene, np.pi, 1.0)).bound.pins["C"]["block C"]
    assert bound[0] >= 500.0
    assert bound[1] < 1e-9


def test_a_spring_in_a_pin_is_wound_up_turn_by_turn() -> None:
    """On the crank it holds against 3 turns after 3 turns; between crank and coupler, which comes
    round as often as the rocker, against as many the other way."""
    scene = load_scene("fourbar-lecture-1")
    crank = PinSpring("own", 2.0, 0.0, math.radians(600.0), "A", (GROUND, "crank"))
    coupler = PinSpring("far", 2.0, 0.0, -1.0, "B", ("crank", "coupler"))
    scene = replace(scene, springs={"own": crank, "far": coupler})
    instants = np.array([0.0, 1.0, 3.0]) * scene.driver.law.period_s
    for _, chunk in chunks(scene, instants, bound=False):
        (_, q, _), (_, other, _) = spring_lengths(scene, chunk, counted=True)
    assert abs(q[0] - crank.free) <= math.pi
    assert q - q[0] == pytest.approx([0.0, math.tau, 3.0 * math.tau])
    assert abs(other[0] - coupler.free) <= math.pi
    assert other - other[0] == pytest.approx([0.0, -math.tau, -3.0 * math.tau])
    found, _ = agreed(scene, instants)
    given = forces(scene, solve_driven(scene, *scene.driver.law.at(instants), instants))
    assert apart(found, given) <= AGREED


def test_a_spring_without_a_free_length_may_come_to_nothing() -> None:
    """The crank's pin passes a point of the ground: nothing pulls there, and nothing is divided by
    the length."""
    plain = load_scene("fourbar-lecture-1")
    spring = LineSpring("own", 50.0, 0.0, 0.0, ("E", "B"))
    scene = replace(plain, ground={**plain.ground, "E": (0.0, 0.1)}, springs={"own": spring})
    assert scene.links["crank"].points["B"] == (0.1, 0.0)
    found = forces(scene, [0.0])  # the crank stands at 90 deg
    assert found.torque == pytest.approx(forces(plain, [0.0]).torque)
    assert found.bound.torque[0] < 1e-12


@pytest.mark.parametrize("number", range(2))
def test_redundant_links_leave_the_torque(number: int) -> None:
    """The balance of power holds for it, to rounding."""
    scene = parallelogram(2) if number % 2 else with_strut(parallelogram(1), "B0", "B1")
    scene = loaded(scene, random.Random(number))
    scene = replace(scene, loads={}, gravity_m_s2=(0.0, -9.81))
    time_s = np.linspace(0.0, 1.0, 9)
    found = forces(scene, time_s)
    assert not found.pins
    assert not found.sliders
    assert "redundant links" in found.undetermined
    assert "stiffness" in found.undetermined
    assert out_of_balance(scene, time_s, found) <= AGREED
    assert np.all(found.bound.torque < 1e-9 * np.abs(found.torque).max())


def test_a_dead_point_may_be_left_out_and_beside_it_nothing_is_certain() -> None:
    rubbing = replace(LEVEL, friction={"B1": ConstantFriction("B1", 1.0)})
    found = forces(rubbing, at(rubbing, 0.5, 0.0), skip_dead_points=True)
    for _, array in series(found):
        assert np.isnan(array).reshape(2, -1).all(axis=1).tolist() == [False, True]
    for bound in (
        found.bound.torque,
        found.bound.pins["B1"]["coupler"],
        found.bound.friction["B1"],
    ):
        assert np.isinf(bound).tolist() == [False, True]
    beside = forces(ROCKING, at(ROCKING, reach(ROCKING)[0][0] + 1e-14)).bound
    assert np.isinf(beside.torque).all()
    assert np.isinf(beside.pins["C"]["coupler"]).all()


STILL = massless(load_scene("fourbar-lecture-1"))
FAST = Load("pull", "rod", "B", Polynomial((0.0,) * 19 + (1e15,)))


@pytest.mark.parametrize(
    ("scene", "when", "words"),
    [
        (LEVEL, at(LEVEL, 0.5, 0.0), r"crank at 0 deg .* dead point: the dyad at B1"),
        (ROCKING, at(ROCKING, reach(ROCKING)[0][0]), r"driver at -65.3757 deg .* the dyad at C"),
        (replace(CENTRAL, loads={"pull": FAST}), np.array([1e20]),
         r"t = 1e\+20 s\): forces are larger than numbers go"),
        (STILL, [0.0], "no link or slider has a mass and nothing loads"),
    ],
)  # fmt: skip
def test_what_has_no_forces_is_told(scene: Scene, when: object, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        forces(scene, when)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda m: replace(m, points={}), "point A is not in it; solve it without a choice"),
        (lambda m: replace(m, sliders={}), "slider C is not in it"),
        (lambda m: replace(m, bound=None), "carries no bounds"),
        (
            lambda m: replace(m.each_series(lambda a: np.full_like(a, np.nan)), conditioning={}),
            "no acceleration of link crank",
        ),
    ],
)
def test_a_motion_that_lacks_something_is_refused(
    spoil: Callable[[Motion], Motion], words: str
) -> None:
    with pytest.raises(CrankcheckError, match=words):
        forces(CENTRAL, spoil(solve(CENTRAL, np.array([0.1, 0.2]))))


@pytest.mark.parametrize(
    ("load", "words"),
    [
        (Load("x", "door", "C", Constant(1.0)), r"loads.x.body: found door; use one of crank, rod"),
        (Load("x", "rod", "Q", Constant(1.0)), r"loads.x.point: found Q; use one of B, C"),
        (Load("x", "rod", "C", Constant(1.0), slider="Z", stroke="forward"),
         r"loads.x.slider: found Z; use one of C"),
        (Load("x", "rod", "C", Polynomial((1.0,)), "displacement"),
         r"loads.x.slider: found none; use one of C"),
        (Load("x", "rod", "C", Tabulated((0.0, 0.1), (1.0, 2.0)), "time"),
         r"loads.x: over the time \[s\] the table goes from 0 to 0.1, and 0.2 is requested"),
    ],
)  # fmt: skip
def test_a_load_that_is_not_there_is_refused(load: Load, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        forces(replace(CENTRAL, loads={"x": load}), [0.1, 0.2])


LOCKING = shipped("forces")["slider-crank-self-locking"].read_text()


@pytest.mark.parametrize("files", [40, slowly(600, reason="changes at random")])
@pytest.mark.parametrize("sound", [PRESS, RUBBING, LOCKING], ids=["loads", "friction", "locking"])
def test_a_changed_file_gives_forces_or_a_message(sound: str, files: int) -> None:
    """Warnings are errors here, so that no number overflows unseen either."""
    solved = refused = 0
    for number in range(files):
        rng, text = random.Random(number), sound
        for _ in range(rng.choice((1, 1, 2, 3))):
            text = rng.choices(list(MUTATIONS), list(MUTATIONS.values()))[0](rng, text)
        try:
            scene = parse_scene(text, "changed")
            time_s = np.linspace(0.01, 0.99, 5) * scene.driver.law.period_s
            assert not np.isnan(forces(scene, time_s, skip_dead_points=True).bound.torque).any()
            solved += 1
        except CrankcheckError:
            refused += 1
    assert min(solved, refused) > 0.2 * files, (solved, refused)
