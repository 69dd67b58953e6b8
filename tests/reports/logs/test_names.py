"""What the names of columns say, as people write them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene
from models.scene import Scene
from reports.describe.frame import motion_frame
from reports.logs.names import meaning
from reports.logs.own_columns import LENGTH, Meaning
from reports.logs.scene_names import SceneNames
from reports.logs.time_columns import time_of

FOURBAR = SceneNames(load_scene("fourbar-lecture-1"))
SLIDER_CRANK = SceneNames(load_scene("slider-crank-central"))


@pytest.mark.parametrize(
    ("column", "body", "kind", "unit"),
    [
        ("rocker.theta_rad", "rocker", "angle", "rad"),
        ("rocker_theta_rad", "rocker", "angle", "rad"),
        ("rocker_deg", "rocker", "angle", "deg"),
        ("rocker angle [deg]", "rocker", "angle", "deg"),
        ("Rocker (°)", "rocker", "angle", "deg"),
        ("theta_rocker", "rocker", "angle", "rad"),
        ("rocker", "rocker", "angle", "rad"),
        ("rocker.omega_rad_s", "rocker", "angular velocity", "rad/s"),
        ("omega(rocker)", "rocker", "angular velocity", "rad/s"),
        ("Rocker Velocity [rpm]", "rocker", "angular velocity", "rpm"),
        ("rocker angular velocity (deg/s)", "rocker", "angular velocity", "deg/s"),
        ("rocker_rad_s", "rocker", "angular velocity", "rad/s"),
        ("rocker_alpha_rad_s2", "rocker", "angular acceleration", "rad/s^2"),
        ("rocker acceleration [rad/s²]", "rocker", "angular acceleration", "rad/s^2"),
        ("C.x_mm", "C", "x", "mm"),
        ("C pos y [in]", "C", "y", "in"),
        ("C.vx_m_s", "C", "vx", "m/s"),
        ("C x velocity [mm/s]", "C", "vx", "mm/s"),
        ("C_ay_m_s2", "C", "ay", "m/s^2"),
        ("driver_deg", "crank", "angle", "deg"),
        ("rockerAngle_deg", "rocker", "angle", "deg"),
        ("RockerAngle(deg)", "rocker", "angle", "deg"),
        ("rocker angle in degrees", "rocker", "angle", "deg"),
        (".MODEL_1.rocker.ANGLE", "rocker", "angle", "rad"),
        ("rocker/deg", "rocker", "angle", "deg"),
        ("Cx", "C", "x", "m"),
        ("xC [mm]", "C", "x", "mm"),
        ("vyC", "C", "vy", "m/s"),
        ("C_x_mm on coupler", "C", "x", "mm"),
        ("rocker.rotation.z", "rocker", "angle", "rad"),
        ("rocker.angular_velocity.z", "rocker", "angular velocity", "rad/s"),
        ("rocker.angle.velocity.z", "rocker", "angular velocity", "rad/s"),
        ("rocker angular displacement [deg]", "rocker", "angle", "deg"),
        ("/model/rocker.theta", "rocker", "angle", "rad"),
        ("rocker angle/deg", "rocker", "angle", "deg"),
        ("rocker omega/rad/s", "rocker", "angular velocity", "rad/s"),
    ],
)
def test_a_name_tells_body_kind_and_unit(column: str, body: str, kind: str, unit: str) -> None:
    found = meaning(column, FOURBAR)
    assert isinstance(found, Meaning)
    assert (found.of, found.kind.name, found.unit) == (body, kind, unit)


@pytest.mark.parametrize(
    ("column", "kind"),
    [
        ("C_slider_displacement_m", "displacement"),
        ("C_mm", "displacement"),
        ("C.s", "displacement"),
        ("C stroke [mm]", "displacement"),
        ("C.speed_mm_s", "speed"),
        ("C_slider_acceleration_m_s2", "acceleration"),
        ("C_x_m", "x"),
    ],
)
def test_a_slider_and_its_point_of_the_same_name_are_told_apart(column: str, kind: str) -> None:
    found = meaning(column, SLIDER_CRANK)
    assert isinstance(found, Meaning)
    assert found.kind.name == kind


def test_a_joint_s_angle_names_the_link_that_it_is_relative_to() -> None:
    found = meaning("rocker_rel_coupler_deg", FOURBAR)
    assert isinstance(found, Meaning)
    assert (found.of, found.relative_to) == ("rocker", "coupler")


def test_a_copy_of_a_pin_names_the_body_that_has_it() -> None:
    found = meaning("coupler.C.x_m", FOURBAR)
    assert isinstance(found, Meaning)
    assert (found.of, found.on) == ("C", "coupler")


def test_a_gap_is_a_length() -> None:
    found = meaning("C_gap_mm", FOURBAR)
    assert isinstance(found, Meaning)
    assert (found.gap, found.of, found.unit) == (True, "C", "mm")


@pytest.mark.parametrize(
    "column",
    [
        "rocker.z",
        "rocker_displacement_mm",
        "temperature",
        "C_deg",
        "C_v_m_s",
        "rocker_deg_filtered",
        "a",
        "coupler_rocker_deg",
    ],
)
def test_nothing_is_made_of_what_a_name_does_not_say(column: str) -> None:
    assert isinstance(meaning(column, FOURBAR), str)


@pytest.mark.parametrize(
    ("column", "words"),
    [
        ("rocker_deg [rad]", "deg and rad"),
        ("rocker_omega_rad", "rad is a unit of angle"),
        ("C.x_deg", "deg is a unit of angle"),
        ("C_gap_rad", "rad is a unit of angle"),
    ],
)
def test_units_that_contradict_are_refused(column: str, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        meaning(column, FOURBAR)


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("time_s", "s"),
        ("time_ms", "ms"),
        ("t", "s"),
        ("t [ms]", "ms"),
        ("Time (sec)", "s"),
        ("simTime", "s"),
        ("SimTime_s", "s"),
        ("time in s", "s"),
        ("t in s", "s"),
        ("elapsed_time", "s"),
        ("time in ms", "ms"),
        ("time/s", "s"),
    ],
)
def test_a_column_of_times_has_its_unit(column: str, unit: str) -> None:
    assert time_of(column) == ("time", unit)


def test_velocities_may_have_times_of_their_own() -> None:
    assert time_of("velocity_time_s") == ("velocity time", "s")
    assert time_of("rocker_deg") is None


def of_links(names: tuple[str, str, str]) -> Scene:
    """The lecture's four-bar with other names of crank, coupler and rocker."""
    told = dict(zip(("crank", "coupler", "rocker"), names, strict=True))
    scene = load_scene("fourbar-lecture-1")
    return replace(
        scene,
        links={told[name]: replace(link, name=told[name]) for name, link in scene.links.items()},
        driver=replace(scene.driver, link=told[scene.driver.link]),
    )


