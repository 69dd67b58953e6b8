"""Contact force by energy and by Newton's law, and the speed at which contact is lost."""

import math

import numpy as np
import pytest

from analytic.cams.contact_force import FollowerLoad, contact_force, lift_off
from analytic.cams.profile import touch
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw, CamSegment
from models.scene.cams import Cam, OscillatingFollower, TranslatingFollower
from tests.analytic.cams.designs import FOLLOWERS, designs

PHI = np.linspace(0.0, math.tau, 10_001)


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_torque_is_the_rate_of_energy_and_the_moment_of_the_contact_force(
    motion: str, contact: str
) -> None:
    load = FollowerLoad(0.3, 800.0, 25.0, 3.0, 0.4)
    for cam in designs(motion, contact, 2, seed=5):
        omega, phi = 7.0, PHI[5:-5:29]
        found = contact_force(cam, load, omega, phi)
        touched = touch(cam, phi)
        # Moment about the cam's centre of the force that the follower returns, -N n.
        moment = found.contact_n * (touched.contact.conj() * touched.normal).imag
        assert np.allclose(found.torque_nm, moment, rtol=1e-9, atol=1e-9 * abs(moment).max())

        def energy(at: np.ndarray, cam: Cam = cam) -> np.ndarray:
            s, first, *_ = cam.law.at(at)
            kept = 0.5 * 0.3 * (7.0 * first) ** 2 + 0.5 * 800.0 * s**2 + 25.0 * s
            if isinstance(cam.follower, OscillatingFollower):
                return kept + 3.0 * np.sin(cam.start + s - 0.4)
            return kept + 3.0 * s

        step = 1e-5
        rate = cam.sense * (energy(phi + step) - energy(phi - step)) / (2 * step)
        away = np.abs(phi[:, None] - np.array(cam.law.knots_rad)).min(axis=1) > step
        scale = np.abs(found.torque_nm).max()
        assert np.abs(rate - found.torque_nm)[away].max() < 1e-6 * scale


def test_an_eccentric_circle_lets_its_follower_go_at_the_closed_form() -> None:
    # s = e (1 - cos phi): (k s + F0)/(-m s'') has its least at the top, (2 k e + F0)/(m e).
    e, k, preload, mass = 0.01, 500.0, 4.0, 0.2
    up, down = CamSegment("harmonic", math.pi, 2 * e), CamSegment("harmonic", math.pi, -2 * e)
    cam = Cam(CamLaw((up, down)), 0.04, TranslatingFollower("flat"))
    found = lift_off(cam, FollowerLoad(mass, k, preload))
    assert found[1] == pytest.approx(math.pi, abs=1e-7)
    assert found[0] == pytest.approx(math.sqrt((2 * k * e + preload) / (mass * e)), 1e-13)
    # With weight alone, as on a slow conveyor: g/e.
    weight = lift_off(cam, FollowerLoad(mass, weight=mass * 9.81))[0]
    assert weight == pytest.approx(math.sqrt(9.81 / e), rel=1e-13)


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_below_lift_off_the_cam_presses_everywhere_and_above_it_somewhere_not(
    motion: str, contact: str
) -> None:
    for cam in designs(motion, contact, 2, seed=6):
        load = FollowerLoad(0.3, 300.0, 20.0, 2.0, 0.3)
        omega, phi = lift_off(cam, load)
        assert contact_force(cam, load, omega * (1 - 1e-9), PHI).contact_n.min() > 0.0
        there = np.array([phi, np.nextafter(phi, 0.0)])
        assert contact_force(cam, load, omega * (1 + 1e-9), there).contact_n.min() < 0.0
        s, _, second, _ = cam.law.at(PHI)
        with np.errstate(divide="ignore"):
            limits = np.where(second < 0.0, load.closing(cam, s) / (-0.3 * second), math.inf)
        assert -1e-12 < limits.min() / omega**2 - 1 < 1e-4  # limits from the left are not searched


def test_followers_that_nothing_closes_are_refused_and_drops_of_velocity_leave_at_once() -> None:
    law = CamLaw((CamSegment("uniform", math.pi, 0.02), CamSegment("uniform", math.pi, -0.02)))
    cam = Cam(law, 0.1, TranslatingFollower("knife"))
    found = lift_off(cam, FollowerLoad(1.0, 0.0, 5.0))
    assert found[0] == 0.0
    assert found[1] == pytest.approx(math.pi)
    assert lift_off(cam, FollowerLoad(0.0, 0.0, 5.0))[0] == math.inf
    with pytest.raises(CrankcheckError, match="give a preload above 3"):
        lift_off(cam, FollowerLoad(1.0, 10.0, 2.0, weight=-3.0))
