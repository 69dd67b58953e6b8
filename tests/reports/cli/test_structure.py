"""`crankcheck structure`, `chains`, `rotatability`, `joint`, `mobility`, `polygon` and `graph`:
tables, sheets, JSON, and what is refused. More of what they tell is in `test_told.py`."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.files.reading import load_scene
from models.lectures.scheme_files import SCHEMES, shipped_schemes
from models.lectures.touching import CONTACTS, shipped_contacts
from reports.lectures.drawing.structure import all_assemblies
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.tiers import slow


@pytest.mark.parametrize("name", ["shaper", "fourbar-crossed"])
def test_one_assembly_is_the_scenes_own(name: str) -> None:
    scene = load_scene(name)
    (own,) = (one for one in all_assemblies(scene, analyse(scene), 0.6) if one.is_own)
    assert all(scene.branch.get(key, 1) == number for key, number in own.branch.items())


def test_sheets_are_drawn_and_told_of(tmp_path: Path) -> None:
    assert "at 90 deg, on 297 x 210 mm" in told(
        "polygon fourbar-lecture-1 -o", tmp_path / "polygons.svg"
    )
    assert b"layer-velocity-1" in (tmp_path / "polygons.svg").read_bytes()
    chains = tmp_path / "chains.svg"
    assert "7 mechanisms" in told("chains --links 4 --sliders 2 --inversions -o", chains)
    assert b"layer-chains" in chains.read_bytes()
    told("structure fourbar-lecture-1 -o", tmp_path / "all.svg")
    drawn = (tmp_path / "all.svg").read_text(encoding="utf-8")
    assert "branch: C +1; this scene's" in drawn
    assert "branch: C -1" in drawn


def test_json_holds_what_the_tables_say() -> None:
    found = json.loads(told("rotatability whitworth --json"))
    assert found["rotations"][1]["turns"] == 1
    assert [branch["scene"] for branch in found["branches"]].count(True) == 1
    assert json.loads(told("rotatability triad-platform --json"))["ends"] == []


@slow("a second, in which all are worked out; one of each is told in test_told.py")
def test_all_that_ships_is_listed() -> None:
    assert set(shipped_contacts()) <= set(flat(told("joint")).split())
    assert set(shipped_schemes()) <= set(flat(told("mobility")).split())


def test_a_scheme_with_lower_pairs_alone_is_shown_and_written(tmp_path: Path) -> None:
    path = tmp_path / "lower.toml"
    said = flat(told("mobility cam-flat-follower --replace -o", path))
    assert "replaced B by pin B-1 (cam, B-link) at (0.02, 0.01) m, slider B-2" in said
    assert "= 3*3 - 2*4 - 1*0 = 1; mobility 1" in said
    assert "mobility W = 1" in flat(told("mobility", path))
    assert "no higher pair" in told("mobility --replace", path, code=2)


FOURBAR, GEARS, CAM, HOOKE, SHAFTS = (
    (SCHEMES / f"{name}.toml").read_text(encoding="utf-8")
    for name in ("four-bar", "gear-pair", "cam-flat-follower", "hooke", "cardan-shaft")
)
LINE = (CONTACTS / "line-contact.toml").read_text(encoding="utf-8")


def test_what_the_file_says_of_the_mobility_is_held_against_it(tmp_path: Path) -> None:
    path, stated = tmp_path / "wrong.toml", re.compile("^mobility = 1$", re.M)
    for line, of in (("mobility", FOURBAR), ("mobility --replace", CAM)):
        path.write_text(stated.sub("mobility = 2", of), encoding="utf-8")
        assert "mobility W = 1; the file says 2" in flat(told(line, path, code=1))
        path.write_text(stated.sub("", of), encoding="utf-8")
        told(line, path)


OF_SCHEMES = [
    (FOURBAR.replace('kind = "pin"', 'kind = "pim"', 1), "found 'pim'; did you mean pin?"),
    (FOURBAR.replace('"pin"', '"revolute"', 1), "joints.A: axis: missing; a revolute joint"),
    (FOURBAR.replace('"rocker"], kind', '"roker"], kind', 1), "no link roker; did you mean"),
    (FOURBAR.replace('["ground", "crank"]', '["crank", "crank"]'), "found crank twice"),
    (FOURBAR.replace("at_m = [0.0, 0.0]", "at_m = [0.0, 0.0, 0.0]"), "planar schemes have 2"),
    (FOURBAR.replace("[0.0, 0.0]", "[0.0, 0.0], axis = [0, 1]"), "axis: not for a pin joint"),
    (FOURBAR.replace('"rocker"]', '"rocker", "rod"]', 1), "leads from ground to rod; join it"),
    (FOURBAR.replace('"rocker"]', '"ground"]', 1), "ground is always there"),
    (FOURBAR.partition("[joints]")[0], "joints: missing"),
    (FOURBAR + "?", "not valid TOML"),
    (HOOKE.replace("axis = [1.0, 0.0, 0.0]", "axis = [0, 0, 0]"), "of length 0; give a direct"),
    (SHAFTS.replace("[-0.1, 0.3, 0.0]", "[0.0, 0.0, -3.0]", 1), "axes: the two are parallel"),
    (GEARS.replace("[0.05, 0.1]", "[0.05, 0.2]"), "0.15 m apart, where the pitch circles"),
    (GEARS.replace("[0.05, 0.1]", "[0.0, 0.15]"), "give the radii of two pitch circles"),
    (GEARS.replace("radii_m", "pressure_deg = 90.0, radii_m"), "found 90; use 5 to 45"),
    (CAM.replace("[0.04, inf]", "[inf, inf]"), "that is a slider"),
    (CAM.replace("[0.04, inf]", "[0.04, -0.04]"), "that is a pin"),
]
OF_JOINTS = [
    (LINE.replace("along = [1.0, 0.0, 0.0]", "along = [1.0, 1.0, 0.0]"), "not across the norm"),
    (LINE.replace("along", "axis"), "along: missing"),
    (LINE + "lead_m = 0.1", "lead_m: not of a line contact"),
    (LINE + '[guided.here]\nleaves = ["Qq"]', "guided.here.leaves.1: found 'Qq'"),
    (LINE.partition("[[")[0], "contacts: missing"),
]


@pytest.mark.parametrize(("text", "says"), [*OF_SCHEMES, *OF_JOINTS])
def test_a_faulty_scheme_or_joint_has_a_short_message(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "faulty.toml"
    path.write_text(text, encoding="utf-8")
    result = crank("joint" if (text, says) in OF_JOINTS else "mobility", path)
    refused(result, says)
    assert len(result.output.splitlines()) <= 3


def test_a_log_is_drawn_beside_and_that_of_another_scene_refused(tmp_path: Path) -> None:
    """Rows in which C stands and moves as the reference has it, but for 1 mm/s."""
    motion = solve(load_scene("fourbar-lecture-1"), np.arange(0.0, 0.7, 0.01), bound=False)
    point = motion.points["C"]
    rows = np.column_stack([motion.time_s, point.position, point.velocity + np.array([1e-3, 0])])
    log = tmp_path / "run.csv"
    head = "time_s,C_x_m,C_y_m,C_vx_m_s,C_vy_m_s"
    np.savetxt(log, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    said = told("polygon fourbar-lecture-1 --at-deg 90 --log", log)
    assert "crank at 90.9634 deg, t = 0.63 s in" in flat(said)
    assert "as the log reports them: errors" in said
    assert "by central differences of logged positions" in said
    row = next(line.split() for line in said.splitlines() if line.startswith("C "))
    assert row[5:] == ["0.001", "0.1", "0.000"]
    other = crank("polygon", "slider-crank-central", "--log", log)
    refused(other, "in its first row, t = 0 s, y of C (column 'C_y_m') is")


def test_orders_are_fitted_and_the_log_of_an_engine_ends_in_its_own_error(tmp_path: Path) -> None:
    # That an engine's log goes through: `run` writes it, and names and instants are its own.
    log, sheet = tmp_path / "run.csv", tmp_path / "orders.svg"
    told("run fourbar-lecture-1 --engine pymunk --profile as-shipped --turns 1 -o", log)
    said = told("graph fourbar-lecture-1 --of rocker --divisions 24,48,96 --log", log, "-o", sheet)
    first, *_, last, floor = (line.split() for line in said.splitlines())
    assert first[0] == f"{sheet}:"
    assert (last[0], last[1]) == ("order", "1.99")
    assert last[3:] == ["-"] * 4  # of the log, in 96 parts: its own error is most of it
    assert "approach its own" in " ".join(floor)
    assert "reference, omega: order 1.99" in sheet.read_text(encoding="utf-8")
