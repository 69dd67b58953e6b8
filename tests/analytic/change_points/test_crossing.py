"""The smooth motion through change points, against closed forms and fifty digits."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from mpmath import mp, mpf

from analytic import prepared
from analytic.kinematics import reach, solve, solve_driven
from analytic.mechanism.cycle import travel
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.files.reading import parse_scene
from models.motion import Motion
from models.scene import Scene
from models.scene.hard import WindowChain
from models.scene.laws import FromRest, Law, Oscillating, SpeedChange
from tests.analytic import four_bars, oracle
from tests.analytic.chain import law_at
from tests.analytic.change_points import jets
from tests.analytic.change_points.jets import Jet
from tests.analytic.test_bounds import errors, over
from tests.worlds.tiers import slow, slowly

Lengths = tuple[float, float, float, float]
OFF = 1e-30
"""What the driver of the oracle is off by where it would be in a change point itself [rad]."""
Exact = Mapping[str, Jet]
"""Links by name, sliders by "s NAME", in fifty digits."""

fourbar = partial(four_bars.fourbar, start_deg=60.0, speed=1.5)
SLIDER_CRANK = """
name = "isosceles"
source = "test"
ground.points = {{ A = [0.0, 0.0] }}
links.crank = {{ bar = ["A", "B"], length_m = 0.1 }}
links.rod = {{ bar = ["B", "C"], length_m = {rod!r} }}
sliders.C.on = "ground"
driver = {{ link = "crank", speed_rad_s = 1.5 }}
"""
LEVER = """
name = "lever"
source = "test"
ground.points = {{ A = [0.0, {pivot!r}], C = [0.0, 0.0] }}
links.crank = {{ bar = ["A", "B"], length_m = 0.1 }}
links.lever = {{ bar = ["C", "E"], length_m = 0.35 }}
links.rod = {{ bar = ["E", "F"], length_m = 0.6 }}
sliders.B.on = "lever"
sliders.F = {{ on = "ground", through_m = [0.0, 0.15] }}
driver = {{ link = "crank", speed_rad_s = 1.5 }}
"""
LOCOMOTIVE = """
name = "locomotive"
source = "test"
ground.points = { A = [0.0, 0.0], D = [0.3, 0.0], G = [0.7, 0.0], H = [0.0, 0.05] }
links.crank = { bar = ["A", "B"], length_m = 0.1 }
links.coupler = { bar = ["B", "C"], length_m = 0.3 }
links.rocker = { bar = ["D", "C"], length_m = 0.1 }
links.second = { bar = ["C", "F"], length_m = 0.4 }
links.third = { bar = ["G", "F"], length_m = 0.1 }
links.rod = { bar = ["F", "P"], length_m = 0.5 }
sliders.P = { on = "ground", through_m = [0.0, 0.02] }
driver = { link = "crank", speed_rad_s = 1.5, start_deg = 60.0 }
"""


def beside(angles: Sequence[float], turns: int) -> Array:
    """Driver angles in and next to the given ones, and anywhere, over some turns."""
    off = [0.0, *(s * 10.0**-k for k in (1, 2, 3, 5, 8, 11, 15) for s in (-3.0, 1.0))]
    near = [a + math.tau * k + x for a in angles for k in range(-1, turns) for x in off]
    anywhere = np.random.default_rng(1).uniform(-math.tau, turns * math.tau, 50)
    return np.sort(np.concatenate([near, anywhere]))


def shares(motion: Motion, exact: Callable[[int], Exact]) -> Array:
    """Errors over bounds, (samples, links and sliders, levels); 0 / 0 is 0."""
    rows = []
    for i in range(len(motion.time_s)):
        row = []
        for name, jet in exact(i).items():
            where, key = ("sliders", name[2:]) if name.startswith("s ") else ("links", name)
            found, limit = (vars(getattr(m, where)[key]) for m in (motion, motion.bound))
            off = errors(jet, found, i, turning=where == "links", nothing=OFF)
            row.append(over(off, limit, i))
        rows.append(row)
    return np.array(rows)


def assert_below(motion: Motion, most: float) -> None:
    for one, limit in ((motion, math.inf), (motion.bound, most)):
        tracks = [*one.links.values(), *one.points.values(), *one.sliders.values()]
        arrays = [array for track in tracks for array in vars(track).values()]
        assert all((np.abs(array) < limit).all() for array in arrays)


def held(motion: Motion, exact: Callable[[int], Exact], most: float) -> None:
    assert shares(motion, exact).max() <= 1.0
    assert_below(motion, most)


def driven(scene: Scene, theta: Array) -> Motion:
    return solve_driven(scene, theta, np.full(1, 1.3), np.full(1, -0.7))


def crossed(start: jets.Number, theta: jets.Number, angles: Sequence[float]) -> int:
    """How many of the angles, which repeat every turn, lie between two driver angles.

    The angles are whole half turns, exactly: the float next to pi is below it.
    """
    low, high = sorted((mpf(start), mpf(theta)))
    turns = 0
    for angle in angles:
        half = mpf(round(angle / math.pi)) / 2
        turns += mp.floor(high / (2 * mp.pi) - half) - mp.floor(low / (2 * mp.pi) - half)
    return int(turns)


def exact_fourbar(
    scene: Scene, lengths: Sequence[float], angles: Sequence[float], drive: Callable[[int], Jet]
) -> Callable[[int], Exact]:
    """Coupler and rocker, the driver off by `OFF`."""
    crank, coupler, rocker, ground = lengths
    start = float(scene.driver.law.at(np.zeros(1))[0][0])

    def at(i: int) -> Exact:
        with mp.workdps(200):  # of which an angle of 1e-30 takes 90, twice differentiated
            theta = drive(i) + mpf(OFF)
            sign = (-1) ** crossed(start, theta.value, angles) * scene.branch["C"]
            p1 = oracle.toward(theta).times(mpf(crank))
            first, second = oracle.rrr(p1, oracle.at(ground, 0), coupler, rocker, sign)
            return {"coupler": first, "rocker": second}

    return at


def at_angles(theta: Array) -> Callable[[int], Jet]:
    return lambda i: Jet(float(theta[i]), 1.3, -0.7)


def follows(lengths: Lengths, branch: int, theta: Array, angles: list[float], most: float) -> None:
    scene = fourbar(*lengths, branch)
    motion = driven(scene, theta)
    held(motion, exact_fourbar(scene, lengths, angles, at_angles(theta)), most)
    assert len(motion.crossings) == len(angles)


@pytest.mark.parametrize("lengths", [(0.1, 0.3), (0.3, 0.1), (1e4, 3e4)])
def test_a_parallelogram_stays_one(lengths: tuple[float, float]) -> None:
    crank, coupler = lengths
    theta = beside([0.0, math.pi], 10)
    motion = driven(fourbar(crank, coupler, crank, coupler), theta)
    drive, most = at_angles(theta), 1e-8 * max(1.0, coupler)
    held(motion, lambda i: {"coupler": Jet(0), "rocker": drive(i)}, most)
    assert np.abs(motion.links["rocker"].alpha + 0.7).max() < 1e-11
    passed = [(c.dyad, round(math.degrees(c.driver_rad), 6)) for c in motion.crossings]
    assert passed == [("C", 0.0), ("C", 180.0)]
    assert motion.conditioning["C"].min() < 1e-12


@pytest.mark.parametrize(
    ("lengths", "branch", "angles"),
    [
        ((0.125, 0.375, 0.375, 0.125), 1, [0.0]),
        slowly((0.125, 0.375, 0.375, 0.125), -1, [0.0], reason="as the other branch"),
        ((0.375, 0.125, 0.375, 0.125), 1, [0.0, math.pi]),
        slowly((0.375, 0.125, 0.375, 0.125), -1, [0.0, math.pi], reason="as the other branch"),
        ((0.125, 0.125, 0.375, 0.375), 1, [0.0, math.pi]),
        ((0.25, 0.5, 1.0, 0.75), 1, [0.0]),
        slowly((0.5, 0.625, 1.5, 1.625), 1, [math.pi], reason="as flat at 0"),
    ],
)
def test_fourbars_that_fold_flat_follow_the_smooth_branch(
    lengths: Lengths, branch: int, angles: list[float]
) -> None:
    follows(lengths, branch, beside([0.0, math.pi], 4)[::2], angles, 1e-6)


@pytest.mark.parametrize("branch", [1, -1])
def test_an_isosceles_slider_crank_has_a_stroke_of_four_cranks(branch: int) -> None:
    scene = replace(parse_scene(SLIDER_CRANK.format(rod=0.1), "test"), branch={"C": branch})
    theta = beside([0.0, math.pi / 2, math.pi, -math.pi / 2], 2)
    motion = driven(scene, theta)
    drive = at_angles(theta)

    def exact(i: int) -> Exact:
        if branch > 0:
            return {"s C": jets.cos(drive(i)) * (2 * mpf(0.1)), "rod": -drive(i)}
        return {"s C": Jet(0), "rod": drive(i) + mp.pi}

    held(motion, exact, 1e-8)
    if branch > 0:
        assert np.ptp(motion.sliders["C"].displacement) == pytest.approx(0.4, abs=1e-13)


@pytest.mark.parametrize("pivot", [0.1, -0.1])
def test_a_lever_about_a_pin_that_the_crank_passes_turns_at_half_its_speed(pivot: float) -> None:
    """Also the rod that hangs on it, which takes two turns of the crank to be back."""
    scene = parse_scene(LEVER.format(pivot=pivot), "test")
    theta = beside([-math.copysign(math.pi / 2, pivot)], 4)
    motion = driven(scene, theta)
    drive = at_angles(theta)
    quarter = mp.pi / 4 if pivot > 0 else -mp.pi / 4

    def exact(i: int) -> Exact:
        lever = drive(i) / 2 + quarter
        end = oracle.toward(lever).times(mpf(0.35))
        rod, s = oracle.rrp(end, oracle.Line(oracle.at(0, mpf(0.15)), Jet(0)), mpf(0.6), 1)
        block = jets.cos(drive(i) / 2 - quarter) * (2 * mpf(0.1))
        return {"lever": lever, "s B": block, "rod": rod, "s F": s}

    held(motion, exact, 1e-8)
    assert [c.dyad for c in motion.crossings] == ["B"]


def test_dyads_that_hang_on_each_other_pass_their_change_points_together() -> None:
    """Two parallelograms in a row are flat at the same angles; a slider hangs on the second."""
    theta = beside([0.0, math.pi], 3)
    motion = driven(parse_scene(LOCOMOTIVE, "test"), theta)
    drive = at_angles(theta)

    def exact(i: int) -> Exact:
        pin = oracle.toward(drive(i)).times(mpf(0.1)) + oracle.at(mpf(0.7), 0)
        line = oracle.Line(oracle.at(0, mpf(0.02)), Jet(0))
        rod, s = oracle.rrp(pin, line, mpf(0.5), 1)
        wheels = {"rocker": drive(i), "third": drive(i), "coupler": Jet(0), "second": Jet(0)}
        return {**wheels, "rod": rod, "s P": s}

    held(motion, exact, 1e-7)
    assert sorted({c.dyad for c in motion.crossings}) == ["C", "F"]


LAWS = [FromRest(0.0, -5.0, 2.0), Oscillating(math.pi - 0.5, 0.5, 3.0, -1.0)]
LAWS += [Oscillating(0.0, 4.0, 1.0, 0.3)]


@pytest.mark.parametrize("law", LAWS)
def test_laws_that_start_stop_and_turn_back_in_a_change_point(law: Law) -> None:
    lengths = (0.375, 0.125, 0.375, 0.125)
    scene = fourbar(*lengths)
    scene = replace(scene, driver=replace(scene.driver, law=law))
    time_s = np.sort(np.concatenate([np.linspace(0.0, 4.0, 101), [math.pi / 6, math.pi / 3]]))
    motion = solve(scene, time_s)
    start, soon = law.at(np.array([0.0, 1e-2]))[0]
    ahead = (-1) ** crossed(start, start + 1e-9 * np.sign(soon - start), [0.0, math.pi])
    scene = replace(scene, branch={"C": ahead})  # which the oracle takes as that of the start
    exact = exact_fourbar(scene, lengths, [0.0, math.pi], lambda i: law_at(law, float(time_s[i])))
    held(motion, exact, 1e-6)


@pytest.mark.parametrize(("rest_s", "speed"), [(0.1, 10.0), (0.63, -10.0), (1e6, 10.0)])
def test_a_law_that_rests_in_a_change_point_starts_on_the_branch_that_it_goes_to(
    rest_s: float, speed: float
) -> None:
    """However long it rests: for more than a period, too."""
    lengths = (0.1, 0.3, 0.1, 0.3)
    scene = fourbar(*lengths)
    law = SpeedChange(0.0, 0.0, speed, rest_s, 0.0)
    resting = replace(scene, driver=replace(scene.driver, law=law))
    found = solve(resting, np.array([0.0, rest_s + 0.1])).links["coupler"].theta[1]
    # The branch is stated just beside the change point, so the oracle passes none.
    exact = exact_fourbar(scene, lengths, [], at_angles(np.array([math.copysign(1.0, speed)])))
    assert found == pytest.approx(float(exact(0)["coupler"].value), abs=1e-8)


@slow("two seconds: the longest chains")
def test_a_chain_of_windows_is_followed_through_flat_up_to_six() -> None:
    theta = np.array([1.5, 0.5, 0.0, -0.5])
    motion = driven(WindowChain(6).scene(), theta)
    assert np.allclose(motion.links["rocker6"].theta, theta, rtol=0, atol=1e-9)
    with pytest.raises(CrankcheckError, match=r"B7 is in a change point whose smooth motion"):
        driven(WindowChain(7).scene(), theta)
    with pytest.raises(CrankcheckError, match=r"B8 is singular .*: change a length$"):
        driven(WindowChain(8).scene(), np.array([1.5]))


@pytest.mark.parametrize(("power", "sign"),
    [(7, 1), (12, -1),
     *(slowly(*at, reason="nearer, farther, or to the other side")
       for at in ((2, 1), (12, 1), (2, -1), (7, -1)))],
)  # fmt: skip
def test_near_is_not_in_a_change_point(power: int, sign: int) -> None:
    """The four-bar that all but folds flat keeps its branch; so does one that cannot fold."""
    lengths = (0.1 + sign * 10.0**-power, 0.3, 0.1, 0.3)
    theta = beside([0.0, math.pi], 2)
    if sign > 0:  # too long to be straight
        low, high = reach(fourbar(*lengths))[-1]
        with pytest.raises(ReachError, match="cannot close at C"):
            driven(fourbar(*lengths), np.array([math.pi]))
        theta = theta[(theta > low) & (theta < high)]
    follows(lengths, 1, theta, [], math.inf)


@pytest.mark.parametrize("power", [2, 7, 12])
def test_a_rod_that_is_longer_by_little_keeps_its_side(power: int) -> None:
    rod = 0.1 * (1.0 + 10.0**-power)
    theta = beside([math.pi / 2], 2)
    motion = driven(parse_scene(SLIDER_CRANK.format(rod=rod), "test"), theta)
    drive = at_angles(theta)

    def exact(i: int) -> Exact:
        pin = oracle.toward(drive(i)).times(mpf(0.1))
        angle, s = oracle.rrp(pin, oracle.Line(oracle.at(0, 0), Jet(0)), mpf(rod), 1)
        return {"rod": angle, "s C": s}

    assert motion.crossings == ()
    held(motion, exact, math.inf)


def test_what_is_passed_and_what_cannot_be_continued_is_told_and_only_there() -> None:
    scene = fourbar(0.1, 0.3, 0.1, 0.3)  # stands at 60 deg at time 0
    ways = [driven(scene, np.radians([to])).crossings for to in (60.0, 179.0, 180.0, -1.0, 400.0)]
    degrees = [tuple(round(math.degrees(c.driver_rad)) for c in each) for each in ways]
    assert set(degrees) == {(), (180,), (0,), (0, 180)}
    # All but a rhombus, contrary: its rocker overtakes the crank a thousand times as fast.
    scene = fourbar(1.0, 1.0 + 2**-10, 1.0, 1.0 + 2**-10, -1)
    with pytest.raises(CrankcheckError, match=r"four-bar: at crank 0 deg the dyad of C is in a"):
        driven(scene, np.array([1.0, 0.0]))
    assert_below(driven(scene, np.array([1.0, math.pi])), 1e-6)


def test_motion_through_change_points_does_not_depend_on_chunks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = parse_scene(LEVER.format(pivot=0.1), "test")
    time_s = np.linspace(0.0, 5 * scene.driver.law.period_s, 1001)
    whole = solve(scene, time_s)
    monkeypatch.setattr(prepared, "CHUNK", 97)
    parts = solve(scene, time_s)
    assert whole.crossings == parts.crossings
    for name, link in whole.links.items():
        assert np.allclose(link.theta, parts.links[name].theta, rtol=0, atol=1e-11)
        assert np.abs(np.diff(link.theta)).max() < 0.1


def test_travel_over_the_turns_after_which_a_mechanism_repeats() -> None:
    """The stroke of 4 R; and a ram that a lever, once around in two turns, takes along."""
    isosceles = travel(parse_scene(SLIDER_CRANK.format(rod=0.1), "test"), "C")
    assert isosceles.stroke == pytest.approx(0.4, abs=1e-13)
    assert isosceles.time_ratio == pytest.approx(1.0, abs=1e-9)
    ram = travel(parse_scene(LEVER.format(pivot=0.1), "test"), "F")
    assert ram.period_rad == pytest.approx(2 * math.tau)
    ends = math.sqrt(0.95**2 - 0.15**2), math.sqrt(0.25**2 - 0.15**2)
    assert ram.stroke == pytest.approx(ends[0] - ends[1], abs=1e-12)
