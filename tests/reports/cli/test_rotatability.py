"""`crankcheck rotatability`: tables, JSON, exit codes, refusals."""

from __future__ import annotations

import json

import pytest

from tests.worlds.command_line import crank


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
    assert "slider C ends at 0.2 m: crank and rod in line" in told.output
    told = crank("rotatability", "triad-platform", "--json")
    assert json.loads(told.output)["ends"] == []
