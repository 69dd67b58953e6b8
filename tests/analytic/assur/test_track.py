"""One assembly of a triad followed along the driver, and its bounds against fifty digits; and
mechanisms that another joint than a crank's drives."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.assur.platform import solve_platform
from analytic.assur.step import AssurStep
from analytic.dyads.plane import BodyKinematics
from analytic.kinematics import reach, solve, solve_driven
from analytic.prepared import prepare
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import ReachError
from models.files.reading import load_scene, parse_scene
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from models.scene.moved import moved
from tests.analytic.assur.triad_scenes import KINDS, on_branch, triad
from tests.analytic.four_bars import fourbar
from tests.analytic.gradients.drawn import TRIAD, drawn
from tests.analytic.test_bounds import shares
from tests.worlds.tiers import few, slow, slowly

FEW_KINDS = [("RR", "PR", "RP"), ("PR", "RP", "PP")]
few_kinds = pytest.mark.parametrize(
    "kinds", few(KINDS, FEW_KINDS, "legs of each kind are among the few"), ids="-".join
)


def step_of(scene: Scene) -> AssurStep:
    step = prepare(scene, analyse(scene))[-1]
    assert isinstance(step, AssurStep)
    return step


@functools.cache
def as_drawn(kinds: tuple[str, str, str], seed: int) -> Scene:
    scene, angle = triad(kinds, seed)
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    found = [one.angle_rad for one in step_of(scene).assemblies(start, {})]
    apart = [abs(math.remainder(one - angle, math.tau)) for one in found]
    assert min(apart) < 1e-6, "the assembly that was drawn is one of all"
    return on_branch(scene, 1 + int(np.argmin(apart)))


@pytest.mark.parametrize(
    "seeds", [range(1), slowly(range(1, 40), reason="random triads, some near a limit")], ids=len
)
@few_kinds
def test_error_stays_below_the_bound_in_every_kind_of_triad(
    kinds: tuple[str, str, str], seeds: range
) -> None:
    for seed in seeds:
        try:
            found = shares(as_drawn(kinds, 7 * seed + 1), np.array([0.0, 3e-3]))
        except ReachError:
            continue  # it ends within a hundredth of a turn
        assert found.max() <= 1.0
        assert np.median(found[0]) > 1e-4, "a bound of ten thousand errors says little"


@slow("a second and a half; the hard case of a triad near its limit has bounds as well")
def test_beside_a_limit_position_bounds_are_infinite_and_beyond_it_two_assemblies_gone() -> None:
    scene = as_drawn(("RR", "RR", "RR"), 0)
    low, high = (end.theta for end in step_of(scene).track({}).ends)
    law = ConstantSpeed(0.5 * (low + high), 1.0)
    start = replace(scene.driver, law=law)
    beside = high - law.start_rad - np.array([1e-3, 1e-6, 1e-9, 1e-12])
    bounds = solve(replace(scene, driver=start), beside).bound.links
    for name, one in bounds.items():
        for level in (one.theta, one.omega, one.alpha):
            assert (level >= 0.0).all(), name  # which nan is not
    platform = bounds["platform"]
    assert np.isfinite(platform.alpha[:2]).all()
    assert platform.omega[2] > 1e3 * platform.omega[1] > 1e3 * platform.omega[0]
    step = step_of(triad(("RR", "RR", "RR"), 0, crank_m=0.6)[0])
    ends = step.track({}).ends
    assert all(end is not None and end.kind == "limit position" for end in ends)
    for end, way in zip(ends, (-1.0, 1.0), strict=True):
        counts = [len(step.assemblies(end.theta - way * off, {})) for off in (1e-9, -1e-9)]
        assert counts[0] == counts[1] + 2


@slow("a second; far frames are drawn for each kind of dyad in test_bounds.py")
def test_error_stays_below_the_bound_a_million_lengths_away() -> None:
    scene = moved(as_drawn(("PR", "RP", "PP"), 1), (1e6, -7e5))
    assert shares(scene, np.array([0.0, 3e-3])).max() <= 1.0


def followed(step: AssurStep, theta: Array) -> BodyKinematics:
    track = step.track({})
    rows = step.mounting.rows(step.before(theta, 0.0, {}))
    place, turn = track.guess(track.home(theta))
    solved = solve_platform(rows, place, turn, step.mounting.size_m, certified=True)
    assert solved.closed.all()
    return solved.body


def inside(step: AssurStep, count: int) -> Array:
    """Driver angles over the way of an assembly, not quite to its ends."""
    low, high = step.track({}).range
    margin = 1e-3 * (high - low)
    return np.linspace(low + margin, high - margin, count)


NARROW = "random triads, some with a narrow way"


@pytest.mark.parametrize("seeds", [range(1), slowly(range(1, 60), reason=NARROW)], ids=len)
@few_kinds
def test_what_is_followed_is_an_assembly_all_along_and_moves_at_its_rate(
    kinds: tuple[str, str, str], seeds: range
) -> None:
    for seed in seeds:
        step = step_of(triad(kinds, 3 + seed)[0])
        theta = inside(step, 9)
        body = followed(step, theta)
        turn = body.turn.x + 1j * body.turn.y
        place = body.anchor.p.x + 1j * body.anchor.p.y
        for k, at in enumerate(theta):
            every = step.assemblies(float(at), {})
            turned = [abs(np.angle(np.exp(1j * one.angle_rad) / turn[k])) for one in every]
            away = [abs(complex(*one.place) - place[k]) for one in every]
            assert min(map(sum, zip(turned, away, strict=True))) < 1e-7
        fine = inside(step, 4001)
        body = followed(step, fine)
        angle = np.unwrap(np.arctan2(body.turn.y, body.turn.x))
        rates = np.broadcast_to(body.omega, fine.shape)
        led = 0.5 * (rates[1:] + rates[:-1]) * np.diff(fine)
        gain = np.abs(np.diff(angle) - led)
        assert (gain <= 0.05 * np.abs(led) + 0.02).all()


LENGTHS = {"usual": (0.1, 0.25, 0.2, 0.3), "parallelogram": (0.1, 0.3, 0.1, 0.3)}
LENGTHS |= {"change point": (0.2, 0.35, 0.25, 0.3), "kite": (0.2, 0.2, 0.3, 0.3)}


def by_pin(lengths: tuple[float, float, float, float], start: float, branch: int = 1) -> Scene:
    driver, degrees = 'pin = "B", links = ["crank", "coupler"]', math.degrees(start)
    return fourbar(*lengths, branch, driver=driver, start_deg=degrees)


CYLINDER = """
name = "cylinder"
source = "test"
ground.points = { A = [0.0, 0.0], D = [0.5, -0.1] }
links.barrel.points = { A = [0.0, 0.02], F = [0.2, 0.0] }
links.rod.points = { E = [0.0, 0.0], C = [0.35, 0.01] }
links.lever.points = { D = [0.0, 0.0], C = [0.3, 0.0] }
sliders.S = { on = "barrel", link = "rod", point = "E", through_m = [0.1, 0.0], angle_deg = 4.0 }
[driver]
slider = "S"
law = "oscillating"
centre_m = 0.12
amplitude_m = 0.04
frequency_rad_s = 5.0
"""
PISTON = load_scene("slider-crank-by-piston")
LEANING = replace(PISTON.sliders["C"], direction_rad=math.radians(10.0), through_m=(0.0, 0.02))
SCENES = {
    "piston": replace(PISTON, sliders={"C": LEANING}),
    "cylinder": parse_scene(CYLINDER, "test"),
    "coupler pin": by_pin(LENGTHS["usual"], -1.0),
    "coupler pin, other side": by_pin(LENGTHS["usual"], -1.0, -1),
}


@pytest.mark.parametrize("name", few(SCENES, SCENES.keys() - {"cylinder"}, "half a second"))
def test_error_stays_below_the_bound(name: str) -> None:
    found = shares(SCENES[name], np.array([0.0, 0.37, 1.9, 17.0]))
    assert found.max() <= 1.0
    assert np.median(found[0]) > 1e-4


@pytest.mark.parametrize(
    ("name", "samples"),
    [
        ("usual", 61),
        slowly("kite", 61, reason="a second: through change points, which test_crossing.py has"),
        *(slowly(name, 601, reason="instants nearer to a change point") for name in LENGTHS),
    ],
)
def test_a_four_bar_driven_at_its_coupler_follows_the_one_driven_at_its_crank(
    name: str, samples: int
) -> None:
    """Over two turns, through change points where it has them."""
    lengths = LENGTHS[name]
    known = solve(fourbar(*lengths, start_deg=math.degrees(1.2)), np.linspace(0.0, 12.9, samples))
    crank, coupler = known.links["crank"], known.links["coupler"]
    relative = [getattr(coupler, q) - getattr(crank, q) for q in ("theta", "omega", "alpha")]
    found = solve_driven(by_pin(lengths, float(relative[0][0])), *relative)
    for link, own in known.links.items():
        twin = found.links[link]
        assert np.allclose(own.theta, twin.theta, rtol=0, atol=1e-11)
        assert np.allclose(own.omega, twin.omega, rtol=0, atol=1e-8)
        assert np.allclose(own.alpha, twin.alpha, rtol=0, atol=1e-6)
    if name != "usual":
        assert {crossing.dyad for crossing in found.crossings} == {"C"}
    assert all(np.isfinite(one.alpha).all() for one in found.bound.links.values())


def test_a_piston_stands_between_its_dead_points_alone() -> None:
    scene = load_scene("slider-crank-by-piston")
    _, ahead = reach(scene)
    assert ahead == pytest.approx((0.2, 0.4), abs=1e-12)
    with pytest.raises(ReachError, match=r"slider C at 0\.41 m: the loop cannot close at B"):
        solve_driven(scene, np.array([0.41]), np.ones(1), np.zeros(1))


@slow("seconds of following to draw one so near")
def test_a_start_next_to_its_end_is_followed_from_there() -> None:
    scene = drawn(TRIAD, np.random.default_rng(5), near=True)
    sine = solve(scene, np.zeros(1)).conditioning["platform"]
    assert 0.0 < float(sine[0]) < 1e-6
