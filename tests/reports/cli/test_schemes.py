"""`crankcheck joint` and `crankcheck mobility`: what they say, and what they refuse."""

from __future__ import annotations

from pathlib import Path

import pytest

from models.scheme_files import SCHEMES, shipped_schemes
from models.touching import CONTACTS, shipped_contacts
from tests.worlds.command_line import crank, flat, refused

FOURBAR = (SCHEMES / "four-bar.toml").read_text(encoding="utf-8")
GEARS = (SCHEMES / "gear-pair.toml").read_text(encoding="utf-8")
CAM = (SCHEMES / "cam-flat-follower.toml").read_text(encoding="utf-8")
HOOKE = (SCHEMES / "hooke.toml").read_text(encoding="utf-8")
SHAFTS = (SCHEMES / "cardan-shaft.toml").read_text(encoding="utf-8")
LINE = (CONTACTS / "line-contact.toml").read_text(encoding="utf-8")


def test_a_joint_is_told_by_its_contact_and_by_its_guides() -> None:
    said = flat(crank("joint", "crossed-cylinders").output)
    assert "touches point: a higher pair" in said
    assert "alone class 1, leaves Qx, Qy, Qz, Ty, Tz; a force must keep the two together" in said
    assert "guided class 4, leaves Qz, Tz, where its neighbours leave Qz, Tz" in said
    assert "joint class 5, leaves Qz Q:" in flat(crank("joint", "revolute").output)


def test_a_scheme_is_told_by_count_and_rank_with_names() -> None:
    said = flat(crank("mobility", "parallelogram-third-crank").output)
    assert "count W = 3 n - 2 p5 - p4 = 3*4 - 2*6 - 1*0 = 0, with n = 4 moving links" in said
    assert "rank 11 of 12 constraints are independent" in said
    assert "mobility W = 1 passive 1 constraint: link crank-3 may be left out" in said
    said = flat(crank("mobility", "rssr").output)
    assert "mobility W = 2, 1 without what is idle" in said
    assert "idle 1 freedom: coupler: turns about the line through B and C" in said
    said = flat(crank("mobility", "parallelogram-flat").output)
    assert "W = 1; 2 in the drawn position, which is singular" in said
    assert "gives back: the scheme shakes" in flat(crank("mobility", "stretched-bars").output)


def test_all_that_ships_is_listed() -> None:
    joints, schemes = flat(crank("joint").output).split(), flat(crank("mobility").output).split()
    assert set(shipped_contacts()) <= set(joints)
    assert set(shipped_schemes()) <= set(schemes)


def test_a_scheme_with_lower_pairs_alone_is_shown_and_written(tmp_path: Path) -> None:
    path = tmp_path / "lower.toml"
    result = crank("mobility", "cam-flat-follower", "--replace", "-o", str(path))
    assert result.exit_code == 0
    said = flat(result.output)
    assert "replaced B by pin B-1 (cam, B-link) at (0.02, 0.01) m, slider B-2" in said
    assert "= 3*3 - 2*4 - 1*0 = 1; mobility 1" in said
    assert "mobility W = 1" in flat(crank("mobility", str(path)).output)
    again = crank("mobility", str(path), "--replace")
    assert (again.exit_code, "no higher pair" in again.output) == (2, True)


def test_what_the_file_says_of_the_mobility_is_held_against_it(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text(FOURBAR.replace("mobility = 1", "mobility = 2"), encoding="utf-8")
    assert "mobility W = 1; the file says 2" in flat(crank("mobility", str(path)).output)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (FOURBAR.replace('kind = "pin"', 'kind = "pim"', 1), "found 'pim'; did you mean pin?"),
        (FOURBAR.replace('"pin"', '"revolute"', 1), "joints.A: axis: missing; a revolute joint"),
        (FOURBAR.replace('"rocker"], kind', '"roker"], kind', 1), "no link roker; did you mean"),
        (FOURBAR.replace('["ground", "crank"]', '["crank", "crank"]'), "found crank twice"),
        (FOURBAR.replace("at_m = [0.0, 0.0]", "at_m = [0.0]"), "joints.A.at_m: found [0.0]"),
        (FOURBAR.replace("at_m = [0.0, 0.0]", "at_m = [0.0, 0.0, 0.0]"), "planar schemes have 2"),
        (FOURBAR.replace("at_m = [0.0, 0.0]", "at_m = [nan, 0.0]"), "found nan"),
        (FOURBAR.replace("[0.0, 0.0]", "[0.0, 0.0], axis = [0, 1]"), "axis: not of a pin joint"),
        (FOURBAR.replace('"rocker"]', '"rocker", "rod"]', 1), "leads from ground to rod; join it"),
        (FOURBAR.replace('"rocker"]', '"crank"]', 1), "a name stands there twice"),
        (FOURBAR.replace('"rocker"]', '"ground"]', 1), "ground is always there"),
        (FOURBAR.replace('"planar"', '"flat"'), "space: found 'flat'; input should be 'planar' or"),
        (FOURBAR.replace("mobility = 1", "weight = 1"), "weight: unknown key"),
        (FOURBAR.partition("[joints]")[0], "joints: missing"),
        (FOURBAR + "?", "not valid TOML"),
        (HOOKE.replace("axis = [1.0, 0.0, 0.0]", "axis = [0, 0, 0]"), "of length 0; give a direct"),
        (SHAFTS.replace("[-0.1, 0.3, 0.0]", "[0.0, 0.0, -3.0]", 1), "axes: the two are parallel"),
        (GEARS.replace("[0.05, 0.1]", "[0.05, 0.2]"), "0.15 m apart, where the pitch circles"),
        (GEARS.replace("[0.05, 0.1]", "[0.05, -0.04]"), "with a smaller radius"),
        (GEARS.replace("[0.05, 0.1]", "[0.0, 0.15]"), "give the radii of two pitch circles"),
        (GEARS.replace("radii_m", "pressure_deg = 90.0, radii_m"), "found 90; use 5 to 45"),
        (CAM.replace("[0.04, inf]", "[inf, inf]"), "that is a slider"),
        (CAM.replace("[0.04, inf]", "[0.04, -0.04]"), "that is a pin"),
        (CAM.replace("[0.04, inf]", "[0.04, nan]"), "radii_m"),
    ],
)
def test_a_faulty_scheme_is_refused_with_one_message(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "faulty.toml"
    path.write_text(text, encoding="utf-8")
    result = crank("mobility", path)
    refused(result, says)
    assert len(result.output.splitlines()) <= 3


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (LINE.replace('"line"', '"lines"'), "found 'lines'; did you mean line?"),
        (LINE.replace("normal = [0.0, 1.0, 0.0]", "normal = [0.0, 0.0, 0.0]"), "of length 0"),
        (LINE.replace("along = [1.0, 0.0, 0.0]", "along = [1.0, 1.0, 0.0]"), "not across the norm"),
        (LINE.replace("along", "axis"), "along: missing"),
        (LINE + "lead_m = 0.1", "lead_m: not of a line contact"),
        (LINE + '[guided.here]\nleaves = ["Qq"]', "guided.here.leaves.0: found 'Qq'"),
        (LINE.partition("[[")[0], "contacts: missing"),
    ],
)
def test_a_faulty_joint_is_refused_with_one_message(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "faulty.toml"
    path.write_text(text, encoding="utf-8")
    refused(crank("joint", path), says)
