"""What is planted in elastic links and beams is what is meant, and what need not be seen is not.

That each fault is caught by its rule and its size of 0 is not, `test_faults.py` says of all kinds.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from models.springs import PinSpring
from reports.judge.cell import check, examined
from reports.selftest.all_faults import FAULTS, chosen_faults
from reports.selftest.elastic_runs import (
    BEAM_RUNS,
    BENT,
    elastic_cell,
    truth_of_chain,
    truth_of_given,
)
from reports.selftest.logs import moved
from reports.selftest.segment_changes import (
    as_corrected,
    at_its_ends,
    of_as_many_springs,
    segments,
    springs,
)
from reports.selftest.trial import _passed, passes
from reports.selftest.unseen_elastic import UNSEEN_ELASTIC
from sim.run import run

ENGINE = "mujoco"
ELASTIC = [fault.name for fault in chosen_faults((), (ENGINE,), "elastic")]
CELL = elastic_cell(BENT, ENGINE)
GIVEN = truth_of_chain(CELL.scene).given


def test_without_a_fault_every_rule_passes_and_every_option_has_its_own_faults() -> None:
    assert passes(check(CELL))
    assert len(ELASTIC) >= 20
    assert not {*ELASTIC} & {fault.name for fault in chosen_faults((), (ENGINE,))}


@pytest.mark.parametrize("unseen", UNSEEN_ELASTIC, ids=lambda each: each.name)
def test_what_need_not_be_seen_of_elastic_links_is_not(unseen: object) -> None:
    passed = _passed(unseen, CELL.scene, (ENGINE,), 360, "elastic")  # type: ignore[arg-type]
    assert passed.failed == {ENGINE: ()}
    assert not passed.nothing


def test_the_exact_chain_handed_back_is_too_good_for_an_engine() -> None:
    """Its deflection is that of the chain to rounding, its places are off by the segments."""
    checked, _ = examined(CELL, FAULTS["chain-given"].plant(1.0))
    assert [finding.rule for finding in checked.failures] == ["CC111"]
    assert "segments is off by" in checked.failures[0].text


def test_the_springs_are_those_that_are_meant() -> None:
    first = next(iter(GIVEN.springs))

    def rate(changed: object) -> float:
        spring = springs(changed)(GIVEN, 1.0).springs[first]  # type: ignore[arg-type]
        assert isinstance(spring, PinSpring)
        return spring.rate / GIVEN.springs[first].rate  # type: ignore[union-attr]

    assert rate(of_as_many_springs) == pytest.approx(3.0 / 4.0)
    assert rate(as_corrected) == pytest.approx(1.0 + math.pi**2 / 192.0)


def test_a_rod_has_a_third_of_the_inertia_of_its_mass_in_two_ends() -> None:
    part = segments(at_its_ends)(GIVEN, 1.0).links["coupler-1"]
    length = 0.75 / 4.0
    assert part.inertia_kg_m2 == pytest.approx(part.mass_kg * length**2 / 4.0)


def test_a_moved_node_starts_with_its_segments_together() -> None:
    options = {"dt_s": CELL.dt_s, "steps": 8, "every": 1}
    start = truth_of_chain(CELL.scene).start
    plant = FAULTS["node-moved"].plant
    done = plant(0.1)(GIVEN, start, ENGINE, "tuned", **options)
    assert max(float(gap[0]) for gap in done.gaps.values()) < 1e-12
    none = moved(plant(0.0)(GIVEN, start, ENGINE, "tuned", **options))
    sound = moved(run(GIVEN, start, ENGINE, "tuned", **options))
    assert np.array_equal(none.links["coupler-1"].theta, sound.links["coupler-1"].theta)


BEAM_ENGINE = "exudyn"
BEAMS = [
    fault.name for fault in chosen_faults((), (BEAM_ENGINE,), "elastic") if fault.kind == "beam"
]


def test_without_a_fault_every_rule_passes_of_beams() -> None:
    cell = elastic_cell(BENT, BEAM_ENGINE, runs=BEAM_RUNS)
    assert cell.springs == "beam"
    assert truth_of_given(cell.given).given.beams
    assert passes(check(cell))


def test_an_engine_without_beams_has_none_of_their_faults() -> None:
    assert len(BEAMS) >= 9
    for engine in ("mujoco", "pymunk"):
        assert not any(FAULTS[name].possible(engine) for name in BEAMS)
