"""`crankcheck chains`: lists, sheets, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import Result

from tests.worlds.command_line import crank
from tests.worlds.without_pdf import without_pdf


def chains(*arguments: object) -> Result:
    return crank("chains", *arguments)


def test_chains_are_listed_with_their_assortments() -> None:
    told = chains("--links", "8").output
    assert told.startswith("16 chains of 8 links with mobility 1")
    assert [line.split()[-1] for line in told.splitlines()[-3:]] == ["9", "5", "2"]


def test_mechanisms_are_listed_with_their_class() -> None:
    told = chains("--inversions").output
    assert "2 chains of 6 links with mobility 1, 5 mechanisms" in told
    line = next(line for line in told.splitlines() if line.startswith("Stephenson II "))
    assert "class III or IV" in line


def test_types_are_listed() -> None:
    told = chains("--links", "4", "--sliders", "4").output
    assert [line.split()[0] for line in told.splitlines()[2:]] == ["RRRR", "RRRP", "RRPP", "RPRP"]


@pytest.mark.parametrize("ending", ["svg", "pdf"])
def test_a_sheet_is_written(tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"chains.{ending}"
    with without_pdf():
        result = chains("--links", "4", "--sliders", "2", "--inversions", "-o", file)
    assert result.exit_code == 0
    assert "7 mechanisms" in result.output
    raw = file.read_bytes()
    assert b"layer-chains" in raw if ending == "svg" else raw.startswith(b"%PDF")
