"""Base circles: undercutting where a dense search finds it, and limits that are just kept."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from analytic.cams.cam_design import (
    CamLimits,
    least_cam,
    refuse_undercut,
    sharpest,
    steepest,
)
from analytic.cams.profile import touch
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw, CamSegment
from models.scene.cams import Cam, OscillatingFollower, TranslatingFollower
from tests.analytic.cams.designs import FOLLOWERS, designs
from tests.worlds.tiers import slowly


def least(cam: Cam, *limits: float) -> float:
    return least_cam(cam.law, cam.follower, cam.sense, CamLimits(*limits)).base_m


DENSE = np.linspace(0.0, math.tau, 40_001)


@pytest.mark.parametrize(("motion", "contact"), FOLLOWERS)
def test_undercutting_is_found_where_a_dense_search_finds_it(motion: str, contact: str) -> None:
    for cam in designs(motion, contact, 2, seed=3):
        most, phi = sharpest(cam)
        found = touch(cam, DENSE)
        flat = cam.follower.is_flat
        searched = -found.radius_m if flat else 1.0 / found.pitch_radius_m
        scale = cam.base_m if flat else 1.0 / cam.base_m
        assert -1e-13 * scale <= most - searched.max() < 1e-3 * scale
        # A search around the angle found, of steps of 1e-9 of a turn, finds no more.
        near = touch(cam, phi + np.linspace(-1e-5, 1e-5, 2001))
        closest = -near.radius_m if flat else 1.0 / near.pitch_radius_m
        assert closest.max() - most <= 1e-12 * scale


@pytest.mark.parametrize(
    ("motion", "contact"),
    [
        each if number % 3 == 0 else slowly(*each, reason="as one of each motion")
        for number, each in enumerate(each for each in FOLLOWERS if each[1] != "knife")
    ],
)
def test_a_cam_that_undercuts_is_refused_with_the_radius_from_which_it_does_not(
    motion: str, contact: str
) -> None:
    refused = 0
    for sound in designs(motion, contact, 3, seed=1):
        spans = (0.8, 0.4, 1.0, math.tau - 2.2)
        law = CamLaw(
            tuple(
                replace(
                    one, span_rad=span, lift=4.0 * one.lift if motion == "oscillating" else one.lift
                )
                for one, span in zip(sound.law.segments, spans, strict=True)
            )
        )
        cam, roller = replace(sound, law=law), 1.2 * law.stroke if contact == "roller" else 0.0
        if motion == "translating":
            cam = replace(
                cam, base_m=0.4 * law.stroke, follower=TranslatingFollower(contact, roller)
            )
        elif contact == "roller":
            cam = replace(cam, follower=replace(cam.follower, roller_m=0.6 * cam.base_m))
        try:
            refuse_undercut(cam)
        except CrankcheckError as error:
            if "no base radius" in str(error):
                continue
            limit = float(re.findall(r"from a base radius of (\S+) m on", str(error))[0])
            refused += 1
        else:
            continue
        small = touch(replace(cam, base_m=limit * (1 - 1e-3)), DENSE)
        assert (small.radius_m[small.pitch_radius_m > 0.0] < 0.0).any() or contact == "flat"
        assert contact == "roller" or (small.radius_m < 0.0).any()
        for more in (1e-6, 1e-2, 0.05) if motion == "oscillating" else (1e-6, 1e-2, 0.1, 1.0, 10.0):
            large = replace(cam, base_m=limit * (1 + more))
            assert CamLimits().margin(large) > 0.0
            refuse_undercut(large)
    assert refused


def test_the_base_radius_of_a_convex_flat_faced_cam_is_the_closed_form() -> None:
    # rho = r_b + s + s'': harmonic rise of h over b: s + s'' is least at its end,
    # h - h/2 (pi/b)^2. Norton, Design of Machinery, eq. 8.36.
    h, b = 0.02, math.radians(90)
    rest = CamSegment("dwell", math.pi - b)
    law = CamLaw((CamSegment("harmonic", b, h), rest, CamSegment("harmonic", b, -h), rest))
    cam = Cam(law, 0.01, TranslatingFollower("flat"))
    closed = 0.5 * h * (math.pi / b) ** 2 - h
    said = r"undercuts at (90|180) deg .* from a base radius of 0\.02 m on it does not"
    with pytest.raises(CrankcheckError, match=said):
        refuse_undercut(cam)
    assert least(cam) == pytest.approx(closed, rel=1e-12)
    assert least(cam, math.inf, math.inf, 0.005) == pytest.approx(closed + 0.005, rel=1e-12)


def test_the_base_circle_of_a_permitted_pressure_angle_just_keeps_it() -> None:
    law = CamLaw((CamSegment("cycloidal", 1.5, 0.02), CamSegment("3-4-5", math.tau - 1.5, -0.02)))
    permitted = math.radians(30)
    for sense in (1, -1):
        cam = Cam(law, 0.3, TranslatingFollower("roller", 0.01, 0.008), sense)
        base = least(cam, permitted)
        s, first, *_ = law.at(DENSE)
        rising = first >= 0.0
        start = (np.abs(sense * first - 0.008) / math.tan(permitted) - s)[rising].max()
        assert base == pytest.approx(math.hypot(start, 0.008) - 0.01, rel=1e-7)
        angle, _ = steepest(replace(cam, base_m=base), rising=True)
        assert angle == pytest.approx(permitted, rel=1e-12)
        # A limit for the return as well is never a smaller circle.
        assert least(cam, permitted, math.radians(10)) >= base
    swing = CamLaw(tuple(replace(one, lift=10 * one.lift) for one in law.segments))
    arm = Cam(swing, 0.05, OscillatingFollower("roller", 0.01, pivot_m=0.12, arm_m=0.1))
    base = least(arm, math.radians(40), math.radians(40))
    found = touch(replace(arm, base_m=base), DENSE).pressure_rad
    assert np.abs(found).max() == pytest.approx(math.radians(40), rel=1e-8)
    with pytest.raises(CrankcheckError, match="the nearest to it is"):
        least(arm, math.radians(1), math.radians(1))


def test_a_law_whose_velocity_drops_has_no_base_circle_but_for_a_knife_edge() -> None:
    law = CamLaw((CamSegment("uniform", math.pi, 0.02), CamSegment("uniform", math.pi, -0.02)))
    with pytest.raises(CrankcheckError, match="drops at 180 deg, where only a knife edge"):
        refuse_undercut(Cam(law, 0.1, TranslatingFollower("roller", 0.01)))
    refuse_undercut(Cam(law, 0.1, TranslatingFollower("knife")))
