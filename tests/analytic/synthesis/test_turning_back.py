"""What goes to and fro turns back where it was asked to, in the times that were asked for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.mechanism.travel import travel
from analytic.synthesis.asked import AskedSlide
from analytic.synthesis.examine import examine
from analytic.synthesis.solutions import followed, solutions_of
from analytic.synthesis.strokes import stroke_proposals
from models.errors import CrankcheckError
from models.tasks.quick_return import QuickReturnTask
from models.tasks.stroke import StrokeTask
from tests.analytic.synthesis.random_tasks import HEAD, random_solutions
from tests.worlds.tiers import few

RATIOS = ("stroke_and_ratio", "slotted_lever", "whitworth", "crank_rocker")


@pytest.mark.parametrize("number", few(range(2), [0], "another random task"))
@pytest.mark.parametrize("kind", RATIOS)
def test_the_reference_measures_the_time_ratio_that_was_asked_for(kind: str, number: int) -> None:
    found = random_solutions(kind, number)
    assert isinstance(found.task, (StrokeTask, QuickReturnTask))
    assert found.sound
    for one in found.sound[:3]:
        measured = travel(one.scene, one.proposal.turns_back).time_ratio
        assert measured == pytest.approx(found.task.time_ratio, rel=1e-8)
        assert f"time ratio {measured:.6g}" in one.notes[-1]


def test_a_turn_that_is_claimed_wrongly_is_a_fault() -> None:
    """Two places of a slider that it passes, and does not turn back in."""
    (proposal,), _ = stroke_proposals(StrokeTask(**HEAD, stroke_m=0.2, rod_m=0.5))
    first, last = proposal.positions
    passed = 0.1 * math.cos(0.3) + math.sqrt(0.25 - (0.1 * math.sin(0.3)) ** 2) - 0.4
    short = replace(last, driver_rad=0.3, asked=(AskedSlide("B", passed),))
    one = followed(examine(replace(proposal, positions=(first, short))))
    assert max(one.off) < 1e-14
    assert one.defects == ["goes 0.2 m, time ratio 1: take a longer rod"]


@pytest.mark.parametrize(
    "ratio",
    few([1.000001, 2.9, 2.99, 2.995], [2.995], "the other limit is no harder"),
)
def test_ratios_near_their_limits_keep_their_digits(ratio: float) -> None:
    task = StrokeTask(**HEAD, stroke_m=0.1, form="offset", time_ratio=ratio)
    found = solutions_of(task)
    assert len(found.sound) == 12
    for one in found.sound:
        assert max(one.off) < 1e-15 / one.least_sine**2
        folded, stretched = (position.driver_rad for position in one.positions)
        forth = (stretched - folded) % (2.0 * np.pi)
        assert max(forth, 2.0 * np.pi - forth) / min(forth, 2.0 * np.pi - forth) == pytest.approx(
            ratio, rel=1e-13
        )


def test_a_ratio_that_hardly_transmits_is_refused() -> None:
    task = StrokeTask(**HEAD, stroke_m=0.1, form="offset", time_ratio=2.9999)
    with pytest.raises(CrankcheckError, match="has one below 3, and transmits"):
        solutions_of(task)


def test_offsets_of_a_nanometre_keep_their_digits() -> None:
    task = StrokeTask(**HEAD, stroke_m=0.1, form="offset", time_ratio=1.0001, offset_m=1e-9)
    (one,) = solutions_of(task).sound
    through_m = one.scene.sliders["B"].through_m
    assert -through_m[1] == pytest.approx(1e-9, rel=1e-12)
    assert max(one.off) < 1e-14
