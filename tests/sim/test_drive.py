"""The control streams put the crank exactly where the law has it, replayed step by step."""

from __future__ import annotations

import numpy as np
import pytest

from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from sim.drive import chords, pushes, start_speed

LAWS: list[Law] = [
    ConstantSpeed(0.4, -3.0),
    Oscillating(1.0, 0.7, 6.0, 0.5),
    FromRest(0.2, 9.0, 0.4),
    Accelerating(0.2, 3.0, -1.3),
]
DT_S, START_S, STEPS = 2e-3, 0.13, 2000


def replayed(law: Law, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """Angles and speeds of a crank that is pushed as told."""
    theta = float(law.at(np.array([START_S]))[0][0])
    omega = start_speed(law, START_S, DT_S, shift)
    thetas, omegas = [theta], [omega]
    for push in pushes(law, START_S, DT_S, STEPS, shift):
        if shift == 0.0:
            theta += omega * DT_S + push * DT_S**2 / 2
            omega += push * DT_S
        else:
            omega += push * DT_S
            theta += omega * DT_S
        thetas.append(theta)
        omegas.append(omega)
    return np.array(thetas), np.array(omegas)


@pytest.mark.parametrize("shift", [0.0, -0.5])
@pytest.mark.parametrize("law", LAWS)
def test_pushes_make_the_angle_exact_at_every_sample(law: Law, shift: float) -> None:
    time_s = START_S + DT_S * np.arange(STEPS + 1)
    theta, omega = replayed(law, shift)
    np.testing.assert_allclose(theta, law.at(time_s)[0], atol=1e-10)
    wanted = law.at(time_s + shift * DT_S)[1]
    np.testing.assert_allclose(omega, wanted, atol=4e-4 * law.peak_speed_rad_s)


def test_the_start_speed_keeps_the_speed_from_alternating() -> None:
    law = Oscillating(1.0, 0.7, 6.0, 0.5)
    time_s = START_S + DT_S * np.arange(STEPS + 1)
    off = replayed(law, 0.0)[1] - law.at(time_s)[1]
    jumps = np.abs(np.diff(off)).max()
    assert jumps < 0.1 * np.abs(off).max()


@pytest.mark.parametrize("law", LAWS)
def test_chords_join_the_samples(law: Law) -> None:
    time_s = START_S + DT_S * np.arange(5, 10)
    theta = law.at(np.append(time_s, time_s[-1] + DT_S))[0]
    np.testing.assert_allclose(
        chords(law, START_S, DT_S, 5, 9), np.diff(theta) / DT_S, rtol=1e-10, atol=1e-12
    )
    assert start_speed(law, START_S, DT_S, 0.5) == chords(law, START_S, DT_S, 0, 0)[0]
