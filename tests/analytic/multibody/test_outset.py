"""The start of a motion: what is named, what is found, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.multibody.release_multibody import release_multibody, start_state
from models.errors import CrankcheckError
from models.files import load_scene
from models.friction import ConstantFriction
from models.released import let_go
from tests.analytic.multibody.scenes import (
    DOUBLE_PENDULUM,
    FIVE_BAR,
    ROTOR,
    SLIDER_CRANK,
    THESIS,
    scene,
)
from tests.worlds.loading import loaded_mechanism


def test_angles_read_off_a_drawing_lead_to_the_assembly() -> None:
    start = start_state(scene(THESIS))
    assert math.degrees(start.theta["coupler"]) == pytest.approx(39.083, abs=1e-3)
    assert math.degrees(start.theta["rocker"]) == pytest.approx(123.855, abs=1e-3)
    assert math.degrees(start.theta["crank"]) == pytest.approx(90.0, abs=1e-12)


def test_one_named_angle_is_enough_where_it_leads_to_the_others() -> None:
    whole, named = (scene(THESIS.replace(cut, "")) for cut in ("", ", rocker = 124.0"))
    assert start_state(named).theta == pytest.approx(start_state(whole).theta, abs=1e-12)
    slid = SLIDER_CRANK + "start_deg = 30.0\n[start]\ndisplacements_m = { C = 0.383 }\n"
    bare = scene(SLIDER_CRANK + "start_deg = 30.0\n")
    near = solve(bare, np.zeros(1), bound=False).state()
    assert start_state(scene(slid)).theta == pytest.approx(near.theta, abs=1e-12)
    assert start_state(bare, near).displacement["C"] == pytest.approx(near.displacement["C"])


def test_a_start_of_two_freedoms_has_both_speeds() -> None:
    start = start_state(scene(FIVE_BAR))
    assert (start.omega["left"], start.omega["right"]) == pytest.approx((0.5, -0.5), abs=1e-13)
    assert start.position["C"][0] == pytest.approx(0.15, abs=1e-12)  # left and right are alike


def test_beside_a_limit_a_slow_driver_moves_the_others_fast() -> None:
    """What they are off by is rounding of their own rates, and not of the driver's."""
    scene_let_go = let_go(loaded_mechanism(81)[0], 1.0)
    driver = scene_let_go.driver
    law = replace(driver.law, speed_rad_s=-0.056)  # type: ignore[call-arg]
    slow = replace(scene_let_go, driver=replace(driver, law=law))
    near = solve(slow, np.zeros(1), bound=False).state()
    start = start_state(slow, near)
    assert max(abs(omega) for omega in start.omega.values()) > 1.0
    assert start.omega[driver.link] == pytest.approx(-0.056, rel=1e-6)


REFUSED = {
    "far": (
        THESIS.replace("39.0", "50.0"),
        r"coupler is 50 deg.* open there by 10\.9 deg: with dr",
    ),
    "open": (THESIS.replace("[1.0, 0.0]", "[3.0, 0.0]"), r"cannot be assembled.* open by 1\.5\d m"),
    "unnamed": (THESIS.split("[start]")[0], "where coupler, rocker start is not named"),
    "speeds": (
        THESIS + "rates_rad_s = { rocker = 1.0 }\n",
        "contradict each other.* is 1, and 0.8",
    ),
    "pendulum": (DOUBLE_PENDULUM.split("rates")[0], "1 of its freedoms have no speed"),
    "five-bar": (FIVE_BAR.split("rates")[0], "1 of its freedoms have no speed"),
    "slid too far": (
        SLIDER_CRANK + "start_deg = 30.0\n[start]\ndisplacements_m = { C = 0.5 }\n",
        r"start\.displacements_m\.C is 0\.5 m, and the joints are open there by 0\.118 m",
    ),
}


@pytest.mark.parametrize(("text", "said"), REFUSED.values(), ids=REFUSED)
def test_a_start_that_is_none_is_refused(text: str, said: str) -> None:
    with pytest.raises(CrankcheckError, match=said):
        start_state(scene(text))


def test_a_freedom_without_mass_is_refused() -> None:
    whole = scene(SLIDER_CRANK + "[start]\nangles_deg = { rod = 0.0 }\n")
    bare = replace(  # no file says so
        whole,
        links={n: replace(k, mass_kg=0.0, inertia_kg_m2=0.0) for n, k in whole.links.items()},
        sliders={n: replace(s, mass_kg=0.0, inertia_kg_m2=0.0) for n, s in whole.sliders.items()},
    )
    with pytest.raises(CrankcheckError, match="1 of its 1 freedoms moves nothing that has a mass"):
        start_state(bare)


def test_friction_a_change_point_and_what_is_rigid_are_refused() -> None:
    swing = load_scene("fourbar-swing")
    near = solve(swing, np.zeros(1), bound=False).state()
    rubbing = replace(swing, friction={"B": ConstantFriction("B", 0.1)})
    with pytest.raises(CrankcheckError, match="friction in B"):
        release_multibody(rubbing, 1.0, near=near)
    flat = THESIS.replace("0.15", "0.25").replace("90.0", "0.0")
    flat = flat.replace('["D", "C"], length_m = 0.75', '["D", "C"], length_m = 0.25')
    flat = flat.replace('["B", "C"], length_m = 0.75', '["B", "C"], length_m = 1.0')
    with pytest.raises(CrankcheckError, match="starts in a change point"):
        start_state(scene(flat.replace("39.0", "0.0").replace("124.0", "0.0")))
    held = ROTOR.replace("[0.0, 0.0] }", "[0.0, 0.0], B = [0.5, 0.0] }")
    with pytest.raises(CrankcheckError, match="nothing of it can move"):
        start_state(scene(held))
