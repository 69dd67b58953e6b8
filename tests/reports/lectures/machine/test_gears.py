"""`crankcheck gears`: the tables, the document, and what is refused."""

import json
from pathlib import Path

import pytest

from tests.models.scene.test_gears import PLANETARY
from tests.worlds.command_line import crank, refused, told


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "planetary.toml"
    path.write_text(PLANETARY)
    return path


def test_speeds_torques_and_forces_are_those_of_willis_and_of_radii(scene: Path) -> None:
    """Sun 10 rad/s of 20 teeth in a ring of 100: arm 10/6; two planets' sides in balance."""
    document = json.loads(told("gears --torque arm=-6 --planets 3 --json", scene))
    members = {row["body"]: row for row in document["members"]}
    assert {name: row["ratio"] for name, row in members.items()} == {
        "ground": "0", "sun": "1", "planet": "-1/4", "arm": "1/6"}  # fmt: skip
    assert members["arm"]["speed_rad_s"] == pytest.approx(10 / 6)
    # Sun drives with the arm at rest, 0.98 in one mesh: arm = sun (1 + 5 x 0.98).
    sun = 6.0 / (1.0 + 5.0 * 0.98)
    assert members["sun"]["torque_n_m"] == pytest.approx(sun)
    assert members["ground"]["torque_n_m"] == pytest.approx(6.0 - sun)
    assert document["efficiency"] == pytest.approx((1.0 + 5.0 * 0.98) / 6.0)
    inner, outer = document["meshes"]
    assert inner["tangential_n"] == pytest.approx(sun / 0.02)
    assert inner["radial_n"] / inner["tangential_n"] == pytest.approx(0.36397, rel=1e-5)
    assert outer["tangential_n"] == pytest.approx(0.98 * sun / 0.02)
    assert document["planets"][0]["numbers"] == [1, 2, 3, 4]
    assert "3 planets share the loads" in document["notes"][-1]


def test_tables_of_the_members(scene: Path) -> None:
    said = told("gears --speed sun=6 --torque arm=-6", scene)
    assert "planetary: gear train of mobility 1, efficiency 0.983333" in said
    assert "inner: sun 20 40 37.5877 44 35 3.14159 1.63519" in " ".join(said.split())
    assert told("gears", scene).count("no torques: give --torque BODY=N_M") == 1


@pytest.mark.parametrize(("options", "message"), [
    ("--speed sun", "--speed 'sun': give BODY=NUMBER, such as sun=10"),
    ("--speed moon=1", "--speed 'moon=1': no such body; use sun, planet"),
    ("--speed sun=1 --speed sun=2", "sun is given twice"),
    ("--speed sun=1 --speed arm=2", "not independent, as + 1 omega_sun - 6 omega_arm = 0"),
    ("--torque sun=1", "torque on sun: it closes the balance; use planet, arm"),
    ("--planets 7", "(20 + 100)/7 = 17.1429 has to be a whole number; "
     "numbers that work: 1, 2, 3, 4"),
    ("--shift planet=0.1", "do not mesh at a centre distance of 60 mm; theirs is 60.1976 mm"),
])  # fmt: skip
def test_faulty_requests_are_refused(scene: Path, options: str, message: str) -> None:
    refused(crank("gears", scene, *options.split()), message)


def test_teeth_that_undercut_and_scenes_without_gears_are_refused(scene: Path) -> None:
    small = PLANETARY.replace("[20, 40]", "[10, 50]")
    scene.write_text(small)
    refused(crank("gears", scene), "10 teeth of sun undercut at 20 degrees; 18 or more do not")
    refused(crank("gears", "fourbar-lecture-1"), "no gears; give the scene a [gears.NAME] table")
