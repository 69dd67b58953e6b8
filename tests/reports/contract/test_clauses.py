"""Every clause is seen to break by a fault of its own, and by hardly any other's."""

from __future__ import annotations

import pytest

from reports.contract.clauses import CLAUSES
from reports.contract.ruling import put_to
from sim.registry import engine
from tests.worlds.tiers import slow
from tests.worlds.wrong_engines import FAULTS, late_accelerations

FOURBAR = ("fourbar-lecture-1",)
OF_FORCES = {"EC81", "EC82", "EC83", "EC84", "EC85", "EC86"}
"""Forces follow from the motion, and one that is wrong is wrong in more than one of these."""


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_breaks_its_clause(name: str) -> None:
    clause, words, fault, _ = FAULTS[name]
    breaches = put_to(fault(engine("pymunk")), CLAUSES[clause], FOURBAR).breaches
    assert any(words in text for text in breaches), breaches


@slow("each fault put to all clauses: whether they are independent")
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_breaks_hardly_any_other_clause(name: str) -> None:
    clause, _, fault, besides = FAULTS[name]
    wrong = fault(engine("pymunk"))
    rulings = [put_to(wrong, one, FOURBAR) for one in CLAUSES.values()]
    broken = {ruling.id: ruling.breaches for ruling in rulings if ruling.breaches}
    assert set(broken) - {clause} <= besides | OF_FORCES, broken


def test_accelerations_of_another_instant_are_seen() -> None:
    ruling = put_to(late_accelerations(engine("mujoco")), CLAUSES["EC42"], FOURBAR)
    assert "is that of -1.00 steps, and acceleration_shift says +0.00" in ruling.breaches[0]


def test_every_clause_has_a_fault_and_says_all_that_it_has_to() -> None:
    assert {clause for clause, *_ in FAULTS.values()} == set(CLAUSES)
    for clause in CLAUSES.values():
        assert all((clause.title, clause.why, clause.cure))
        assert clause.why.endswith(".")
        assert clause.cure.endswith(".")
