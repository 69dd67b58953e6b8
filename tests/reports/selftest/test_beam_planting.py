"""Beams of an engine's own, as faults are planted in them: sound without, and where there are any.

That each fault is caught by its rule and its size of 0 is not, `test_faults.py` says of all kinds.
"""

from __future__ import annotations

from reports.judge.cell import check
from reports.selftest.all_faults import FAULTS, chosen_faults
from reports.selftest.elastic_runs import BEAM_RUNS, BENT, elastic_cell, truth_of_given
from reports.selftest.trial import passes

ENGINE = "exudyn"
BEAMS = [fault.name for fault in chosen_faults((), (ENGINE,), "elastic") if fault.kind == "beam"]


def test_without_a_fault_every_rule_passes() -> None:
    cell = elastic_cell(BENT, ENGINE, runs=BEAM_RUNS)
    assert cell.springs == "beam"
    assert truth_of_given(cell.given).given.beams
    assert passes(check(cell))


def test_an_engine_without_beams_has_none_of_their_faults() -> None:
    assert len(BEAMS) >= 9
    for engine in ("mujoco", "pymunk"):
        assert not any(FAULTS[name].possible(engine) for name in BEAMS)
