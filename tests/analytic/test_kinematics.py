"""How the reference treats samples, chunks, memory and nearly singular positions; and a mechanism
that is turned, moved, mirrored, scaled or sped up moves as it did before."""

import math
import tracemalloc
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from analytic import prepared
from analytic.dyads.plane import EPS
from analytic.kinematics import nearness, reach, solve, solve_driven
from analytic.structure.mobility import sides_of
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.files.reading import load_scene, parse_scene, shipped
from models.motion import Motion
from models.scene import Scene
from models.scene import moved as transform
from models.scene.moved import mirrored
from tests.worlds.other_way import sped_up
from tests.worlds.strategies import FORMS, Designed, examples, mechanisms, swing_times
from tests.worlds.tiers import slowly


@pytest.mark.parametrize(
    ("name", "turns"), [("whitworth", 3), ("fourbar-double-crank", 3), ("fourbar-crossed", 0)]
)
def test_angles_are_continuous(name: str, turns: int) -> None:
    """Over three turns of the driver, more samples than a chunk; whole turns are counted."""
    scene = load_scene(name)
    count = 2 * prepared.CHUNK + 77
    motion = solve(scene, np.linspace(0.0, 3 * scene.driver.law.period_s, count), bound=False)
    output = list(motion.links.values())[-1]
    assert np.abs(np.diff(output.theta)).max() < 0.01
    assert output.theta[-1] - output.theta[0] == pytest.approx(turns * math.tau, abs=1e-11)


