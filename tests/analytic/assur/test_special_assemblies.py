"""Triads of special dimensions: what they are known to have, exactly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from analytic.assur.assemblies import assemblies
from analytic.assur.leg_rows import AngleRow, CircleRow, LegRow, LegRows, LineRow, ThroughRow
from analytic.assur.shared_line import ContinuumError
from models.errors import CrankcheckError
from models.scene import Point
from tests.analytic.assur.drawn_rows import MOST, drawn
from tests.analytic.assur.homotopy import real, solutions
from tests.worlds.tiers import slowly

SIX_PINS = ("RR", "RR", "RR")
UP, ALONG = (0.0, 1.0), (1.0, 0.0)


def counted(*rows: LegRow) -> list[tuple[float, float, float, int]]:
    """Angle, place and count of all assemblies."""
    return [(one.angle_rad, *one.place, one.count) for one in assemblies(rows)]  # type: ignore[arg-type]


def circles(a: list[Point], pins: list[Point], lengths: list[float]) -> LegRows:
    one, two, three = map(CircleRow, a, pins, lengths)
    return one, two, three


def six_real() -> LegRows:
    """A triad of six pins with six assemblies, of those that are drawn."""
    seed = next(seed for seed in range(200) if len(assemblies(drawn(SIX_PINS, seed))) == 6)
    return drawn(SIX_PINS, seed)


def test_half_a_turn_is_found_exactly() -> None:
    # at phi = pi and P = (5, 6): inner pins (4, 6), (5, 5), (8, 2)
    rows = circles([(1, 0), (0, 1), (-3, 4)], [(0, 3), (5, 0), (8, 10)], [5, 5, 8])
    assert (math.pi, 5.0, 6.0, 1) in counted(*rows)


def test_a_singular_pose_is_counted_twice_and_splits_or_vanishes_beside_it() -> None:
    """All three legs point to the origin: the determinant is 0 at phi = 0, P = 0."""
    a, pins = [(3.0, 4.0), (1.0, 0.0), (0.0, -1.0)], [(6.0, 8.0), (3.0, 0.0), (0.0, -3.0)]
    every = counted(*circles(a, pins, [5, 2, 2]))
    assert [one for one in every if one[3] == 2] == [(0.0, 0.0, 0.0, 2)]

    def beside(change: float) -> list[float]:
        found = counted(*circles(a, pins, [5 + change, 2, 2]))
        return [angle for angle, _, _, count in found if abs(angle) < 1e-3 and count == 1]

    apart = sorted((beside(1e-14), beside(-1e-14)), key=len)
    assert [len(one) for one in apart] == [0, 2], "a fold"
    assert apart[1][0] == pytest.approx(-apart[1][1], rel=1e-3)


def test_two_rows_of_one_line_leave_what_the_third_takes() -> None:
    """The plate slides on y = 0, and its own line lies there too at half turns of it."""
    rows = LineRow((0, 0), UP, (0, 0)), ThroughRow(UP, (0, 0), (2, 0))
    half = math.pi
    assert counted(*rows, CircleRow((1, 0), (0, 3), 5)) == [
        *((0.0, -5.0, 0.0, 1), (0.0, 3.0, 0.0, 1)),
        *((half, -3.0, 0.0, 1), (half, 5.0, 0.0, 1)),
    ]
    touching = counted(*rows, CircleRow((1, 0), (0, 5), 5))
    assert [one for one in touching if one[3] == 2] == [(0.0, -1.0, 0.0, 2), (half, 1.0, 0.0, 2)]
    assert [one[1:] for one in touching if one[3] == 1] == [(2.0, 0.0, 1)] * 2
    assert counted(*rows, CircleRow((1, 0), (0, 6), 5)) == []


def test_an_assembly_that_comes_to_such_an_angle_is_counted_with_those_there() -> None:
    rows = LineRow((0, 0), UP, (0, 0)), ThroughRow(UP, (0, 0), (2, 0))
    assert counted(*rows, CircleRow((2, 0), (0, 3), 5)) == [
        (pytest.approx(math.atan2(-12, -5), rel=1e-15), 2.0, 0.0, 1),
        *((0.0, -6.0, 0.0, 1), (0.0, 2.0, 0.0, 2)),
        *((math.pi, -2.0, 0.0, 1), (math.pi, 6.0, 0.0, 1)),
    ]


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 2, 0), (2, 0, 1)])
def test_parallel_guides_hold_the_angle(order: tuple[int, int, int]) -> None:
    """Two pins of a plate on y = 0 and y = 1, sqrt(2) apart; the third leg decides."""
    lines = LineRow((0, 0), UP, (0, 0)), LineRow((1, 1), UP, (7, 1))
    for last, places in (
        (CircleRow((0, 0), (0, 3), 5), (-4.0, 4.0)),
        (LineRow((0, 0), ALONG, (2, 0)), (2.0,)),
    ):
        rows = [(*lines, last)[i] for i in order]
        expected = [(phi, x, 0.0, 1) for phi in (0.0, math.pi / 2) for x in places]
        assert counted(*rows) == expected


def test_a_limit_between_parallel_guides_counts_twice_at_each_place() -> None:
    """The guides are as far apart as the two pins: the link stands across."""
    lines = LineRow((0, 0), UP, (0, 0)), LineRow((1, 0), UP, (0, 1))
    half = math.pi / 2
    assert counted(*lines, LineRow((0, 0), ALONG, (2, 0))) == [(half, 2.0, 0.0, 2)]
    assert counted(*lines, CircleRow((0, 0), (0, 3), 5)) == [
        *((half, -4.0, 0.0, 2), (half, 4.0, 0.0, 2)),
    ]
    assert counted(*lines, CircleRow((0, 0), (0, 5), 5)) == [(half, 0.0, 0.0, 4)]


def test_an_angle_at_which_all_lines_are_parallel_and_apart_is_none() -> None:
    rows = (
        LineRow((0, 0), UP, (0, 0)),
        ThroughRow(UP, (0, 0), (2, 1)),
        ThroughRow(UP, (0, 1), (5, 3)),
    )
    # 2 cos phi - 3 sin phi = 1, by the difference of the last two
    middle, off = math.atan2(-3, 2), math.acos(1 / math.sqrt(13))
    angles = [one.angle_rad for one in assemblies(rows)]
    assert angles == pytest.approx([middle - off, middle + off], rel=1e-15)


def test_three_parallel_guides_leave_the_link_loose_or_hold_it_nowhere() -> None:
    guides = LineRow((0, 0), UP, (0, 0)), LineRow((1, 0), UP, (0, 0))
    assert counted(*guides, LineRow((0, 1), UP, (0, 5))) == []
    with pytest.raises(ContinuumError, match="can move while"):
        counted(*guides, LineRow((0, 1), UP, (0, 1)))


def test_a_parallelogram_moves_and_with_unequal_legs_it_does_not() -> None:
    points = [(0.0, 0.0), (2.0, 0.0), (1.0, 3.0)]
    pins = [(4.0, 0.0), (6.0, 0.0), (5.0, 3.0)]
    with pytest.raises(ContinuumError):
        counted(*circles(points, pins, [2, 2, 2]))
    rows = circles(points, pins, [2, 2.5, 2.25])
    own = assemblies(rows)
    other = real(solutions(rows, 6))
    assert len(own) == len(other) > 0
    assert [one.angle_rad for one in own] == pytest.approx(list(other[:, 0]), abs=1e-9)


def test_one_leg_twice_moves_and_two_lengths_between_the_same_pins_are_none() -> None:
    one, two = CircleRow((1, 0), (3, 0), 2), CircleRow((0, 1), (0, 4), 3)
    with pytest.raises(ContinuumError):
        counted(one, one, two)
    for other in (replace(one, length=2.5), replace(one, length=1e-3)):
        for rows in ((one, other, two), (one, two, other), (two, one, other)):
            assert counted(*rows) == []


@pytest.mark.parametrize(
    "seeds", [(1, 3, 5), slowly(range(7, 41, 2), reason="random points")], ids=len
)
@pytest.mark.parametrize("shared", ["outer", "inner", "collinear", "both collinear"])
def test_points_that_coincide_or_lie_on_a_line_are_no_special_case(
    shared: str, seeds: Sequence[int]
) -> None:
    for seed in seeds:
        rows = list(drawn(SIX_PINS, seed))
        a = [np.array(row.a) for row in rows if isinstance(row, CircleRow)]
        pins = [np.array(row.pin) for row in rows if isinstance(row, CircleRow)]
        at, way = complex(0.5, -0.25), np.exp(0.5j)
        there = [at + way * complex(*one) for one in a]
        if shared == "outer":
            pins[1] = pins[0]
        if shared == "inner":
            a[1], there[1] = a[0], there[0]
        if "collinear" in shared:
            a[2] = 0.25 * a[0] + 0.75 * a[1]
            there[2] = at + way * complex(*a[2])
        if "both" in shared:
            pins[2] = 0.5 * pins[0] + 0.5 * pins[1]
        lengths = [abs(one - complex(*pin)) for one, pin in zip(there, pins, strict=True)]
        drawn_so = circles([_pair(one) for one in a], [_pair(one) for one in pins], lengths)
        own, other = assemblies(drawn_so), real(solutions(drawn_so, 6))
        assert len(own) == len(other) > 0
        assert [one.angle_rad for one in own] == pytest.approx(list(other[:, 0]), abs=1e-7)
        if "both" in shared:  # Gosselin and Merlet, 1993
            assert len(own) <= 4


@pytest.mark.parametrize("kinds", MOST, ids="-".join)
def test_size_and_distance_change_nothing(kinds: tuple[str, str, str]) -> None:
    rows = six_real() if kinds == SIX_PINS else drawn(kinds, 1)
    rows = moved(rows, 1.0, 0.0)
    own = assemblies(rows)
    assert own
    for size in (2.0**-20, 2.0**20):
        there = assemblies(moved(rows, size, 0.0))
        assert [one.angle_rad for one in there] == [one.angle_rad for one in own]
        assert [one.place for one in there] == [
            (size * one.place[0], size * one.place[1]) for one in own
        ]
    there = assemblies(moved(rows, 1.0, 2.0**20))
    assert [one.angle_rad for one in there] == [one.angle_rad for one in own]
    for near, far in zip(own, there, strict=True):
        assert far.place == pytest.approx(tuple(x + 2.0**20 for x in near.place), rel=1e-15)


def moved(rows: LegRows, size: float, by: float) -> LegRows:
    """Rows of short numbers, so that moving them by ``by`` [m] in x and y rounds nothing."""

    def point(place: Point, shift: float = 0.0) -> Point:
        x, y = (size * (round(2**20 * c) / 2**20 + shift) for c in place)
        return x, y

    def one(row: LegRow) -> LegRow:
        if isinstance(row, CircleRow):
            length = size * round(2**20 * row.length) / 2**20
            return CircleRow(point(row.a), point(row.pin, by), length)
        if isinstance(row, LineRow):
            return LineRow(point(row.a), row.normal, point(row.through, by))
        if isinstance(row, ThroughRow):
            return ThroughRow(row.normal, point(row.b), point(row.pin, by))
        return row

    first, second, third = map(one, rows)
    return first, second, third


def test_numbers_of_very_different_sizes_take_wider_balls_and_lose_no_digits() -> None:
    a = [(1e-150, 0.0), (0.0, 1e150), (1e-9, 1e9)]
    every = assemblies(circles(a, [(3, 4), (1e150, 1), (1e9, 7)], [5, 1e150, 1e9]))
    assert len(every) == 4
    for one in every:
        assert math.dist(one.place, (3, 4)) == pytest.approx(5.0, rel=1e-15)


def test_two_legs_of_an_angle_are_refused() -> None:
    along = AngleRow((1.0, 0.0))
    with pytest.raises(CrankcheckError, match="two legs hold the angle"):
        assemblies((along, CircleRow((0, 0), (1, 0), 1), along))


def test_an_angle_and_parallel_guides_leave_a_place_open() -> None:
    along = AngleRow((1.0, 0.0))
    one, same = LineRow((0, 0), UP, (0, 0)), LineRow((1, 2), UP, (0, 2))
    with pytest.raises(ContinuumError):
        assemblies((along, one, same))
    assert assemblies((along, one, replace(same, through=(0, 3)))) == ()


def _pair(vector: np.ndarray) -> Point:
    return float(vector[0]), float(vector[1])
