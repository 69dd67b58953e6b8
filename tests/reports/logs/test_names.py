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


SAID: dict[tuple[str, str, str], list[str]] = {
    ("rocker", "angle", "rad"): [
        "rocker.theta_rad", "rocker_theta_rad", "theta_rocker", "rocker", ".MODEL_1.rocker.ANGLE",
        "rocker.rotation.z", "/model/rocker.theta",
    ],
    ("rocker", "angle", "deg"): [
        "rocker_deg", "rocker angle [deg]", "Rocker (°)", "rockerAngle_deg", "RockerAngle(deg)",
        "rocker angle in degrees", "rocker/deg", "rocker angular displacement [deg]",
        "rocker angle/deg",
    ],
    ("rocker", "angular velocity", "rad/s"): [
        "rocker.omega_rad_s", "omega(rocker)", "rocker_rad_s", "rocker.angular_velocity.z",
        "rocker.angle.velocity.z", "rocker omega/rad/s",
    ],
    ("rocker", "angular velocity", "rpm"): ["Rocker Velocity [rpm]"],
    ("rocker", "angular velocity", "deg/s"): ["rocker angular velocity (deg/s)"],
    ("rocker", "angular acceleration", "rad/s^2"): [
        "rocker_alpha_rad_s2", "rocker acceleration [rad/s²]",
    ],
    ("C", "x", "mm"): ["C.x_mm", "xC [mm]", "C_x_mm on coupler"],
    ("C", "y", "in"): ["C pos y [in]"],
    ("C", "vx", "m/s"): ["C.vx_m_s"],
    ("C", "vx", "mm/s"): ["C x velocity [mm/s]"],
    ("C", "ay", "m/s^2"): ["C_ay_m_s2"],
    ("crank", "angle", "deg"): ["driver_deg"],
    ("C", "x", "m"): ["Cx"],
    ("C", "vy", "m/s"): ["vyC"],
}  # fmt: skip


@pytest.mark.parametrize(
    ("column", "said"), [(column, said) for said, columns in SAID.items() for column in columns]
)
def test_a_name_tells_body_kind_and_unit(column: str, said: tuple[str, str, str]) -> None:
    found = meaning(column, FOURBAR)
    assert isinstance(found, Meaning)
    assert (found.of, found.kind.name, found.unit) == said


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


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("rocker_rel_coupler_deg", {"of": "rocker", "relative_to": "coupler"}),
        ("coupler.C.x_m", {"of": "C", "on": "coupler"}),
        ("C_gap_mm", {"of": "C", "gap": True, "unit": "mm"}),
    ],
)
def test_a_name_tells_the_other_link_the_body_that_has_a_copy_and_a_gap(
    column: str, said: dict[str, object]
) -> None:
    found = meaning(column, FOURBAR)
    assert isinstance(found, Meaning)
    assert {name: getattr(found, name) for name in said} == said


NOTHING = ["rocker.z", "rocker_displacement_mm", "temperature", "C_deg", "C_v_m_s",
           "rocker_deg_filtered", "a", "coupler_rocker_deg"]  # fmt: skip


@pytest.mark.parametrize("column", NOTHING)
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


TIMES = {
    "s": ["time_s", "t", "Time (sec)", "simTime", "SimTime_s", "time in s", "t in s",
          "elapsed_time", "time/s"],
    "ms": ["time_ms", "t [ms]", "time in ms"],
}  # fmt: skip


@pytest.mark.parametrize("unit", TIMES)
def test_a_column_of_times_has_its_unit_and_may_be_that_of_velocities(unit: str) -> None:
    for column in TIMES[unit]:
        assert time_of(column) == ("time", unit), column
    assert time_of(f"velocity_time_{unit}") == ("velocity time", unit)
    assert time_of("rocker_deg") is None


def of_links(names: tuple[str, ...]) -> Scene:
    """The lecture's four-bar with other names of crank, coupler and rocker."""
    told = dict(zip(("crank", "coupler", "rocker"), names, strict=True))
    scene = load_scene("fourbar-lecture-1")
    links = {told[name]: replace(link, name=told[name]) for name, link in scene.links.items()}
    return replace(scene, links=links, driver=replace(scene.driver, link=told[scene.driver.link]))


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
def test_our_own_names_are_understood_whatever_bodies_are_called(names: tuple[str, ...]) -> None:
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
