"""The references are whole: every command with every option, every name of the face."""

from __future__ import annotations

import re

import crankcheck
from crankcheck import engine, testing
from docs.site.commands_page import commands_page
from docs.site.docstrings import one_by_one
from docs.site.python_pages import face_page, others_page, theory_rooms
from docs.site.staging import ROOT
from tests.worlds.command import COMMAND
from tests.worlds.documents import ran


def test_every_command_stands_there_with_every_option() -> None:
    told = dict(re.findall(r"^## (crankcheck [\w ]+)\n(.*?)(?=^## )", commands_page(), re.S | re.M))
    listed = ran([COMMAND, "--help"], ROOT).stdout
    names = re.findall(r"^│ ([a-z]+) ", listed, re.M)
    assert len(names) > 20
    for name in names:
        assert any(called.split()[1] == name for called in told)
    for called in ("crankcheck verify", "crankcheck polygon", "crankcheck engines check"):
        shown = ran([COMMAND, *called.split()[1:], "--help"], ROOT).stdout
        options = set(re.findall(r"(?<![\w-])--[a-z][\w-]+", shown)) - {"--help"}
        assert options <= set(re.findall(r"--[a-z][\w-]+", told[called])), called


def test_options_are_told_with_defaults_and_limits() -> None:
    page = commands_page()
    assert "| `--at-deg DEG` | `60.0` | The driver's angle. |" in page
    assert (
        "| `--jobs <int range>` | `0` | Processes; 0: one per processor. (`0<=x<=1024`) |" in page
    )
    assert r"NAME=1\|-1" in page
    assert "130 interrupted" in page


def test_every_public_name_has_its_entry() -> None:
    entries = set(re.findall(r"^::: (\S+)$", face_page(), re.M))
    faces = {f"crankcheck.{name}" for name in crankcheck.__all__ if name != "__version__"}
    assert faces <= entries
    assert {f"crankcheck.testing.{name}" for name in testing.__all__} <= entries
    for name in engine.__all__:
        assert f"crankcheck.engine.{name}" in entries or f"`{name}`" in face_page()


def test_modules_beside_the_theory_are_shown_where_a_page_names_them() -> None:
    page = others_page({"a.md": "[models.scene.Scene][] and [x][analytic.kinematics.solve]"})
    assert page.startswith("## models.scene\n\n::: models.scene\n")
    assert "analytic" not in page


def test_every_room_of_the_theory_has_a_page() -> None:
    rooms = theory_rooms(ROOT)
    assert {"dyads", "kinematics", "free"} <= set(rooms)
    assert len(rooms) == len(set(rooms))


def test_parameters_told_together_are_told_one_by_one() -> None:
    """So that each has the type and the default of its own."""
    told = one_by_one(
        "A.\n\nParameters\n----------\na, b\n    As of c.\nd : int\n    D.\n\nAn, end."
    )
    assert "\na\n    As of c.\nb\n    As of c.\nd : int\n    D.\n" in told
    assert told.startswith("A.\n")
    assert told.endswith("\n\nAn, end.")
