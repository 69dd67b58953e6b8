"""`crankcheck solve --family`: a workbook, a page or a drawing of mechanisms side by side."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import Result

from tests.worlds.command_line import crank, refused
from tests.worlds.tiers import slowly


def family(scene: str, members: str, file: Path, *more: str) -> Result:
    return crank("solve", scene, "--family", members, "-o", file, *more)


@pytest.mark.parametrize(
    ("ending", "begins"),
    [(".xlsx", b"PK"), (".html", b"<!doctype html>"), (".svg", b"<?xml"), (".pdf", b"%PDF")],
)
@pytest.mark.parametrize(
    ("scene", "members"),
    [("slotted-lever", "R=0.1,0.12"), slowly("shaper", "rod=0.2,0.3", reason="the same writers")],
)
def test_the_ending_says_what_is_written(
    scene: str, members: str, ending: str, begins: bytes, tmp_path: Path
) -> None:
    file = tmp_path / f"family{ending}"
    result = family(scene, members, file, "--steps-per-turn", "8", "--turns", "1.5")
    assert result.exit_code == 0, result.output
    assert result.output.strip() == f"{file}: 2 members of {scene}, 13 rows"
    assert file.read_bytes().startswith(begins)


REFUSED = {
    "fourbar-elastic": "has elastic links",
    "fourbar-swing": "is let go",
    "fourbar-lecture-1 --at-deg 3": "--family with --at-deg",
    "fourbar-lecture-1 --forces": "--family with --forces",
    "fourbar-lecture-1 --clockwise": "--family with --clockwise",
    "fourbar-lecture-1 --along C:0": "--family with --along",
    "fourbar-lecture-1 --steps 9": "--steps 9: fourbar-lecture-1 is driven",
    "fourbar-lecture-1 --modes 2": "--modes: fourbar-lecture-1 has no elastic links",
    "fourbar-lecture-1 --turns 100": "36001 rows of 2 members; at most 20000",
    "fourbar-lecture-1 --family BC=0.25,nan": "write a name and numbers",
    "fourbar-lecture-1 --family BC": "write a name and numbers",
    "fourbar-lecture-1 --family BC=0.25,0.01": "BC=0.01: this member cannot be",
    "fourbar-lecture-1 -o f.csv": "found '.csv'; use .xlsx, .html, .svg, .pdf",
}


@pytest.mark.parametrize("line", REFUSED)
def test_what_can_not_be_asked_of_a_family_is_one_message(line: str, tmp_path: Path) -> None:
    scene, *more = line.split()
    refused(family(scene, "BC=0.25,0.3", tmp_path / "f.xlsx", *more), REFUSED[line])
    assert list(tmp_path.iterdir()) == []


def test_a_family_without_a_file_names_those_that_it_may_have() -> None:
    result = crank("solve", "slotted-lever", "--family", "R=0.1,0.12")
    refused(result, "-o FILE.xlsx, FILE.html, FILE.svg, FILE.pdf")