@pytest.mark.parametrize(
    "names",
    [
        ("t", "time", "s"),
        ("m", "deg", "rad"),
        ("Rocker", "rocker", "ROCKER"),
        ("gap", "slider", "rel"),
        ("velocity_time_s", "time_s", "theta"),
        ("A_x", "x", "A_x_m"),
    ],
)
def test_our_own_names_are_understood_whatever_bodies_are_called(
    names: tuple[str, str, str],
) -> None:
    scene = of_links(names)
    named = SceneNames(scene)
    motion = solve(scene, np.linspace(0.0, 0.1, 3))
    alone = replace(motion, links={}, points={}, sliders={}, bound=None)
    parts = [(body, replace(alone, links={body: one})) for body, one in motion.links.items()]
    parts += [(body, replace(alone, points={body: one})) for body, one in motion.points.items()]
    for body, part in parts:
        for column in (*motion_frame(part).columns[1:], f"{body}_gap_m"):
            _is_of(body, column, named)
            _is_of(body, f"{body}.{column[len(body) + 1 :]}", named)


def _is_of(body: str, column: str, named: SceneNames) -> None:
    """Fail where a column of ours is not understood to be of that body."""
    assert time_of(column) is None
    found = meaning(column, named)
    if column[len(body) + 1 :] in ("v_m_s", "a_m_s2"):
        assert found == LENGTH
    elif not column.endswith("gap_m") or body in named.points:
        assert isinstance(found, Meaning)
        assert (found.of, found.gap) == (body, column.endswith("gap_m"))


def test_the_case_of_a_name_tells_bodies_apart() -> None:
    named = SceneNames(of_links(("Rocker", "rocker", "ROCKER")))
    for body in ("Rocker", "rocker", "ROCKER"):
        found = meaning(f"{body} angle [deg]", named)
        assert isinstance(found, Meaning)
        assert found.of == body
    assert isinstance(meaning("rOcKer_deg", named), str)
