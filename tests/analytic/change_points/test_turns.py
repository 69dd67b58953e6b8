"""The angle of a link depends on the driver's angle alone, not on who asks."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

from analytic import prepared
from analytic.change_points.turns import CellSolver
from analytic.kinematics import reach, solve, solve_driven
from models.array import Array
from models.files.reading import load_scene, parse_scene, shipped
from models.motion import Motion
from models.scene import Driver, Scene
from models.scene.laws import ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from tests.analytic import four_bars
from tests.analytic.change_points.test_crossing import LEVER, LOCOMOTIVE, fourbar
from tests.worlds.strategies import Designed, examples, mechanisms
from tests.worlds.tiers import slowly

PERIOD = math.tau / 10.0
"""Of the crank above [s]."""


def whitworth(apart: float) -> Scene:
    """A lever that turns all the faster past its dead point, the nearer the pivots' distance is to
    the crank's length."""
    scene = load_scene("slotted-lever")
    crank = replace(scene.links["crank"], points={"A": (0.0, 0.0), "B": (0.2, 0.0)})
    ground = {"A": (0.0, 0.0), "C": (0.0, -apart)}
    return replace(scene, ground=ground, links={**scene.links, "crank": crank})


def lever_at(apart: float, theta: Array) -> Array:
    """The lever's angle in closed form: the crank's and the angle between them, which swings."""
    along, across = 0.2 + apart * np.sin(theta), apart * np.cos(theta)
    return np.asarray(theta + np.arctan2(across, along))


def driven(scene: Scene, theta: Array) -> Motion:
    return solve_driven(scene, theta, np.ones(1), np.zeros(1))


def sampled(scene: Scene, time_s: Array) -> dict[str, Array]:
    return {name: m.theta for name, m in solve(scene, time_s, bound=False).links.items()}


def turns_as_step_by_step(scene: Scene, seed: int, count: int, periods: float) -> None:
    """As unwrapped along 40,000 samples of the way there."""
    span = periods * scene.driver.law.period_s
    time_s = np.random.default_rng(seed).uniform(0.0, span, count)
    every = np.unique(np.concatenate([np.linspace(0.0, float(time_s.max()), 40_000), time_s]))
    found, dense, at = sampled(scene, time_s), sampled(scene, every), np.searchsorted(every, time_s)
    for link in scene.links:
        assert np.allclose(found[link], np.unwrap(dense[link])[at], rtol=0, atol=1e-9)


@pytest.mark.parametrize("apart", [0.1, 0.198, 0.2 - 1e-9])
@pytest.mark.parametrize("steps", [1, 3, 5000])
def test_a_turn_is_counted_however_coarse_the_samples(apart: float, steps: int) -> None:
    scene = whitworth(apart)
    time_s = np.arange(2 * steps + 1) * (PERIOD / steps)
    motion = solve(scene, time_s)
    wanted = lever_at(apart, 10.0 * time_s)
    # A few roundings of the closed form, which too divides by the distance of the block.
    room = motion.bound.links["lever"].theta + 1e-14 / (0.2 - apart)
    assert np.all(np.abs(motion.links["lever"].theta - wanted) <= room)


def test_one_sample_or_many_in_any_order_from_any_time_on() -> None:
    apart = 0.198
    scene = whitworth(apart)
    rng = np.random.default_rng(1)
    time_s = rng.uniform(-2.0 * PERIOD, 7.0 * PERIOD, 500)
    unsorted = sampled(scene, time_s)["lever"]
    assert np.allclose(unsorted, lever_at(apart, 10.0 * time_s), rtol=0, atol=1e-10)
    late = np.sort(time_s[time_s > 0.3])
    for some in (time_s[:1], time_s[7:8], late, late[::-1], np.repeat(late[-1:], 3)):
        at = np.array([int(np.flatnonzero(time_s == t)[0]) for t in some])
        assert np.array_equal(sampled(scene, some)["lever"], unsorted[at])


@pytest.mark.parametrize("name", shipped())
def test_shipped_scenes_turn_as_they_do_step_by_step(name: str) -> None:
    turns_as_step_by_step(load_scene(name), 2, 40, 5.0)


LAWS = [ConstantSpeed(0.3, -7.0), ConstantSpeed(-50.0, 3.0), Oscillating(0.2, 9.0, 2.0, 0.4)]
LAWS += [Oscillating(2.0, -0.7, 5.0), FromRest(1.0, -6.0, 1.3)]
LAWS += [SpeedChange(0.5, 5.0, -8.0, 2.0, 0.5)]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_the_count_goes_with_the_driver_whatever_its_law(law: Law) -> None:
    """Clockwise, forth and back over turns or less, and turning round."""
    scene = load_scene("whitworth")
    turns_as_step_by_step(replace(scene, driver=replace(scene.driver, law=law)), 3, 50, 4.0)