@pytest.mark.parametrize("name", ["shaper", "tangent", "fourbar-double-crank"])
def test_motion_does_not_depend_on_chunks(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene(name)
    time_s = np.linspace(0.0, 2.5 * scene.driver.law.period_s, 1001)
    whole = solve(scene, time_s)
    monkeypatch.setattr(prepared, "CHUNK", 97)
    parts = solve(scene, time_s)
    for link, m in whole.links.items():
        twins = (m, parts.links[link], whole.bound.links[link])
        for a, b, bound in zip(*(vars(one).values() for one in twins), strict=True):
            assert np.all(np.abs(a - b) <= bound)
    for key, sine in whole.conditioning.items():
        assert np.allclose(sine, parts.conditioning[key], rtol=0, atol=1e-14)


@pytest.mark.parametrize("bound", [False, True])
def test_memory_stays_below_twice_the_arrays_returned(bound: bool) -> None:
    scene = load_scene("fourbar-lecture-1")
    time_s = np.linspace(0.0, 10.0, 100_000)
    solve(scene, time_s[:10], bound=bound)
    tracemalloc.start()
    try:
        motion = solve(scene, time_s, bound=bound)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    kept = [motion.links, motion.points, motion.sliders]
    kept += [motion.bound.links, motion.bound.points] if bound else []
    arrays = [a for kind in kept for track in kind.values() for a in vars(track).values()]
    assert peak < 2.0 * sum(a.nbytes for a in (*arrays, *motion.conditioning.values()))


def test_only_what_is_asked_for_is_returned() -> None:
    scene, time_s = load_scene("shaper"), np.linspace(0.0, 0.1, 5)
    motion = solve(scene, time_s, links=("rod",), points=("F",), sliders=())
    assert (set(motion.links), set(motion.points), set(motion.sliders)) == ({"rod"}, {"F"}, set())
    assert np.array_equal(motion.links["rod"].alpha, solve(scene, time_s).links["rod"].alpha)
    said = r"link 'ram' is not in the scene; it has crank, lever, rod"
    with pytest.raises(CrankcheckError, match=said):
        solve(scene, time_s, links=("ram",))


@pytest.mark.parametrize(
    ("samples", "said"),
    [
        ([0.0, math.nan, 1.0], "sample 1 is nan"),
        ([0.0, 0.5, -math.inf], "sample 2 is -inf"),
        ([math.inf, -math.inf], "sample 0 is inf"),
        ([], "at least one"),
        ([[0.0, 1.0]], "one dimension"),
    ],
)
def test_bad_samples_are_refused(samples: list[float], said: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    with pytest.raises(CrankcheckError, match=said):
        solve(scene, np.array(samples))
    with pytest.raises(CrankcheckError, match=said):
        solve_driven(scene, np.array(samples), np.ones(1), np.zeros(1))


def test_rates_in_toggle_are_uncertain_and_silent() -> None:
    """At both ends of the range: positions are known, rates not; no warning. Beyond is an error."""
    scene = load_scene("fourbar-double-rocker")
    ends = np.array(reach(scene)[-1])
    motion = solve_driven(scene, ends, np.ones(2), np.zeros(2))
    with pytest.raises(ReachError, match="fourbar-double-rocker: driver at 90 deg"):
        solve_driven(scene, np.array([math.pi / 2]), np.ones(1), np.zeros(1))
    for name in ("coupler", "rocker"):
        assert (motion.bound.links[name].theta < 1e-6).all()
        assert np.isinf(motion.bound.links[name].omega).all()
    assert (motion.conditioning["C"] < 1e-6).all()


HANGING = """
name = "hanging"
source = "test"
ground.points = { A = [0.0, 0.0], D = [0.3, 0.0], G = [0.6, 0.1] }
links.crank = { bar = ["A", "B"], length_m = 0.1 }
links.coupler = { bar = ["B", "C"], length_m = 0.3 }
links.rocker = { bar = ["D", "C"], length_m = 0.08, points = { E = [0.05, 0.05] } }
links.rod = { bar = ["E", "F"], length_m = 0.3 }
links.lever = { bar = ["G", "F"], length_m = 0.2 }
driver = { link = "crank", speed_rad_s = 1.0 }
"""


def test_what_hangs_on_a_link_in_toggle_is_uncertain_and_silent() -> None:
    scene = parse_scene(HANGING, "test")
    low, high = reach(scene)[-1]
    motion = solve(scene, np.array([low, 0.5 * (low + high), high]))
    for track in (*motion.bound.links.values(), *motion.bound.points.values()):
        assert not any(np.isnan(array).any() for array in vars(track).values())
    for name in ("coupler", "rocker", "rod", "lever"):
        assert np.isinf(motion.bound.links[name].omega).tolist() == [True, False, True]


@pytest.mark.parametrize("count", [5, slowly(15, reason="random mechanisms")])
@pytest.mark.parametrize("form", [form for form in FORMS if form[:3] in ("RRP", "RPR")])
def test_branch_of_a_slider_is_the_way_along_its_line(form: str, count: int) -> None:
    """Of the two assemblies, +1 is the one with the greater displacement, in every role."""

    @examples(count)
    @given(mechanisms([form]))
    def hold(designed: Designed) -> None:
        (name,) = designed.scene.sliders
        sides = [replace(designed.scene, branch={name: side}) for side in (1, -1)]
        ahead, behind = (solve(side, np.zeros(1)).sliders[name].displacement for side in sides)
        assert ahead[0] > behind[0]

    hold()


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "fourbar-crossed", "sixbar-watt"])
def test_branch_of_a_pin_is_its_side_of_the_outer_pins(name: str) -> None:
    """+1: to the left of the line from the first outer pin to the second, links as in the file."""
    scene = load_scene(name)
    motion = solve(scene, np.linspace(0.0, 1.0, 50))
    b, c, d = (motion.points[p].position @ (1.0, 1j) for p in "BCD")
    assert np.all(np.sign(((c - b) / (d - b)).imag) == scene.branch["C"])


TURN = np.linspace(0.0, math.tau, 721)


def turned(scene: Scene, theta: Array = TURN) -> Motion:
    return solve_driven(scene, theta, np.ones(1), np.zeros(1), bound=False)


@pytest.mark.parametrize("short", [2.0, 0.1, 1e-3, 1e-6, 0.0])
def test_a_block_that_comes_near_to_the_pivot_of_its_lever_is_near(short: float) -> None:
    """As near as ``short`` times the crank; the least distance of the two over the largest, at the
    crank's lower end."""
    ground = {"A": (0.0, 0.1 * (1.0 + short)), "C": (0.0, 0.0)}
    scene = replace(load_scene("slotted-lever"), ground=ground)
    theta = np.sort(np.append(TURN, -0.5 * math.pi))
    motion = turned(scene, theta)
    found = nearness(scene, motion)["B"]
    assert (motion.conditioning["B"] == 1.0).all()
    assert found.min() == pytest.approx(short / (2.0 + short), abs=1e-15)
    assert math.sin(theta[np.argmin(found)]) == pytest.approx(-1.0, abs=1e-9)
    assert found.max() == 1.0


