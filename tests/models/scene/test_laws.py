"""Laws of the driver: rates are derivatives, and the speed at an angle is that when it is there."""

import math

import numpy as np
import pytest

from models.scene.driver import passing
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.scene.moved import mirrored_law
from tests.worlds.other_way import faster_law

LAWS: list[Law] = [
    ConstantSpeed(0.3, -7.0),
    Oscillating(0.5, 0.4, 9.0, 0.2),
    FromRest(0.1, 12.0, 0.4),
    Accelerating(0.3, -2.0, 9.0),
    SpeedChange(0.3, 6.0, -4.0, 0.25, 0.3),
]
STEP = 1e-5


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_rates_are_derivatives_and_transformed_laws_follow_the_transformation(law: Law) -> None:
    t = np.linspace(0.01, 0.7, 101)
    theta, omega, alpha = law.at(t)
    ahead, behind = law.at(t + STEP), law.at(t - STEP)
    # Central differences: STEP^2 / 6 times a third derivative of at most 400, and rounding / STEP.
    assert np.allclose((ahead[0] - behind[0]) / (2 * STEP), omega, rtol=0, atol=5e-8)
    assert np.allclose((ahead[1] - behind[1]) / (2 * STEP), alpha, rtol=0, atol=5e-6)
    assert theta.shape == omega.shape == alpha.shape == t.shape
    t = np.linspace(0.0, 0.7, 11)
    theta, omega, alpha = law.at(t)
    assert np.allclose(law.turned(0.7).at(t)[0], theta + 0.7)
    assert np.allclose(mirrored_law(law).at(t), [-theta, -omega, -alpha])
    fast = faster_law(law, 3.0)
    assert np.allclose(fast.at(t / 3.0), [theta, 3.0 * omega, 9.0 * alpha])
    assert fast.period_s == pytest.approx(law.period_s / 3.0)
    assert fast.peak_speed_rad_s == pytest.approx(law.peak_speed_rad_s * 3.0)


def test_changes_of_speed_are_smooth_or_two_straight_lines() -> None:
    law = FromRest(0.1, 12.0, 0.4)
    theta, omega, alpha = law.at(np.array([0.0, 0.4, 1.0]))
    assert (theta[0], omega[0], alpha[0]) == (0.1, 0.0, 0.0)
    assert theta[1] == pytest.approx(0.1 + 12.0 * 0.2, rel=1e-14)
    assert omega[1:] == pytest.approx([12.0, 12.0], rel=1e-14)
    assert alpha[1:] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert theta[2] - theta[1] == pytest.approx(12.0 * 0.6, rel=1e-14)
    t = np.linspace(0.0, 1.0, 50)
    late = SpeedChange(0.1, 0.0, 12.0, 0.2, 0.4).at(t + 0.2)
    assert np.allclose(late, law.at(t), rtol=0, atol=1e-13)
    # A jump of the speed is two straight lines.
    law = SpeedChange(0.2, 5.0, -3.0, 0.5, 0.0)
    theta, omega, alpha = law.at(np.array([0.0, 0.5, 1.5]))
    assert theta == pytest.approx([0.2, 2.7, -0.3], rel=1e-14)
    assert list(omega) == [5.0, -3.0, -3.0]
    assert not alpha.any()


@pytest.mark.parametrize(
    ("speed", "acceleration"), [(10.0, 5.0), (0.0, -8.0), (-6.0, 1.4), (10.0, -8.0), (-3.0, 20.0)]
)
def test_a_turn_of_a_steady_acceleration_is_the_first_away_from_the_start(
    speed: float, acceleration: float
) -> None:
    law = Accelerating(0.3, speed, acceleration)
    t = np.linspace(0.0, law.period_s, 1001)
    theta, omega, _ = law.at(t)
    assert abs(theta[-1] - 0.3) == pytest.approx(math.tau, rel=1e-13)
    assert np.abs(theta[:-1] - 0.3).max() < math.tau
    assert law.peak_speed_rad_s == pytest.approx(np.abs(omega).max(), rel=1e-13)
    assert law.fastest_until(3 * law.period_s) == pytest.approx(
        max(law.peak_speed_rad_s, abs(speed + 3 * acceleration * law.period_s)), rel=1e-13
    )


@pytest.mark.parametrize(("make", "message"), [
    (lambda: ConstantSpeed(0.0, 0.0), "drives nothing"),
    (lambda: ConstantSpeed(math.nan, 1.0), "start_rad is nan"),
    (lambda: Oscillating(0.0, 0.0, 1.0), "amplitude"),
    (lambda: FromRest(0.0, 1.0, 0.0), "rise_s"),
    (lambda: Accelerating(0.0, 1.0, 0.0), 'use law = "constant"'),
    (lambda: SpeedChange(0.0, 1.0, 0.0, 0.1, 0.1), "after_rad_s"),
    (lambda: SpeedChange(0.0, 1.0, 2.0, 0.1, -0.1), "rise_s"),
])  # fmt: skip
def test_law_that_drives_nothing_is_refused(make: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()  # type: ignore[operator]  # a lambda per case


PASSED: list[tuple[Law, float, bool]] = [
    (ConstantSpeed(0.3, -7.0), 0.02, False),
    (FromRest(0.1, 12.0, 0.4), 1.0, False),
    (Oscillating(0.5, 0.4, 9.0, -1.5), 0.02, False),
    (Oscillating(0.5, 0.4, 9.0, 0.2), 0.3, True),
    (Accelerating(0.3, 2.0, 9.0), 0.1, False),
    (Accelerating(0.3, -2.0, 9.0), 0.05, False),
    (Accelerating(0.3, -2.0, 9.0), 0.05, True),
    (Accelerating(0.3, 0.0, -9.0), 0.0, False),
]


@pytest.mark.parametrize(("law", "time_s", "clockwise"), PASSED)
def test_it_is_the_speed_of_the_law_when_it_is_there(
    law: Law, time_s: float, clockwise: bool
) -> None:
    theta, omega, alpha = (float(each) for each in law.at(np.array(time_s)))
    found = passing(law, theta, clockwise=clockwise)
    assert found == pytest.approx((omega, alpha), rel=1e-12, abs=1e-12)


def test_speeds_that_are_stated_are_there_to_the_bit() -> None:
    """Of a driver turned round, and of one that comes back to its start later."""
    for speed in (3.0, -3.0):
        assert passing(ConstantSpeed(0.0, speed), 1.0, clockwise=True) == (-3.0, 0.0)
    for speed in (0.1, -0.1):
        assert passing(Accelerating(0.3, speed, -0.7), 0.3) == (speed, -0.7)


@pytest.mark.parametrize(("law", "theta", "clockwise", "message"), [
    (Oscillating(0.0, 0.5, 1.0), 0.6, False, r"swings from -28\.6479 to 28\.6479 deg"),
    (Accelerating(0.0, 2.0, 9.0), -1.0, False, r"reaches the same driver angle at 302\.704 deg"),
    (Accelerating(0.0, 2.0, -9.0), 1.0, False, r"reaches the same driver angle at -302\.704 deg"),
    (Accelerating(0.0, 2.0, 9.0), 1.0, True, "does not turn clockwise there"),
    (SpeedChange(0.0, 1.0, 2.0, 0.1, 0.1), 1.0, False, "without a speed at an angle"),
])  # fmt: skip
def test_an_angle_that_a_law_does_not_come_to_is_refused(
    law: Law, theta: float, clockwise: bool, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        passing(law, theta, clockwise=clockwise)
