"""The control streams put the crank exactly where the law has it, replayed step by step."""

import numpy as np
import pytest

from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from sim.engine.drive import chords, pushes, start_speed

DT_S, START_S, STEPS = 2e-3, 0.13, 2000
TIMES = START_S + DT_S * np.arange(STEPS + 1)
LAWS = (
    ConstantSpeed(0.4, -3.0), Oscillating(1.0, 0.7, 6.0, 0.5), FromRest(0.2, 9.0, 0.4),
    Accelerating(0.2, 3.0, -1.3),
)  # fmt: skip


@pytest.mark.parametrize("shift", [0.0, -0.5])
@pytest.mark.parametrize("law", LAWS)
def test_pushes_make_the_angle_exact_at_every_sample(law: Law, shift: float) -> None:
    """And the start speed keeps the speed from alternating about the law's."""
    gained = DT_S * pushes(law, START_S, DT_S, STEPS, shift)
    omega = np.cumsum([start_speed(law, START_S, DT_S, shift), *gained])
    mean = omega[1:] if shift else (omega[1:] + omega[:-1]) / 2.0
    theta, _, _ = law.at(TIMES)
    np.testing.assert_allclose(theta[0] + np.cumsum(DT_S * mean), theta[1:], atol=1e-10)
    off = omega - law.at(TIMES + shift * DT_S)[1]
    np.testing.assert_allclose(off, 0.0, atol=4e-4 * law.peak_speed_rad_s)
    if isinstance(law, Oscillating) and shift == 0.0:
        assert np.abs(np.diff(off)).max() < 0.02 * np.abs(off).max()


@pytest.mark.parametrize("law", LAWS)
def test_chords_join_the_samples(law: Law) -> None:
    joined = np.diff(law.at(TIMES[5:11])[0]) / DT_S
    np.testing.assert_allclose(chords(law, START_S, DT_S, 5, 9), joined, rtol=1e-10, atol=1e-12)
    assert start_speed(law, START_S, DT_S, 0.5) == chords(law, START_S, DT_S, 0, 0)[0]
