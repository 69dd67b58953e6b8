"""Limits of the driver's angle, and what passes them: into the other assembly, out to where the
limit is no longer what is counted from, and over a hill or not, as its energy says."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.free.exact_motions import ToggleBarrier
from analytic.free.limit_position import REACH
from analytic.free.release import release
from analytic.free.solved_motion import MachineMotion
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene.driver import let_go
from models.scene.hard import fourbar as triple_rocker
from tests.analytic.free.mechanisms import fourbar, past_limits, released
from tests.analytic.multibody.scenes import by_bodies
from tests.analytic.multibody.scenes import scene as parsed
from tests.worlds.loading import loaded_mechanism
from tests.worlds.tiers import slow, slowly


@pytest.mark.parametrize(
    "until_s", [0.4, slowly(0.9, reason="a second: the other limit, which the first is like")]
)
def test_past_limits_the_motion_is_that_of_all_bodies(until_s: float) -> None:
    """Through two limits, each of which puts the dyad into its other assembly."""
    scene = past_limits()
    free = released(scene, 0.9)
    assert [passage.dyad for passage in free.passages] == ["C", "C"]
    first, second = free.passages
    cosine = (0.45**2 - 0.2**2 - 0.4**2) / (-2.0 * 0.2 * 0.4)
    assert second.driver_rad == pytest.approx(math.acos(cosine), abs=1e-15)
    assert first.driver_rad == pytest.approx(-math.acos(cosine), abs=1e-15)
    ends = (each.at(np.array([until_s])).links for each in (free, by_bodies(scene, until_s)))
    found, wanted = (np.array([link.theta[0] for link in end.values()]) for end in ends)
    assert np.abs(found - wanted).max() < 1e-10


def test_past_limits_all_goes_on_in_the_right_assembly_in_any_order_of_times() -> None:
    free = released(past_limits(), 0.9)
    near = [p.time_s + x for p in free.passages for x in (-1e-4, -1e-7, 0.0, 1e-7, 1e-4)]
    time_s = np.sort(np.concatenate([np.linspace(0.0, 0.9, 601), near]))
    motion, step = free.at(time_s), np.diff(time_s)
    for link in motion.links.values():
        steady = 0.5 * (link.omega[1:] + link.omega[:-1])
        off = np.abs(np.diff(link.theta) - steady * step)
        assert np.all(off <= 0.2 * np.abs(link.alpha).max() * step**2 + 1e-12)
    beside = free.beside(motion)
    for name, point in motion.points.items():
        assert np.abs(beside.points[name].position - point.position).max() < 1e-12
    for name, link in motion.links.items():
        assert np.abs(beside.links[name].theta - link.theta).max() < 1e-7
    back = free.at(time_s[::-1])
    assert np.array_equal(motion.links["rocker"].theta, back.links["rocker"].theta[::-1])
    bounds = (each.bound.points["C"].position for each in (motion, back))  # type: ignore[union-attr]
    assert np.array_equal(next(bounds), next(bounds)[::-1])


@slow("rare: two singular positions within a tenth of the range")
def test_a_limit_with_another_singular_position_beside_it_is_passed() -> None:
    """Less than 0.1 of the range beyond a limit of the driver an earlier dyad is open as well."""
    scene = let_go(replace(loaded_mechanism(36)[0], loads={}), 0.2)
    here, there = (each(scene, 0.2).at(np.array([0.1, 0.2])) for each in (release, by_bodies))
    for name, link in here.links.items():
        assert np.abs(link.theta - there.links[name].theta).max() < 1e-10


def test_a_limit_reaches_as_far_as_it_says_whatever_rounding_does() -> None:
    """With these lengths the square of the root of the reach is larger than the reach. Runs are
    looked for out to there, and had no geometry at all."""
    scene = fourbar(0.2062, 0.2, 0.25, 0.4134, start_deg=60.0)
    motion = release(scene, 0.02)
    assert isinstance(motion, MachineMotion)
    chart = motion.history.windows[0].chart
    most = REACH * chart.limit.length_rad
    u = np.array([np.sqrt(most)])
    assert u[0] * u[0] > most
    chart.unit(u)


OFFSET_SLOT = """
ground = { points = { A = [0.0, 0.0], C = [0.12, 0.0] } }
sliders = { B = { on = "lever", through_m = [0.0, 0.05], mass_kg = 0.1 } }
driver = { link = "crank", law = "free", start_deg = 90.0, speed_rad_s = -6.0, duration_s = 1.0 }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
[links.lever]
points = { C = [0.0, 0.0] }
mass_kg = 1.0
centre_m = [0.05, 0.02]
inertia_kg_m2 = 0.01
"""


def test_a_link_whose_points_are_the_same_in_both_assemblies_tells_them_apart() -> None:
    """A lever that turns about a fixed pivot has no other named point: by points alone both of its
    assemblies were as near, and runs in the second one were held to the first."""
    motion = release(parsed(OFFSET_SLOT, 0.0), 1.0)
    assert motion.passages
    true = motion.at(np.linspace(0.0, 1.0, 41), bound=False)
    found = motion.beside(true).links["lever"].theta
    np.testing.assert_allclose(found, true.links["lever"].theta, atol=1e-9)


@pytest.fixture(scope="module")
def barrier() -> ToggleBarrier:
    """A toggle on top of a hill, of a triple rocker."""
    hill = triple_rocker("hill", 0.2, 0.25, 0.3, 0.5, source="test", start_deg=70.0)
    return ToggleBarrier.of(hill)


def test_the_toggle_is_level_and_higher_than_both_sides(barrier: ToggleBarrier) -> None:
    u = barrier.u * np.array([-1e-4, 1e-4, -0.5, 0.0, 0.5, 1.0])
    height = barrier.machine.potential(u)
    assert np.hypot(*barrier.scene.gravity_m_s2) == pytest.approx(9.81, rel=1e-14)
    assert height[0] - height[1] == pytest.approx(0.0, abs=1e-10 * barrier.barrier_j)
    assert height[3] > max(height[2], height[4])
    assert height[3] - height[5] == pytest.approx(barrier.barrier_j, rel=1e-14)


@pytest.mark.parametrize("margin", [1e-3, -1e-3])
def test_a_throw_gets_over_as_its_energy_says(barrier: ToggleBarrier, margin: float) -> None:
    motion = release(barrier.thrown(margin), 0.5 * barrier.lasts_s(margin))
    energy = motion.energy(np.zeros(1))
    assert float(energy.kinetic[0]) == pytest.approx((1.0 + margin) * barrier.barrier_j, rel=1e-12)
    assert any(barrier.is_toggle(one) for one in motion.passages) == (margin > 0.0)


def test_a_throw_at_a_toggle_starts_with_free_accelerations(barrier: ToggleBarrier) -> None:
    state = barrier.start(1e-2)
    true = release(barrier.thrown(1e-2), 1e-3).at(np.zeros(1), bound=False).state()
    assert state.theta == pytest.approx(true.theta, rel=1e-12)
    assert state.omega == pytest.approx(true.omega, rel=1e-11)
    assert state.alpha == pytest.approx(true.alpha, rel=1e-9)
    one, other = barrier.links
    between = state.theta[other] - state.theta[one]  # its links in line close by what it is open
    assert np.sin(between - barrier.open_rad) == pytest.approx(0.0, abs=1e-4)
    with pytest.raises(CrankcheckError, match="turns fully, and has no toggle"):
        ToggleBarrier.of(load_scene("fourbar-lecture-1"))
    for margin in (0.0, -1.0, float("nan")):
        with pytest.raises(CrankcheckError, match="give one above -1, and not 0"):
            barrier.thrown(margin)
