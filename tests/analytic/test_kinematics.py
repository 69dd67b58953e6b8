"""How the reference treats samples, chunks, memory, and positions that are singular."""

from __future__ import annotations

import math
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from analytic import prepared
from analytic.kinematics import reach, solve, solve_driven
from models.errors import CrankcheckError, ReachError
from models.files import load_scene, parse_scene
from tests.worlds.strategies import FORMS, Designed, examples, mechanisms
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
        for a, b, bound in zip(
            vars(m).values(),
            vars(parts.links[link]).values(),
            vars(whole.bound.links[link]).values(),
            strict=True,
        ):
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
    arrays = [
        a
        for k in (motion.links, motion.points, motion.sliders)
        for m in k.values()
        for a in vars(m).values()
    ]
    arrays += motion.conditioning.values()
    if motion.bound is not None:
        tracks = [*motion.bound.links.values(), *motion.bound.points.values()]
        arrays += [a for m in tracks for a in vars(m).values()]
    assert peak < 2.0 * sum(a.nbytes for a in arrays)


def test_only_what_is_asked_for_is_returned() -> None:
    scene, time_s = load_scene("shaper"), np.linspace(0.0, 0.1, 5)
    motion = solve(scene, time_s, links=("rod",), points=("F",), sliders=())
    assert (set(motion.links), set(motion.points), set(motion.sliders)) == ({"rod"}, {"F"}, set())
    assert np.array_equal(motion.links["rod"].alpha, solve(scene, time_s).links["rod"].alpha)
    with pytest.raises(
        CrankcheckError, match=r"link 'ram' is not in the scene; it has crank, lever, rod"
    ):
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
    """At both ends of the reachable range: positions are known, rates are not; no warning."""
    scene = load_scene("fourbar-double-rocker")
    ends = np.array(reach(scene)[-1])
    motion = solve_driven(scene, ends, np.ones(2), np.zeros(2))
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
    """What hangs on a link that is not certain is not certain either; never NaN."""
    scene = parse_scene(HANGING, "test")
    low, high = reach(scene)[-1]
    motion = solve(scene, np.array([low, 0.5 * (low + high), high]))
    for track in (*motion.bound.links.values(), *motion.bound.points.values()):
        assert not any(np.isnan(array).any() for array in vars(track).values())
    for name in ("coupler", "rocker", "rod", "lever"):
        assert np.isinf(motion.bound.links[name].omega).tolist() == [True, False, True]


def test_angle_out_of_reach_raises() -> None:
    with pytest.raises(ReachError, match="fourbar-double-rocker: driver at 90 deg"):
        solve_driven(
            load_scene("fourbar-double-rocker"), np.array([math.pi / 2]), np.ones(1), np.zeros(1)
        )


@pytest.mark.parametrize("count", [5, slowly(15, reason="random mechanisms")])
@pytest.mark.parametrize("form", [form for form in FORMS if form[:3] in ("RRP", "RPR")])
def test_branch_of_a_slider_is_the_way_along_its_line(form: str, count: int) -> None:
    """Of the two assemblies, +1 is the one with the greater displacement, in every role."""

    @examples(count)
    @given(mechanisms([form]))
    def hold(designed: Designed) -> None:
        (name,) = designed.scene.sliders
        ahead, behind = (
            solve(replace(designed.scene, branch={name: side}), np.zeros(1))
            .sliders[name]
            .displacement[0]
            for side in (1, -1)
        )
        assert ahead > behind

    hold()


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "fourbar-crossed", "sixbar-watt"])
def test_branch_of_a_pin_is_its_side_of_the_outer_pins(name: str) -> None:
    """+1: to the left of the line from the first outer pin to the second, links as in the file."""
    scene = load_scene(name)
    motion = solve(scene, np.linspace(0.0, 1.0, 50))
    b, c, d = (motion.points[p].position for p in "BCD")
    left = (d - b)[:, 0] * (c - b)[:, 1] - (d - b)[:, 1] * (c - b)[:, 0]
    assert np.all(np.sign(left) == scene.branch["C"])