CHANGING = {
    "parallelogram": fourbar(0.1, 0.3, 0.1, 0.3),
    "kite": fourbar(0.1, 0.3, 0.3, 0.1),
    "nearly a kite": fourbar(0.1, 0.3, 0.3, 0.1 + 1e-7),
    "lever": parse_scene(LEVER.format(pivot=0.1), "test"),
    "nearly": parse_scene(LEVER.format(pivot=0.1 - 1e-7), "test"),
    "locomotive": parse_scene(LOCOMOTIVE, "test"),
}


@pytest.mark.parametrize("name", CHANGING)
def test_turns_are_counted_through_change_points_and_past_near_ones(name: str) -> None:
    """A kite's rocker turns once in two turns of the crank; past a near change point a lever turns
    by half a turn within 1e-6 rad of the crank."""
    scene = CHANGING[name]
    period = scene.driver.law.period_s
    theta = scene.driver.law.at(np.zeros(1))[0][0] + np.linspace(0.0, 4.0 * math.tau, 40_001)
    off = 3.0 ** -np.arange(3.0, 20.0)
    beside = (0.25 * math.tau * np.arange(17.0)[:, None] + np.append(-off, off)).ravel()
    every = np.unique(np.concatenate([theta, beside]))
    every = every[every >= theta[0]]
    angles = driven(scene, every).links
    time_s = np.random.default_rng(4).uniform(0.0, 4.0 * period, 40)
    at = scene.driver.law.at(time_s)[0]
    found = sampled(scene, time_s)
    for link in scene.links:
        steps = np.unwrap(angles[link].theta)
        assert np.array_equal(steps, angles[link].theta)
        near = np.searchsorted(every, at)
        assert np.abs(found[link] - steps[near]).max() < 0.01


@pytest.mark.parametrize("count", [10, slowly(1_000, reason="rare mechanisms and cells")])
def test_no_angle_in_a_cell_is_farther_off_than_said(count: int) -> None:
    """Also in cells that are too wide to be sure, and where the mechanism is open in the middle;
    and one that is said to be open all over does not close anywhere."""

    @examples(count)
    @given(designed=mechanisms(), seed=st.integers(0, 2**32 - 1))
    def hold(designed: Designed, seed: int) -> None:
        scene = designed.scene
        ready = prepared.prepared(scene)
        look = CellSolver(scene, ready.steps, ready.passages)
        rng = np.random.default_rng(seed)
        middle, half = rng.uniform(-math.pi, math.pi, 200), 10.0 ** rng.uniform(-4.0, 0.0, 200)
        cells, inside = look.at(middle, half), look.at(middle + rng.uniform(-1.0, 1.0, 200) * half)
        closed = ~inside.is_open
        assert not np.any(closed & cells.is_open)
        for link, angle in cells.angles.items():
            off = inside.angles[link] - angle
            off -= math.tau * np.round(off / math.tau)
            assert np.all(np.abs(off)[closed] <= cells.spread[closed])

    hold()


def test_two_reachable_ranges_are_counted_each_for_itself() -> None:
    """The mirrored assembly beyond the gap: the same angles whether or not the other is asked."""
    scene = load_scene("fourbar-double-rocker")
    (low, high), *more = reach(scene)
    theta = np.concatenate([np.linspace(*ends, 50)[1:-1] for ends in ((low, high), *more)])
    whole = driven(scene, theta).links["rocker"].theta
    backwards = driven(scene, theta[::-1]).links["rocker"].theta
    alone = [driven(scene, theta[k : k + 1]).links["rocker"].theta[0] for k in range(len(theta))]
    assert np.array_equal(whole, backwards[::-1])
    assert np.array_equal(whole, alone)
    assert np.abs(np.diff(whole[:48])).max() < 0.5


@pytest.mark.parametrize(
    ("ground", "coupler", "rocker"),
    [(1.001, 0.004, 0.001), (1.007, 0.01, 0.002), (1.0, 2e-5, 1e-5), (1.0 + 2e-5, 1e-5, 1.5e-5)],
)
def test_a_reachable_range_may_be_as_narrow_as_it_likes(
    ground: float, coupler: float, rocker: float
) -> None:
    """Of a long crank and short links, by the cosine rule: a cell that is open in its middle may
    hold all of it."""
    least = abs(ground - 1.0)
    apart = np.array([max(abs(coupler - rocker), least), coupler + rocker])
    low, high = 2.0 * np.arcsin(np.sqrt((apart**2 - least**2) / (4.0 * ground)))
    theta = low + (high - low) * (0.5 - 0.5 * np.cos(np.linspace(1e-3, math.pi - 1e-3, 2001)))
    some, start = slice(None, None, -67), math.degrees(0.6 * low + 0.4 * high)
    for branch in (1, -1):
        scene = four_bars.fourbar(1.0, coupler, rocker, ground, branch, start_deg=start)
        links, found = (driven(scene, angles).links for angles in (theta, theta[some]))
        for link in links:
            angle = links[link].theta
            assert np.array_equal(found[link].theta, angle[some])
            assert np.abs(np.diff(angle)).max() < 1.0


