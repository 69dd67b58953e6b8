"""The speed at an angle is the one that the law has when it is there."""

from __future__ import annotations

import numpy as np
import pytest

from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.passing import passing

PASSED: list[tuple[Law, float, bool]] = [
    (ConstantSpeed(0.3, -7.0), 0.02, False),
    (FromRest(0.1, 12.0, 0.4), 1.0, False),
    (Oscillating(0.5, 0.4, 9.0, -1.5), 0.02, False),
    (Oscillating(0.5, 0.4, 9.0, 0.2), 0.3, True),
    (Oscillating(0.5, -0.4, 9.0, 0.2), 0.05, True),
    (Accelerating(0.3, 2.0, 9.0), 0.1, False),
    (Accelerating(0.3, -2.0, 9.0), 0.05, False),
    (Accelerating(0.3, -2.0, 9.0), 0.05, True),
    (Accelerating(0.3, -2.0, 9.0), 0.7, False),
    (Accelerating(0.3, 2.0, -9.0), 0.3, True),
    (Accelerating(0.3, 0.0, -9.0), 0.1, False),
    (Accelerating(0.3, 0.0, -9.0), 0.0, False),
]


@pytest.mark.parametrize(("law", "time_s", "clockwise"), PASSED)
def test_it_is_the_speed_of_the_law_when_it_is_there(
    law: Law, time_s: float, clockwise: bool
) -> None:
    theta, omega, alpha = (float(each) for each in law.at(np.array(time_s)))
    found = passing(law, theta, clockwise=clockwise)
    assert found == pytest.approx((omega, alpha), rel=1e-12, abs=1e-12)


def test_a_steady_driver_may_be_turned_round() -> None:
    assert passing(ConstantSpeed(0.0, 3.0), 1.0, clockwise=True) == (-3.0, 0.0)
    assert passing(ConstantSpeed(0.0, -3.0), 1.0, clockwise=True) == (-3.0, 0.0)


def test_the_start_of_an_acceleration_has_the_speed_that_is_stated_to_the_bit() -> None:
    """Where it comes back to its start later, too."""
    for speed in (0.1, -0.1):
        assert passing(Accelerating(0.3, speed, -0.7), 0.3) == (speed, -0.7)


@pytest.mark.parametrize(("law", "theta", "clockwise", "message"), [
    (Oscillating(0.0, 0.5, 1.0), 0.6, False, r"swings from -28\.6479 to 28\.6479 deg"),
    (Accelerating(0.0, 2.0, 9.0), -1.0, False, r"comes to the same driver angle at 302\.704 deg"),
    (Accelerating(0.0, 2.0, -9.0), 1.0, False, r"comes to the same driver angle at -302\.704 deg"),
    (Accelerating(0.0, 2.0, 9.0), 1.0, True, "does not turn clockwise there"),
    (SpeedChange(0.0, 1.0, 2.0, 0.1, 0.1), 1.0, False, "without a speed at an angle"),
])  # fmt: skip
def test_an_angle_that_a_law_does_not_come_to_is_refused(
    law: Law, theta: float, clockwise: bool, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        passing(law, theta, clockwise=clockwise)
