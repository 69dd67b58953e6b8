"""`crankcheck structure`, `chains` and `rotatability`: their tables, sheets and JSON."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from analytic.structure.mobility import analyse
from models.files import load_scene
from reports.face.assemblies import all_assemblies
from tests.worlds.command_line import crank
from tests.worlds.without_pdf import without_pdf


def test_groups_classes_and_assemblies_are_told() -> None:
    told = crank("structure", "sixbar-stephenson").output
    assert "the mechanism is of class II" in told
    assert "4 assemblies with crank at 90 deg" in told
    lines = told.splitlines()
    assert next(line for line in lines if "pin G of" in line).split()[6] == "III"
    assert next(line for line in lines if "pin A of" in line).startswith("*")


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "shaper", "tangent", "fourbar-crossed"])
def test_one_assembly_is_the_scenes_own(name: str) -> None:
    scene = load_scene(name)
    own = [one for one in all_assemblies(scene, analyse(scene), 0.6) if one.is_own]
    assert len(own) == 1
    assert all(scene.branch.get(key, 1) == number for key, number in own[0].branch.items())


def test_an_angle_out_of_reach_has_no_assembly() -> None:
    told = crank("structure", "fourbar-double-rocker", "--at-deg", "170")
    assert told.exit_code == 0
    assert "no assemblies with driver at 170 deg" in told.output


def test_assemblies_are_drawn(tmp_path: Path) -> None:
    file = tmp_path / "all.svg"
    assert crank("structure", "fourbar-lecture-1", "-o", str(file)).exit_code == 0
    drawn = file.read_text(encoding="utf-8")
    assert "branch: C +1; this scene's" in drawn
    assert "branch: C -1" in drawn


def test_chains_are_listed_with_their_assortments() -> None:
    told = crank("chains", "--links", "8").output
    assert told.startswith("16 chains of 8 links with mobility 1")
    assert [line.split()[-1] for line in told.splitlines()[-3:]] == ["9", "5", "2"]


def test_mechanisms_are_listed_with_their_class() -> None:
    told = crank("chains", "--inversions").output
    assert "2 chains of 6 links with mobility 1, 5 mechanisms" in told
    line = next(line for line in told.splitlines() if line.startswith("Stephenson II "))
    assert "class III or IV" in line


def test_types_are_listed() -> None:
    told = crank("chains", "--links", "4", "--sliders", "4").output
    assert [line.split()[0] for line in told.splitlines()[2:]] == ["RRRR", "RRRP", "RRPP", "RPRP"]


@pytest.mark.parametrize("ending", ["svg", "pdf"])
def test_a_sheet_of_chains_is_written(tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"chains.{ending}"
    with without_pdf():
        result = crank("chains", "--links", "4", "--sliders", "2", "--inversions", "-o", file)
    assert result.exit_code == 0
    assert "7 mechanisms" in result.output
    raw = file.read_bytes()
    assert b"layer-chains" in raw if ending == "svg" else raw.startswith(b"%PDF")


def test_json_holds_what_the_tables_say() -> None:
    table = crank("rotatability", "fourbar-lecture-1")
    assert "Grashof crank-rocker, margin 0.05 m" in table.output
    assert "60.0323" in table.output
    told = json.loads(crank("rotatability", "whitworth", "--json").output)
    assert told["rotations"][1]["turns"] == 1
    assert [branch["scene"] for branch in told["branches"]].count(True) == 1


@pytest.mark.parametrize(
    ("positions", "code", "word"),
    [(("30", "90"), 0, "led through"), (("30:+", "90:-"), 1, "a circuit defect")],
)
def test_the_exit_code_tells_a_defect(positions: tuple[str, str], code: int, word: str) -> None:
    options = [part for position in positions for part in ("--position", position)]
    result = crank("rotatability", "fourbar-lecture-1", *options)
    assert result.exit_code == code
    assert word in result.output


def test_the_branch_of_what_has_no_circuits_is_told_with_its_ends() -> None:
    told = crank("rotatability", "slider-crank-by-piston")
    assert told.exit_code == 0
    assert told.output.startswith("slider-crank-by-piston: the branch that it is on alone\n")
    assert "slider C ends at 0.2 m: crank and rod in line" in told.output
    told = crank("rotatability", "triad-platform", "--json")
    assert json.loads(told.output)["ends"] == []