def test_the_angle_at_time_0_is_the_one_nearest_to_zero() -> None:
    """Also where the link jumps over half a turn within the cell that the driver starts in."""
    for start in np.linspace(-math.pi, math.pi, 60):
        scene = replace(whitworth(0.1), driver=Driver("crank", ConstantSpeed(start, 10.0)))
        theta = sampled(scene, np.array([0.0, 0.0, 1e-9, -1e-9, 0.1 * PERIOD]))["lever"]
        assert abs(theta[0]) <= math.pi
        assert theta[0] == theta[1] == sampled(scene, np.zeros(1))["lever"][0]
        assert np.abs(np.diff(theta[:4])).max() < 1e-6
        assert 0.0 < theta[4] - theta[0] < math.pi


def test_what_the_driver_cannot_come_by_does_not_count() -> None:
    """Two lines cross at infinity a quarter of a turn off, where a guide turns round at once."""
    scene, (start, swing) = load_scene("tangent"), np.radians([20.0, 60.0]).tolist()
    guide = replace(scene.links["lever"], name="guide", points={"D": (0.0, 0.0), "F": (0.3, 0.0)})
    ring = replace(scene.sliders["sleeve"], name="ring", on="guide")
    more = {"links": {**scene.links, "guide": guide}, "sliders": {**scene.sliders, "ring": ring}}
    driver = replace(scene.driver, law=Oscillating(start, swing, 10.0))
    scene = replace(scene, ground={**scene.ground, "D": (-0.1, 0.07)}, driver=driver, **more)
    turns_as_step_by_step(scene, 8, 50, 4.0)
    time_s = np.linspace(0.0, scene.driver.law.period_s, 200)
    assert np.abs(sampled(scene, time_s)["guide"]).max() < math.pi


def test_the_bound_covers_the_count_after_a_million_turns() -> None:
    """Against the place within the turn, and whole turns in fifty digits."""
    scene = load_scene("whitworth")
    law = scene.driver.law
    time_s = np.random.default_rng(7).uniform(-1e6, 1e6, 40) * law.period_s
    motion = solve(scene, time_s)
    drive = [mpf(law.start_rad) + mpf(law.speed_rad_s) * mpf(float(t)) for t in time_s]
    turns = [mp.floor((d - mpf(law.start_rad)) / (2 * mp.pi)) for d in drive]
    within = np.array([float(d - 2 * mp.pi * n) for d, n in zip(drive, turns, strict=True)])
    once = driven(scene, np.concatenate([within, [law.start_rad, law.start_rad + math.tau]]))
    for link in scene.links:
        theta = once.links[link].theta
        gain = round((theta[-1] - theta[-2]) / math.tau)
        for i, n in enumerate(turns):
            wanted = mpf(float(theta[i])) + 2 * mp.pi * n * gain
            room = motion.bound.links[link].theta[i] + once.bound.links[link].theta[i]
            assert abs(mpf(float(motion.links[link].theta[i])) - wanted) <= room


def test_an_angle_that_is_not_sure_leads_nobody_astray(monkeypatch: pytest.MonkeyPatch) -> None:
    """Were one angle in the middle lost, those after it are looked up."""
    scene = whitworth(0.1)
    time_s = np.linspace(0.0, PERIOD, 2000)
    wanted = sampled(scene, time_s)["lever"]
    ready = prepared.prepared(scene)
    wrapped = np.remainder(wanted + math.pi, math.tau) - math.pi
    over = int(np.argmax(wrapped > 3.1))
    for lost in (slice(over + 1, over + 20), slice(over - 1, over)):
        angle, last = wrapped.copy(), lost.stop + (lost.start > over) * 500
        angle[lost] = 0.0
        prepared.Counter(ready.turns, 10.0 * time_s[:last]).count("lever", angle[:last])
        sure = np.delete(np.arange(last), np.arange(len(angle))[lost])
        assert np.allclose(angle[sure], wanted[sure], rtol=0, atol=1e-12)
