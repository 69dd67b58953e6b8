"""Straight-line linkages: the textbook's numbers, and the reference along the line."""

import cmath
import math
from collections.abc import Sequence

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.examine import examine
from analytic.lectures.synthesis.path.task import Complexes
from analytic.lectures.synthesis.straight_line import (
    TEXTBOOK,
    Kind,
    best_hoeken,
    hoeken,
    hoeken_of,
    straight_line,
)
from analytic.lectures.synthesis.straight_part import StraightLinkage, measured, peaucellier
from models.errors import CrankcheckError
from models.scene import Scene

KINDS: tuple[Kind, ...] = ("chebyshev", "watt", "roberts", "evans")

LINE = """
    20   0.00001  0.38  1.725 2.975 3.963 0.601
    60   0.00027  3.48  1.702 2.900 3.850 1.763
    100  0.004    9.90  1.646 2.725 3.588 2.790
    180  0.096   35.31  1.436 2.200 2.800 4.181
"""
"""R. L. Norton, Design of Machinery, table 3-1, optimized for straightness: the crank's range
[deg], the width of the band over the length [%], the change of speed [%], the speed, the ground and
the coupler over the crank, and the length over the crank."""
SPEED = """
    60   0.387 0.106
    120  0.752 1.885
    180  1.446 9.299
"""
"""The same table, optimized for constant velocity: range [deg], width and change of speed [%]."""


def rows(table: str) -> list[list[float]]:
    return [[float(each) for each in line.split()] for line in table.strip().splitlines()]


def by_reference(found: StraightLinkage, count: int = 301) -> Complexes:
    """Where the reference has the coupler point, from end to end of the part [m]."""
    examined = examine(found.proposal)
    assert not examined.defects
    return along_the_way(examined.scene, found.part.crank_rad, count)


def along_the_way(scene: Scene, ends: Sequence[float], count: int) -> Complexes:
    motion = solve_driven(scene, np.linspace(*ends, count), np.ones(1), np.zeros(1), bound=False)
    return motion.points["P"].position @ (1.0, 1j)


@pytest.mark.parametrize("row", rows(LINE), ids=lambda row: f"{row[0]:g}")
def test_hoeken_has_the_errors_of_the_textbook_and_the_straightest_no_larger_ones(
    row: list[float],
) -> None:
    turn, width, change, _, ground, coupler, length = row
    half = math.radians(turn / 2.0)
    part = measured(hoeken_of(ground), math.pi - half, math.pi + half)
    # The textbook's last digit, of the widths half a unit and of the others one in five hundred.
    last = 10.0 ** (math.floor(math.log10(width)) - (0 if width < 0.01 else 1))
    book = 200.0 * part.deviation_m / part.length_m
    assert book == pytest.approx(width, abs=0.6 * last)
    assert 100.0 * part.uneven == pytest.approx(change, rel=8e-3)
    assert part.length_m == pytest.approx(length, abs=6e-4)
    assert hoeken_of(ground).coupler == pytest.approx(coupler, abs=6e-4)
    if turn >= 60.0:
        four_bar, part = best_hoeken(turn / 360.0, "line")
        assert 0.85 * min(width, book) < 200.0 * part.deviation_m / part.length_m <= book
        assert four_bar.ground == pytest.approx(ground, abs=0.016)  # the table's steps are 0.025


@pytest.mark.parametrize("row", rows(SPEED), ids=lambda row: f"{row[0]:g}")
def test_the_evenest_hoeken_is_at_least_as_even_as_the_textbook_s(row: list[float]) -> None:
    turn, width, change = row
    _, part = best_hoeken(turn / 360.0, "speed")
    assert 0.85 * change < 100.0 * part.uneven <= change * 1.001
    assert 200.0 * part.deviation_m / part.length_m == pytest.approx(width, rel=0.06)


