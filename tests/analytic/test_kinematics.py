"""How the reference treats samples, chunks, memory and nearly singular positions; and a mechanism
that is turned, moved, mirrored, scaled or sped up moves as it did before."""

import math
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from analytic.kinematics import nearness, reach, solve, solve_driven
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.files.reading import load_scene, parse_scene
from models.motion import Motion
from models.scene import Scene
from tests.worlds.strategies import FORMS, Designed, examples, mechanisms
from tests.worlds.tiers import few


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


def test_rates_in_toggle_and_of_what_hangs_on_it_are_uncertain_and_silent() -> None:
    """At both ends of the range: positions are known, rates not; no warning. Beyond is an error."""
    scene = parse_scene(HANGING, "test")
    low, high = reach(scene)[-1]
    motion = solve(scene, np.array([low, 0.5 * (low + high), high]))
    for track in (*motion.bound.links.values(), *motion.bound.points.values()):
        assert not any(np.isnan(array).any() for array in vars(track).values())
    for name in ("coupler", "rocker", "rod", "lever"):
        assert np.isinf(motion.bound.links[name].omega).tolist() == [True, False, True]
    assert (motion.bound.links["rocker"].theta < 1e-6).all()
    assert (motion.conditioning["C"] < 1e-6).tolist() == [True, False, True]
    with pytest.raises(ReachError, match=r"hanging: crank at .* cannot close at C"):
        solve_driven(scene, np.array([high + 0.1]), np.ones(1), np.zeros(1))


OF_SLIDERS = [form for form in FORMS if form[:3] in ("RRP", "RPR")]


@pytest.mark.parametrize("form", few(OF_SLIDERS, OF_SLIDERS[::3], "other ends of a slider"))
def test_branch_of_a_slider_is_the_way_along_its_line(form: str) -> None:
    """Of the two assemblies, +1 is the one with the greater displacement, in every role."""

    @examples(4)
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


@pytest.mark.parametrize("short", [2.0, 1e-6, 0.0])
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
    whole = load_scene("slider-crank-offset")  # of other dyads it is the sine
    motion = turned(whole)
    assert np.array_equal(nearness(whole, motion)["C"], motion.conditioning["C"])
