"""Where characteristics are not smooth, in all periods."""

from __future__ import annotations

import pytest

from models.staircase import Staircase
from models.tabulated import Tabulated


@pytest.mark.parametrize("last_row", [0.03, 0.05], ids=["open period", "closed period"])
def test_a_table_repeats_its_kinks(last_row: float) -> None:
    table = Tabulated((0.0, 0.02, last_row), (1.0, -1.0, 1.0), period=0.05)
    wanted = [0.0, 0.02, 0.03, 0.05, 0.07, 0.08] if last_row < 0.05 else [0.0, 0.02, 0.05, 0.07]
    assert list(table.kinks_between(0.0, 0.09)) == pytest.approx(wanted)
    before = list(table.kinks_between(-0.05, 0.0))
    assert before[0] == -0.05
    assert before[-1] == 0.0


def test_steps_that_happen_once_are_told_within_alone() -> None:
    assert list(Staircase((0.1, 0.2, 0.3), (1.0, 0.0, 2.0)).kinks_between(0.15, 0.3)) == [0.2, 0.3]
