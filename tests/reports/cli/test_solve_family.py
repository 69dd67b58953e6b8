"""`crankcheck solve --family`: a workbook, a page or a drawing of mechanisms side by side."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import Result

from tests.worlds.command_line import crank
from tests.worlds.tiers import slowly


def family(scene: str, members: str, file: Path, *more: str) -> Result:
    return crank("solve", scene, "--family", members, "-o", file, *more)


@pytest.mark.parametrize(
    ("ending", "begins"),
    [(".xlsx", b"PK"), (".html", b"<!doctype html>"), (".svg", b"<?xml"), (".pdf", b"%PDF")],
)
@pytest.mark.parametrize(
    ("scene", "members"),
    [
        ("slotted-lever", "R=0.1,0.12"),
        slowly("shaper", "rod=0.2,0.3", reason="members of two loops"),
    ],
)
def test_the_ending_says_what_is_written(
    scene: str, members: str, ending: str, begins: bytes, tmp_path: Path
) -> None:
    file = tmp_path / f"family{ending}"
    result = family(scene, members, file, "--steps-per-turn", "8", "--turns", "1.5")
    assert result.exit_code == 0, result.output
    assert result.output.strip() == f"{file}: 2 members of {scene}, 13 rows"
    assert file.read_bytes().startswith(begins)