@pytest.mark.parametrize("name", ["slotted-lever", "shaper"])
def test_ordinary_levers_are_as_far_as_their_blocks_stay(name: str) -> None:
    scene = load_scene(name)
    assert nearness(scene, turned(scene))["B"].min() == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize("name", [n for n in shipped() if n.startswith(("slider", "fourbar-lec"))])
def test_of_other_dyads_it_is_the_sine(name: str) -> None:
    scene = load_scene(name)
    motion = turned(scene)
    found = nearness(scene, motion)
    assert found.keys() == motion.conditioning.keys()
    assert all((found[key] == motion.conditioning[key]).all() for key in found)


def _assert_same(
    old: Motion, new: Motion, turn: float, grow: float, fast: float, flip: bool
) -> None:
    """Motion ``new`` is ``old`` turned, grown, sped up, and mirrored in the x-axis."""
    side, way = (-1.0 if flip else 1.0), np.exp(1j * turn)
    for kind in ("links", "sliders", "points"):
        for name in getattr(old, kind):
            motions = (old, new, old.bound, new.bound)
            tracks = (vars(getattr(one, kind)[name]).values() for one in motions)
            for level, (was, now, b0, b1) in enumerate(zip(*tracks, strict=True)):
                factor = fast**level * (1.0 if kind == "links" else grow)
                limit = 2.0 * (factor * b0 + b1)  # the changed scene has other roundings
                if kind == "points":
                    limit += 8 * EPS * grow * np.hypot(*was.T)
                    apart = now @ (1.0, 1j) - factor * way * (was @ (1.0, side * 1j))
                else:
                    apart = now - factor * was * (side if kind == "links" else 1.0)
                if (kind, level) == ("links", 0):
                    apart -= turn + math.tau * np.round((apart - turn) / math.tau)
                assert np.all(np.abs(apart) <= limit)


CHANGES: dict[str, tuple[Callable[[Scene], Scene], tuple[float, float, float, bool]]] = {
    "turned": (lambda s: transform.rotated(s, 0.7), (0.7, 1.0, 1.0, False)),
    "mirrored": (lambda scene: mirrored(scene, sides_of(scene)), (0.0, 1.0, 1.0, True)),
    "larger": (lambda s: transform.scaled(s, 10.0), (0.0, 10.0, 1.0, False)),
    "smaller": (lambda s: transform.scaled(s, 0.1), (0.0, 0.1, 1.0, False)),
    "faster": (lambda s: sped_up(s, 50.0), (0.0, 1.0, 50.0, False)),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", shipped())
def test_motion_does_not_depend_on_place_size_speed_or_hand(name: str, change: str) -> None:
    scene, time_s = load_scene(name), swing_times(load_scene(name), 50)
    changed, (turn, grow, fast, flip) = CHANGES[change][0](scene), CHANGES[change][1]
    _assert_same(solve(scene, time_s), solve(changed, time_s / fast), turn, grow, fast, flip)


@pytest.mark.parametrize("name", shipped())
def test_motion_moves_with_the_scene(name: str) -> None:
    scene, time_s = load_scene(name), swing_times(load_scene(name), 50)
    old, new = solve(scene, time_s), solve(transform.moved(scene, (3.0, -2.0)), time_s)
    for point, was in old.points.items():
        apart = new.points[point].position - was.position - np.array([3.0, -2.0])
        bounds = old.bound.points[point].position + new.bound.points[point].position
        assert np.all(np.hypot(*apart.T) <= 2.0 * bounds + 8 * EPS * 3.0)
    for link, m in old.links.items():
        limit = 2.0 * (old.bound.links[link].alpha + new.bound.links[link].alpha)
        assert np.all(np.abs(new.links[link].alpha - m.alpha) <= limit + 8 * EPS * 3.0 * 1e4)


def test_backwards_drive_runs_through_the_same_positions() -> None:
    scene = load_scene("shaper")
    law = scene.driver.law
    reverse = replace(law, speed_rad_s=-law.speed_rad_s)
    back = replace(scene, driver=replace(scene.driver, law=reverse))
    time_s = np.linspace(0.0, 1.0, 77)
    ahead, behind = solve(scene, -time_s[::-1]), solve(back, time_s)
    for name, m in behind.links.items():
        assert np.allclose(m.omega, -ahead.links[name].omega[::-1], rtol=0, atol=1e-11)
        assert np.allclose(m.alpha, ahead.links[name].alpha[::-1], rtol=0, atol=1e-9)
