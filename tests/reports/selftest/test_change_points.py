"""Faults in a run through change points are seen as they are elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

from models.hard import fourbar
from reports.selftest import trial
from reports.selftest.all_faults import FAULTS
from reports.selftest.fault import INSIDE
from tests.worlds.tiers import slowly

PARALLELOGRAM = replace(
    fourbar("parallelogram", 0.1, 0.3, 0.1, 0.3, source="Grashof's rule, equality"), branch={"C": 1}
)
EVEN = "what turns as its crank does comes out right to rounding in an engine too"
NO_FAULT_THERE = {
    "too-good-slider": "no slider",
    "halved-again": EVEN,
    "too-good-degrees": EVEN,
    "too-good-next": EVEN,
    "too-good-link": EVEN,
    "too-good-point": EVEN,
    "too-good-velocity": EVEN,
    "too-good-speeds": EVEN,
    "too-good-gaps": EVEN,
    "too-good-crank": EVEN,
    "too-good-finer": EVEN,
    "line-turned": "no slider",
    "origin-off": "no slider",
    "body-collides": "the post stands beside another rocker",
    "acceleration-late": "the rocker turns steadily, with no acceleration that could be late",
    "first-order": "parallel links have no error of angle, of first order or other: CC113 sees it",
}
PLANTED = [n for n, each in FAULTS.items() if n not in NO_FAULT_THERE and each.kind == "motion"]
"""Forces near change points are shown, and not judged."""


def places() -> Iterator[object]:
    """Each third fault in an engine, which are taken in turn; one inside an engine in each that can
    have it. The others are slow."""
    for number, name in enumerate(PLANTED):
        fault = FAULTS[name]
        for at, engine in enumerate(fault.engines):
            turn, left_over = divmod(number, 3)
            first = fault.group in INSIDE or (turn % len(fault.engines), 0) == (at, left_over)
            reason = "the same rule in another engine, or of a fault like others"
            yield (name, engine) if first else slowly(name, engine, reason=reason)


@pytest.mark.parametrize(("name", "engine"), list(places()))
def test_a_fault_in_a_run_through_change_points_fails_the_rule_that_it_names(
    name: str, engine: str
) -> None:
    place = trial._place(FAULTS[name], PARALLELOGRAM, engine, trial.STEPS, search=False)
    assert place.finding is not None, place.failed
    assert not place.false


def test_points_show_the_first_order_that_parallel_links_do_not() -> None:
    place = trial._place(FAULTS["first-order"], PARALLELOGRAM, "pymunk", trial.STEPS, search=False)
    assert {"CC105", "CC113"} <= set(place.failed)


def test_every_fault_that_is_left_out_is_one() -> None:
    assert set(NO_FAULT_THERE) <= set(FAULTS)
