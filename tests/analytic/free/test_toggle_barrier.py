"""A toggle on top of a hill: whether a throw gets over it is known by its energy."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.free.release import release
from analytic.free.toggle_barrier import ToggleBarrier
from models.errors import CrankcheckError
from models.files import load_scene
from models.hard import fourbar


@pytest.fixture(scope="module")
def barrier() -> ToggleBarrier:
    """The hill of a triple rocker."""
    return ToggleBarrier.of(fourbar("hill", 0.2, 0.25, 0.3, 0.5, source="test", start_deg=70.0))


def test_the_toggle_is_level_and_higher_than_both_sides(barrier: ToggleBarrier) -> None:
    u = barrier.u * np.array([-1e-4, 1e-4, -0.5, 0.0, 0.5, 1.0])
    height = barrier.machine.potential(u)
    assert np.hypot(*barrier.scene.gravity_m_s2) == pytest.approx(9.81, rel=1e-14)
    assert height[0] - height[1] == pytest.approx(0.0, abs=1e-10 * barrier.barrier_j)
    assert height[3] > max(height[2], height[4])
    assert height[3] - height[5] == pytest.approx(barrier.barrier_j, rel=1e-14)


@pytest.mark.parametrize("margin", [1e-3, -1e-3])
def test_the_integrated_motion_does_what_the_energy_says(
    barrier: ToggleBarrier, margin: float
) -> None:
    motion = release(barrier.thrown(margin), 0.5 * barrier.lasts_s(margin))
    energy = motion.energy(np.zeros(1))
    assert float(energy.kinetic[0]) == pytest.approx((1.0 + margin) * barrier.barrier_j, rel=1e-12)
    assert any(barrier.is_toggle(one) for one in motion.passages) == (margin > 0.0)


def test_the_start_has_the_accelerations_of_the_free_motion(barrier: ToggleBarrier) -> None:
    state = barrier.start(1e-2)
    true = release(barrier.thrown(1e-2), 1e-3).at(np.zeros(1), bound=False).state()
    assert state.theta == pytest.approx(true.theta, rel=1e-12)
    assert state.omega == pytest.approx(true.omega, rel=1e-11)
    assert state.alpha == pytest.approx(true.alpha, rel=1e-9)


def test_links_in_line_close_by_the_angle_that_the_start_is_open(barrier: ToggleBarrier) -> None:
    theta = barrier.start(0.1).theta
    one, other = barrier.links
    between = theta[other] - theta[one]
    assert np.sin(between - barrier.open_rad) == pytest.approx(0.0, abs=1e-4)


def test_what_has_no_such_hill_is_refused(barrier: ToggleBarrier) -> None:
    with pytest.raises(CrankcheckError, match="turns fully, and has no toggle"):
        ToggleBarrier.of(load_scene("fourbar-lecture-1"))
    for margin in (0.0, -1.0, float("nan")):
        with pytest.raises(CrankcheckError, match="give one above -1, and not 0"):
            barrier.thrown(margin)