@pytest.mark.parametrize(("share", "even"), [(0.5, "line"), (0.3, "speed")])
def test_hoeken_by_the_reference(share: float, even: str) -> None:
    found = hoeken(0.4, share=share, even=even, start=1 - 2j, direction_rad=0.7)  # type: ignore[arg-type]
    along = (by_reference(found, 3001) - (1 - 2j)) * cmath.exp(-0.7j)
    assert along.real[-1] - along.real[0] == pytest.approx(0.4, rel=1e-9)
    assert np.max(np.abs(along.imag)) == pytest.approx(found.part.deviation_m, rel=2e-3)
    steps = np.diff(along.real)
    assert np.ptp(steps) / np.mean(steps) == pytest.approx(found.part.uneven, rel=3e-3)
    assert examine(found.proposal).grashof.endswith("crank-rocker")


def test_hoeken_by_its_deviation_takes_the_largest_share_that_keeps_it() -> None:
    found = hoeken(0.2, deviation=1e-4)
    assert 0.98e-4 < found.part.deviation_m / found.part.length_m <= 1e-4
    assert hoeken(0.2, deviation=1.0).part.share == pytest.approx(0.5)


@pytest.mark.parametrize("kind", KINDS)
def test_each_linkage_goes_along_its_line_by_the_reference(kind: Kind) -> None:
    found = straight_line(kind, 0.3, start=0.1 + 0.2j, direction_rad=-0.4)
    along = (by_reference(found) - (0.1 + 0.2j)) * cmath.exp(0.4j)
    assert along.real[0] == pytest.approx(0.0, abs=1e-9)
    assert along.real[-1] == pytest.approx(0.3, rel=1e-9)
    assert np.all(np.diff(along.real) > 0.0)
    largest = np.max(np.abs(along.imag))
    assert largest == pytest.approx(found.part.deviation_m, rel=2e-3)
    assert largest <= TEXTBOOK[kind].deviation * 0.3 * (1.0 + 1e-6)


def test_the_line_of_least_distance_can_not_be_turned_or_moved_for_the_better() -> None:
    found = straight_line("evans", 1.0)  # whose part is not symmetric
    places = found.four_bar.at(np.linspace(*found.part.crank_rad, 1001))
    least = np.max(np.abs(found.part.off(places)))
    for turn, way in ((1e-4, 0.0), (-1e-4, 0.0), (0.0, 1e-4), (0.0, -1e-4)):
        other = (places - 0.5) * cmath.exp(-1j * turn) + 0.5 - 1j * way
        assert np.max(np.abs(other.imag)) > least


def test_the_precision_positions_are_on_the_line_and_the_steps_draw_them() -> None:
    found = straight_line("evans", 0.5, direction_rad=math.pi / 2)
    examined = examine(found.proposal)
    assert len(examined.positions) >= 2
    assert max(examined.off) < 1e-9
    places = [position.asked[0].place for position in found.proposal.positions]  # type: ignore[union-attr]
    assert max(abs(place.real) for place in places[1:-1]) < 1e-12
    assert [place.imag for place in (places[0], places[-1])] == pytest.approx([0.0, 0.5], abs=1e-9)
    assert max(abs(place.real) for place in places) <= found.part.deviation_m * (1.0 + 1e-9)
    assert len(found.proposal.steps) == 3


def test_peaucellier_leads_along_the_line_exactly_by_the_reference() -> None:
    proposal = peaucellier(0.3, start=0.1 + 0.2j, direction_rad=0.4)
    examined = examine(proposal)
    assert not examined.defects
    ends = [examined.positions[k].driver_rad for k in (0, -1)]
    along = (along_the_way(examined.scene, ends, 301) - (0.1 + 0.2j)) * cmath.exp(-0.4j)
    assert along.real[[0, -1]] == pytest.approx([0.0, 0.3], abs=1e-12)
    assert np.max(np.abs(along.imag)) < 1e-13


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: straight_line("watt", 0.0), "straight part of 0 m"),
        (lambda: straight_line("watt", 1.0, deviation=-1.0), "deviation of -1"),
        (lambda: straight_line("roberts", 1.0, deviation=1e-6), "1e-06 of its length"),
        (lambda: peaucellier(-1.0), "straight part of -1 m"),
        (lambda: hoeken(1.0, share=0.2, deviation=1e-3), "follow from each other"),
        (lambda: hoeken(1.0, share=0.6), "over 0.6 of the crank's turn"),
        (lambda: hoeken(1.0, deviation=1e-12), "keeps it over less than"),
    ],
)
def test_what_can_not_be_is_refused(ask, told: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(CrankcheckError, match=told):
        ask()
