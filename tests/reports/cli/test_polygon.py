"""`crankcheck polygon`: the table, the sheet, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from reports.cli import app


def polygon(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["polygon", *arguments])


def test_the_vectors_are_told_in_the_order_of_drawing() -> None:
    told = polygon("fourbar-lecture-1", "--at-deg", "90").output
    vectors = [line.split()[0] for line in told.splitlines() if line.startswith(("v_", "a^"))]
    assert vectors == [
        *("v_BA", "v_CB", "v_CD"),
        *("a^n_BA", "a^n_CB", "a^t_CB", "a^n_CD", "a^t_CD"),
    ]
    assert "perpendicular to BC" in told
    assert "velocity polygon, 0.01 m/s to the mm" in told


def test_the_sheet_is_written_and_told_of(tmp_path: Path) -> None:
    file = tmp_path / "sheet.svg"
    result = polygon("fourbar-lecture-1", "-o", str(file))
    assert result.exit_code == 0
    assert "at 90 deg, on 297 x 210 mm" in result.output
    assert b"layer-velocity-1" in file.read_bytes()


def test_a_limit_position_is_drawn_as_far_as_it_is_determined() -> None:
    # coupler and rocker in line: cos phi = (0.25^2 + 0.3^2 - 0.4^2) / (2 0.25 0.3)
    told = polygon("fourbar-double-rocker-swing", "--omega", "1", "--at-deg", "92.8659829").output
    assert "v_BA" in told


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("fourbar-lecture-1", "--k", "0"), "--k 0: give a number above 0"),
        (("fourbar-lecture-1", "--k", "nan"), "--k nan: give a number"),
        (("fourbar-lecture-1", "--k", "50"), "larger paper, or a smaller --k"),
        (("fourbar-lecture-1", "--omega", "0"), "other than 0"),
        (("fourbar-lecture-1", "--omega", "inf"), "other than 0"),
        (("fourbar-lecture-1", "--turn"), "give -o FILE.gif"),
        (("fourbar-lecture-1", "--paper", "B9"), "no size; use A5"),
        (("fourbar-lecture-1", "--at-deg", "nan"), "give an angle in degrees"),
        (("fourbar-lecture-1", "-o", "sheet.png"), "use .svg, .pdf, .gif"),
        (("fourbar-swing",), "its driver is let go"),
        (("fourbar-swing", "--at-deg", "nan", "--omega", "1"), "give an angle in degrees"),
        (("double-pendulum", "--omega", "1"), "mobility"),
        (("fourbar-double-rocker", "--at-deg", "180"), "deg"),
    ],
)
def test_what_can_not_be_drawn_is_refused(arguments: tuple[str, ...], told: str) -> None:
    result = polygon(*arguments)
    assert result.exit_code != 0
    message = result.output + str(result.exception)
    assert told in " ".join(message.split())
