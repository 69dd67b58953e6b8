"""A limit of the driver's angle, out to where it is no longer what is counted from."""

from __future__ import annotations

import numpy as np
import pytest
from analytic.free.limit import REACH
from tests.analytic.free.let_go import fourbar

from analytic.free.machine_motion import MachineMotion
from analytic.free.release import release


@pytest.mark.parametrize("k", [2, 10])
def test_a_limit_reaches_as_far_as_it_says_whatever_rounding_does(k: int) -> None:
    """With these lengths the square of the root of the reach is larger than the reach. Runs are
    looked for out to there, and had no geometry at all."""
    scene = fourbar(0.2 + 0.0031 * k, 0.2, 0.25, 0.41 + 0.0017 * k, start_deg=60.0)
    motion = release(scene, 0.02)
    assert isinstance(motion, MachineMotion)
    chart = motion.track.windows[0].chart
    assert chart.limit is not None
    most = REACH * chart.limit.length_rad
    u = np.array([np.sqrt(most)])
    assert u[0] * u[0] > most
    chart.unit(u)
    time_s = np.linspace(0.0, 0.02, 5)
    assert np.allclose(
        motion.beside(motion.at(time_s)).links["rocker"].theta,
        motion.at(time_s).links["rocker"].theta,
    )
