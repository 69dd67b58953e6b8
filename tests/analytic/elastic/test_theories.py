"""Where theories of elastic links part: the linear one with the speed, a chain by its length."""

from __future__ import annotations

import pytest

from benchmarks.elastic_theories import row
from models.files import load_scene
from tests.worlds.tiers import slow


@slow("the numbers of the benchmark themselves: two seconds for a row of them")
def test_the_linear_theory_errs_more_than_a_chain_of_four_segments() -> None:
    told = row(load_scene("fourbar-elastic"), 5.5, (4,), (4,))
    assert told["linear"] == pytest.approx(0.0564, abs=2e-4)
    assert told["chain 4"] == pytest.approx(0.0497, abs=2e-4)  # 0.80 / 4^2
    assert told["corrected 4"] < 0.2 * told["chain 4"]
    assert told["stiffened"] < 1e-3
    assert told["beam 4"] == pytest.approx(1.1e-3, rel=0.2)
