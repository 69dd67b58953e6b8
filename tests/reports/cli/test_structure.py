"""`crankcheck structure`: the words, the sheet, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import Result

from analytic.structure.mobility import analyse
from models.files import load_scene
from reports.face.assemblies import all_assemblies
from tests.worlds.command_line import crank


def structure(*arguments: object) -> Result:
    return crank("structure", *arguments)


def test_groups_classes_and_assemblies_are_told() -> None:
    told = structure("sixbar-stephenson").output
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
    told = structure("fourbar-double-rocker", "--at-deg", "170")
    assert told.exit_code == 0
    assert "no assemblies with driver at 170 deg" in told.output


def test_assemblies_are_drawn(tmp_path: Path) -> None:
    file = tmp_path / "all.svg"
    assert structure("fourbar-lecture-1", "-o", str(file)).exit_code == 0
    drawn = file.read_text(encoding="utf-8")
    assert "branch: C +1; this scene's" in drawn
    assert "branch: C -1" in drawn
