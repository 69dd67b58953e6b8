"""Profiles of cams: envelopes of the follower's positions, by brute force and by differences."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from analytic.cams.profile import CamContact, Plane, touch
from models.array import Array
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw, CamSegment
from models.scene.cams import Cam, OscillatingFollower, TranslatingFollower
from tests.analytic.cams.designs import FOLLOWERS, designs
from tests.worlds.tiers import slow

PHI = np.linspace(0.0, math.tau, 37, endpoint=False) + 0.013


def gap(cam: Cam) -> Callable[[Array, Array, Array], Array]:
    """Distance of points (x, y) of the cam from the follower at an angle of the cam, by rotating
    points into the ground's frame: no derivative, no code of the product but the law's lift."""
    follower = cam.follower

    def distance(x: Array, y: Array, phi: Array) -> Array:
        lift = cam.law.at(phi).value
        c, s = np.cos(phi), cam.sense * np.sin(phi)
        gx, gy = c * x - s * y, s * x + c * y
        if isinstance(follower, OscillatingFollower):
            d = follower.pivot_m
            if follower.is_flat:
                psi = math.asin((cam.base_m - follower.face_m) / d) + lift
                return d * np.sin(psi) + follower.face_m - np.sin(psi) * gx - np.cos(psi) * gy
            arm, reach = follower.arm_m, cam.base_m + follower.roller_m
            psi = math.acos((d**2 + arm**2 - reach**2) / (2 * d * arm)) + lift
            px, py = d - arm * np.cos(psi), arm * np.sin(psi)
        elif follower.is_flat:
            return cam.base_m + lift - gy
        else:
            e = follower.offset_m
            px = np.full_like(lift, e)
            py = math.sqrt((cam.base_m + follower.roller_m) ** 2 - e**2) + lift
        return np.hypot(gx - px, gy - py) - follower.roller_m

    return distance


def check_envelope(cam: Cam) -> None:
    """Each point of the profile is touched by one position of the follower, and entered by none."""
    contact = touch(cam, PHI)
    points = contact.on_cam(contact.contact)
    x, y = points.real[:, None], points.imag[:, None]
    distance = gap(cam)
    every = np.linspace(0.0, math.tau, 361)[None, :]
    coarse = distance(x, y, every)
    nearest = every[0, np.argmin(coarse, axis=1)]
    x, y = x[:, 0], y[:, 0]
    least = coarse.min(axis=1)
    for step in (0.017, 1e-3, 1e-4, 1e-5):  # parabolas through three neighbours
        before, here, after = (distance(x, y, nearest + k * step) for k in (-1, 0, 1))
        least = np.minimum(least, here)
        bent = before - 2.0 * here + after
        move = np.where(bent > 0.0, 0.5 * (before - after) / np.where(bent > 0.0, bent, 1.0), 0.0)
        nearest = nearest + step * np.clip(move, -1.0, 1.0)
    least = np.minimum(least, distance(x, y, nearest))
    here = distance(x, y, PHI)
    scale = 1e-10 * cam.base_m
    assert np.abs(here).max() < scale, cam
    # A knife edge is nowhere nearer than 0: its distance has a corner there.
    if cam.follower.contact != "knife":
        assert np.abs(least).max() < scale, cam
    assert coarse.min() > -scale, cam


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_profiles_are_the_envelopes_of_the_followers_positions(motion: str, contact: str) -> None:
    for cam in designs(motion, contact, 25):
        check_envelope(cam)


@slow("a thousand designs of each kind")
@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_a_thousand_profiles_are_envelopes(motion: str, contact: str) -> None:
    for cam in designs(motion, contact, 1000):
        check_envelope(cam)


def curve_differences(cam: Cam, contact: CamContact, step: float) -> tuple[Plane, Plane]:
    """First and second derivative of the profile by the angle, by differences of 4th order."""
    shifts = np.array([-2, -1, 1, 2])
    near = [touch(cam, PHI + k * step) for k in shifts]
    p = [one.contact * np.exp(-1j * cam.sense * (PHI + k * step))
         for k, one in zip(shifts, near, strict=True)]  # fmt: skip
    middle = contact.on_cam(contact.contact)
    first = (p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * step)
    second = (-p[0] + 16 * p[1] - 30 * middle + 16 * p[2] - p[3]) / (12 * step**2)
    return first, second


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_normals_curvature_and_pressure_angles_are_those_of_differences(
    motion: str, contact: str
) -> None:
    for cam in designs(motion, contact, 6):
        found = touch(cam, PHI)
        step = 1e-3
        first, second = curve_differences(cam, found, step)
        knots = np.array(cam.law.knots_rad)
        away = np.abs(PHI[:, None] - knots).min(axis=1) > 3 * step
        moving = away & (np.abs(first) > 0.02 * cam.base_m)
        normal = found.on_cam(found.normal)
        assert np.abs((first * normal.conj()).real / np.abs(first))[moving].max() < 1e-7
        # Outward: the profile is traced clockwise round a cam that turns counter-clockwise.
        curvature = -cam.sense * (first.conj() * second).imag / np.abs(first) ** 3
        assert np.allclose((curvature * found.radius_m)[moving], 1.0, rtol=0, atol=3e-5)
        # The force N drives the follower: its power is N lever s', and N (v of the cam) . n.
        speed = (1j * cam.sense * found.contact * found.normal.conj()).real
        assert np.allclose(speed, found.lever * found.lift.first, rtol=0, atol=1e-12)
        arm = np.ones_like(PHI)
        if isinstance(cam.follower, OscillatingFollower):
            tip = found.contact if found.pitch is None else found.pitch
            arm = np.abs(tip - cam.follower.pivot_m)
        assert np.allclose(arm * np.cos(found.pressure_rad), found.lever, rtol=1e-12)


def test_pressure_angles_are_those_of_the_textbooks_formulas() -> None:
    law = CamLaw((CamSegment("cycloidal", 2.0, 0.02), CamSegment("harmonic", math.tau - 2, -0.02)))
    phi = np.linspace(0.1, 6.2, 50)
    s, first, *_ = law.at(phi)
    # Norton, Design of Machinery, eq. 8.31d: tan = (v - e) / (s + sqrt(R_p^2 - e^2)).
    for sense in (1, -1):
        cam = Cam(law, 0.04, TranslatingFollower("roller", 0.01, 0.012), sense)
        tangent = (sense * first - 0.012) / (s + math.sqrt(0.05**2 - 0.012**2))
        assert np.allclose(np.tan(touch(cam, phi).pressure_rad), tangent, rtol=0, atol=1e-14)
    flat = touch(Cam(law, 0.2, TranslatingFollower("flat")), phi)
    assert np.allclose(flat.contact.real, first, rtol=0, atol=1e-16)  # eq. 8.35: the contact at v
    assert not flat.pressure_rad.any()


def test_an_eccentric_circle_is_the_cam_of_its_own_law() -> None:
    # A circle of radius 30 mm, 10 mm off its pivot, under a flat face: s = e (1 - cos phi).
    e, radius = 0.01, 0.03
    up, down = CamSegment("harmonic", math.pi, 2 * e), CamSegment("harmonic", math.pi, -2 * e)
    cam = Cam(CamLaw((up, down)), radius - e, TranslatingFollower("flat"))
    contact = touch(cam, PHI)
    assert np.allclose(contact.radius_m, radius, rtol=1e-13)
    assert np.allclose(np.abs(contact.on_cam(contact.contact) - (-1j * e)), radius, rtol=1e-13)


def test_followers_without_a_place_are_refused() -> None:
    law = CamLaw((CamSegment("3-4-5", math.pi, 0.5), CamSegment("3-4-5", math.pi, -0.5)))
    with pytest.raises(ValueError, match=r"touches circles of 0\.02 to 0\.18 m"):
        Cam(law, 0.01, OscillatingFollower("knife", pivot_m=0.1, arm_m=0.08))
    with pytest.raises(ValueError, match="smaller offset"):
        Cam(law, 0.01, TranslatingFollower("knife", offset_m=0.011))
    with pytest.raises(CrankcheckError, match="dead positions are at 0 and 180"):
        touch(Cam(law, 0.175, OscillatingFollower("knife", pivot_m=0.1, arm_m=0.08)), PHI)
    quick = CamLaw((CamSegment("3-4-5", 0.5, 0.5), CamSegment("3-4-5", math.tau - 0.5, -0.5)))
    with pytest.raises(CrankcheckError, match=r"turns by 1\.6"):
        touch(Cam(quick, 0.03, OscillatingFollower("flat", pivot_m=0.1), -1), PHI)
    for arguments, text in (
        (("ball",), "no contact 'ball'"),
        (("roller",), "a radius above 0"),
        (("knife", 0.01), "others have none"),
        (("knife", 0.0, math.nan), "finite"),
    ):
        with pytest.raises(ValueError, match=text):
            TranslatingFollower(*arguments)
    for lengths, text in (({}, "above 0"), ({"pivot_m": 1.0, "face_m": 0.1}, "an arm above 0")):
        with pytest.raises(ValueError, match=text):
            OscillatingFollower("knife", **lengths)
    for base, sense, text in ((0.0, 1, "above 0"), (0.02, 2, "-1")):
        with pytest.raises(ValueError, match=text):
            Cam(law, base, TranslatingFollower("flat"), sense)
