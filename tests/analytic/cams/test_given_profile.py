"""The law found back from a profile, given as a function and by points."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.cams.given_profile import GivenProfile, interpolated
from analytic.cams.profile import Plane, touch
from models.array import Array
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw, CamSegment
from models.scene.cams import Cam, OscillatingFollower, TranslatingFollower
from tests.analytic.cams.designs import FOLLOWERS, designs

DEG = math.pi / 180.0
PHI = np.linspace(0.0, math.tau, 333, endpoint=False)


def without_jumps(cam: Cam, kind: str = "4-5-6-7") -> Cam:
    """The cam with a law of continuous jerk."""
    kinds = tuple(
        replace(one, kind=one.kind if one.kind == "dwell" else kind) for one in cam.law.segments
    )
    return replace(cam, law=CamLaw(kinds))


def profile_points(cam: Cam, phi: Array) -> Plane:
    contact = touch(cam, phi)
    return contact.on_cam(contact.contact)


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_the_law_is_found_back_from_a_profile_given_as_a_function(
    motion: str, contact: str
) -> None:
    for cam in designs(motion, contact, 2, seed=8):

        def curve(u: Array, cam: Cam = cam) -> tuple[Plane, Plane]:
            touched = touch(cam, math.tau * u)
            # The normal turned: a tangent without differences, also where the contact rests.
            return touched.on_cam(touched.contact), touched.on_cam(-1j * cam.sense * touched.normal)

        given = GivenProfile(curve, cam.follower, cam.sense)
        off = given.lift(PHI) - cam.law.at(PHI).value
        assert np.abs(off).max() < 1e-9 * cam.law.stroke
        assert given.base_m == pytest.approx(cam.base_m, rel=1e-12)


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_the_law_is_found_back_from_points_of_a_profile(motion: str, contact: str) -> None:
    turn = np.linspace(0.0, math.tau, 3600, endpoint=False)
    for number, design in enumerate(designs(motion, contact, 4, seed=9)):
        cam = without_jumps(design) if number < 2 else design
        points = profile_points(cam, turn)
        given = GivenProfile(
            interpolated(np.array([points.real, points.imag]).T), cam.follower, cam.sense
        )
        off = np.abs(given.lift(PHI) - cam.law.at(PHI).value)
        # A spline rings beside a jump of the acceleration, which the curvature repeats.
        jumps = np.array([one.angle_rad for one in cam.law.jumps if one.acceleration])
        near = np.abs(np.angle(np.exp(1j * (PHI[:, None] - jumps)))).min(axis=1, initial=1.0) < DEG
        assert off[~near].max() < (1e-6 if number >= 2 else 1e-10) * cam.law.stroke
        assert off.max() < 1e-3 * cam.law.stroke
        assert given.base_m == pytest.approx(cam.base_m, rel=1e-5)


def test_the_law_of_a_circle_off_its_centre_is_that_of_its_geometry() -> None:
    e, radius, roller = 0.01, 0.03, 0.008

    def circle(u: Array) -> tuple[Plane, Plane]:
        turn = np.exp(2j * np.pi * u)
        return e + radius * turn, 1j * turn

    flat = GivenProfile(circle, TranslatingFollower("flat"))
    assert np.allclose(flat.lift(PHI), e * (1 + np.sin(PHI)), rtol=0, atol=1e-12)
    assert flat.base_m == pytest.approx(radius - e, rel=1e-12)
    # With a roller the centres and the slide are a slider-crank of rod radius + roller.
    slide = GivenProfile(circle, TranslatingFollower("roller", roller)).lift(PHI)
    rod = radius + roller
    height = e * np.sin(PHI) + np.sqrt(rod**2 - (e * np.cos(PHI)) ** 2)
    assert np.allclose(slide, height - (rod - e), rtol=0, atol=1e-12)
    law = flat.law(rows=360)
    assert np.allclose(law.at(PHI).first, e * np.cos(PHI), rtol=0, atol=1e-10)
    cam = flat.cam(rows=360)
    points = profile_points(cam, PHI)
    assert np.allclose(np.abs(points - e), radius, rtol=0, atol=1e-9)


def test_rollers_too_large_for_a_concave_profile_and_other_faults_are_refused() -> None:
    rise, fall = (CamSegment("cycloidal", b, h) for b, h in ((1.2, 0.03), (math.tau - 1.2, -0.03)))
    cam = Cam(CamLaw((rise, fall)), 0.03, TranslatingFollower("roller", 0.005))
    turn = np.linspace(0.0, math.tau, 3600, endpoint=False)
    points = profile_points(cam, turn)
    curve = interpolated(np.array([points.real, points.imag]).T)
    radius = touch(cam, np.linspace(0.0, math.tau, 100_001)).radius_m
    least = -radius[radius < 0.0].max()
    with pytest.raises(CrankcheckError, match="give one below") as raised:
        GivenProfile(curve, TranslatingFollower("roller", 1.01 * least))
    assert float(str(raised.value).split()[-2]) == pytest.approx(least, rel=1e-4)
    GivenProfile(curve, TranslatingFollower("roller", 0.99 * least))
    with pytest.raises(CrankcheckError, match="a flat face touches does not fit: give a roller"):
        GivenProfile(curve, TranslatingFollower("flat"))
    with pytest.raises(CrankcheckError, match="another arm or pivot"):
        GivenProfile(curve, OscillatingFollower("knife", pivot_m=0.1, arm_m=0.06))
    with pytest.raises(CrankcheckError, match="a smaller offset"):
        GivenProfile(curve, TranslatingFollower("knife", offset_m=0.04))
    rows = np.array([points.real, points.imag]).T
    for bad, text in (
        (rows[:5], "24 or more"),
        (np.vstack([rows[:30], rows[29:]]), "points 30 and 31 of the profile are one"),
    ):
        with pytest.raises(CrankcheckError, match=text):
            interpolated(bad)
    closed = interpolated(np.vstack([rows, rows[:1]]))
    assert np.allclose(closed(PHI)[0], curve(PHI)[0], rtol=0, atol=1e-15)
    away = interpolated(rows + 0.2)
    with pytest.raises(CrankcheckError, match="round the cam's centre"):
        GivenProfile(away, TranslatingFollower("knife"))
