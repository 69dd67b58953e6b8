"""Commands on mechanisms that a slider drives, or the pin of two moving links."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.worlds.command_line import crank, flat
from tests.worlds.tiers import few

PISTON, COUPLER = "slider-crank-by-piston", "fourbar-by-coupler"
SHOWN: dict[str, Sequence[str]] = {
    f"solve {PISTON} --at-m 0.35 --forces": [
        "force power drive on N W slider C -3.7271082 -2.7891124", "C 0.35000000 0.74833148"
    ],
    f"solve {PISTON} --forces": ["driving force 15.4", "slider C at"],
    f"graph {PISTON} --of rod": ["no. C m phi rad", "12 0.30000"],
    f"graph {COUPLER} --of rocker": ["no. coupler deg"],
}  # fmt: skip


@pytest.mark.parametrize("line", SHOWN)
def test_the_driver_is_told_in_its_own_words_and_units(line: str) -> None:
    told = crank(*line.split())
    assert told.exit_code == 0, told.output
    assert [text for text in SHOWN[line] if text not in flat(told.output)] == []


@pytest.mark.parametrize("scene", few([PISTON, COUPLER], [PISTON], "a pin between two links"))
def test_positions_are_numbered_along_what_is_driven(scene: str, tmp_path: Path) -> None:
    sheet = tmp_path / "sheet.svg"
    told = crank("positions", scene, "-o", sheet)
    assert told.exit_code == 0, told.output
    assert f"12 positions of {scene}" in told.output
    assert "locus-B" in sheet.read_text(encoding="utf-8")


def test_what_a_slider_drives_is_drawn_with_its_forces_and_logged_in_newtons(
    tmp_path: Path,
) -> None:
    assert crank("view", PISTON, "--forces", "-o", tmp_path / "motion.png").exit_code == 0
    log = tmp_path / "log.csv"
    assert crank("solve", PISTON, "--forces", "-o", log).exit_code == 0
    heads = log.read_text(encoding="utf-8").partition("\n")[0].split(",")
    assert "drive_force_n" in heads
    assert "torque_n_m" not in heads
