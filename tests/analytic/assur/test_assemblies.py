"""All assemblies of random triads by a homotopy, and of special ones exactly as they are known."""

import itertools
import math
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from analytic.assur.assemblies import TriadAssembly, assemblies
from analytic.assur.eliminant import (
    AngleRow,
    CircleRow,
    ContinuumError,
    LegRow,
    LegRows,
    LineRow,
    ThroughRow,
)
from models.errors import CrankcheckError
from models.scene import Point
from tests.analytic.assur.homotopy import real, solutions
from tests.worlds.tiers import at_length, slow, slowly

Kinds = tuple[str, str, str]
KINDS = ("RR", "PR", "RP", "PP")
MOST = {tuple(kinds.split()): most for kinds, most in {
    "RR RR RR": 6, "RR RR PR": 6, "RR RR RP": 6, "RR RR PP": 2, "RR PR PR": 4, "RR PR RP": 6,
    "RR PR PP": 2, "RR RP RP": 4, "RR RP PP": 2, "PR PR PR": 2, "PR PR RP": 4, "PR PR PP": 1,
    "PR RP RP": 4, "PR RP PP": 1, "RP RP RP": 2, "RP RP PP": 1,
}.items()}  # fmt: skip
"""All choices of three legs that can be solved, in any order, and how many assemblies they have at
most. Two legs PP hold the same angle twice."""
SINGULAR = tuple(
    kinds for kinds in itertools.combinations_with_replacement(KINDS, 3) if kinds.count("PP") > 1
)


def drawn(kinds: Kinds, seed: int) -> LegRows:
    """Rows of size 1: every other one of a pose that they have, so that there is an assembly."""
    draw = np.random.default_rng([seed, *(KINDS.index(kind) for kind in kinds)])
    pose = (complex(*draw.normal(size=2)), draw.uniform(-math.pi, math.pi)) if seed % 2 else None
    return tuple(_row(kind, draw, pose) for kind in kinds)


def _row(kind: str, draw: np.random.Generator, pose: tuple[complex, float] | None) -> LegRow:
    a, at = complex(*draw.normal(size=2)), complex(*draw.normal(size=2))
    length, way = draw.uniform(0.3, 2.0), draw.uniform(-math.pi, math.pi)
    if pose is None:
        there, phi = at + length * np.exp(1j * draw.uniform(-math.pi, math.pi)), way
    else:
        there, phi = pose[0] + np.exp(1j * pose[1]) * a, pose[1]  # of the point a of the link
    if kind == "RR":
        return CircleRow(_pair(a), _pair(at), float(abs(at - there)))
    if kind == "PR":
        return LineRow(_pair(a), _pair(np.exp(1j * way)), _pair(there))
    if kind == "RP":
        across = 1j * (at - there) / abs(at - there) * np.exp(-1j * phi)
        return ThroughRow(_pair(across), _pair(a), _pair(at))
    return AngleRow(_pair(np.exp(1j * phi)))


def _pair(number: complex) -> Point:
    return float(number.real), float(number.imag)


@pytest.mark.parametrize(
    "seeds",
    [
        range(4),
        slowly(range(4, 1000), reason="rare rows, with assemblies that lie close together"),
        at_length(range(1000, 10_000), reason="a minute of each kind, of rarer ones"),
    ],
    ids=len,
)
@pytest.mark.parametrize("kinds", MOST, ids="-".join)
def test_a_homotopy_finds_the_same_assemblies(kinds: Kinds, seeds: range) -> None:
    for seed in seeds:
        rows = drawn(kinds, seed)
        own, every = assemblies(rows), solutions(rows, MOST[kinds])
        assert len(every) == MOST[kinds], (seed, "all paths that end have been followed")
        assert len(own) == len(real(every)), seed
        assert len(own) >= seed % 2, (seed, "it was drawn in a pose that it has")
        angles = [one.angle_rad for one in own]
        assert angles == sorted(angles)
        assert all(-math.pi < angle <= math.pi for angle in angles)
        for one in own:
            apart = [away(one, *other) for other in real(every)]
            assert sum(each < 1e-6 for each in apart) == 1, (seed, apart)
            left = max(abs(residual(row, one)) for row in rows)
            size = 1.0 + max(map(abs, one.place))
            assert left < 2e-15 * size * size, (seed, left)


def away(one: TriadAssembly, angle: float, x: float, y: float) -> float:
    """How far an assembly is from a pose, its place in lengths of itself."""
    off = math.dist(one.place, (x, y)) / (1.0 + math.hypot(*one.place))
    return abs(math.remainder(one.angle_rad - angle, math.tau)) + off


def residual(row: LegRow, one: TriadAssembly) -> float:
    z, turn = complex(*one.place), complex(math.cos(one.angle_rad), math.sin(one.angle_rad))
    if isinstance(row, CircleRow):
        return abs(z + turn * complex(*row.a) - complex(*row.pin)) - row.length
    if isinstance(row, LineRow):
        off = z + turn * complex(*row.a) - complex(*row.through)
        return (off * complex(*row.normal).conjugate()).real
    if isinstance(row, AngleRow):
        return abs(turn - complex(*row.along))
    off = (complex(*row.pin) - z) / turn - complex(*row.b)
    return (off * complex(*row.normal).conjugate()).real


SIX_PINS = ("RR", "RR", "RR")
SEEDS = {SIX_PINS: 47, ("RR", "RR", "PR"): 31, ("RR", "RR", "RP"): 44, ("RR", "PR", "RP"): 70}
"""Of drawn rows with as many assemblies as there can be, where these are rare."""


def test_kinds_with_two_legs_that_hold_the_angle_have_none() -> None:
    assert len(MOST) + len(SINGULAR) == 20  # of four kinds, three with repetition
    for kinds in SINGULAR:
        with pytest.raises(CrankcheckError, match="two legs hold the angle"):
            assemblies(drawn(kinds, 1))


@slow("a process; the command of tests/reports/cli/test_ending.py loads none either")
def test_a_mechanism_of_class_ii_loads_no_python_flint() -> None:
    say = (
        "import sys, numpy; from analytic.kinematics import solve;"
        "from models.files.reading import load_scene;"
        "solve(load_scene('fourbar-swing'), numpy.zeros(1)); sys.exit('flint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", say], check=False).returncode == 0


UP, ALONG = (0.0, 1.0), (1.0, 0.0)


def counted(*rows: LegRow) -> list[tuple[float, float, float, int]]:
    return [(one.angle_rad, *one.place, one.count) for one in assemblies(rows)]


def circles(a: list[Point], pins: list[Point], lengths: list[float]) -> LegRows:
    return tuple(map(CircleRow, a, pins, lengths))


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
    # An assembly that comes to such an angle is counted with those there.
    assert counted(*rows, CircleRow((2, 0), (0, 3), 5)) == [
        (pytest.approx(math.atan2(-12, -5), rel=1e-15), 2.0, 0.0, 1),
        *((0.0, -6.0, 0.0, 1), (0.0, 2.0, 0.0, 2)),
        *((math.pi, -2.0, 0.0, 1), (math.pi, 6.0, 0.0, 1)),
    ]


def test_a_limit_between_parallel_guides_counts_twice_at_each_place() -> None:
    """The guides are as far apart as the two pins: the link stands across."""
    lines = LineRow((0, 0), UP, (0, 0)), LineRow((1, 0), UP, (0, 1))
    half = math.pi / 2
    assert counted(*lines, LineRow((0, 0), ALONG, (2, 0))) == [(half, 2.0, 0.0, 2)]
    twice = [(half, -4.0, 0.0, 2), (half, 4.0, 0.0, 2)]
    assert counted(*lines, CircleRow((0, 0), (0, 3), 5)) == twice
    assert counted(*lines, CircleRow((0, 0), (0, 5), 5)) == [(half, 0.0, 0.0, 4)]


def test_parallel_guides_leave_a_link_loose_or_hold_it_nowhere() -> None:
    guides = LineRow((0, 0), UP, (0, 0)), LineRow((1, 0), UP, (0, 0))
    assert counted(*guides, LineRow((0, 1), UP, (0, 5))) == []
    with pytest.raises(ContinuumError, match="can move while"):
        counted(*guides, LineRow((0, 1), UP, (0, 1)))
    along, other = AngleRow((1.0, 0.0)), LineRow((1, 2), UP, (0, 2))
    with pytest.raises(ContinuumError):
        counted(along, guides[0], other)
    assert counted(along, guides[0], replace(other, through=(0, 3))) == []
    # An angle at which all lines are parallel and apart is none.
    first, second = ThroughRow(UP, (0, 0), (2, 1)), ThroughRow(UP, (0, 1), (5, 3))
    rows = LineRow((0, 0), UP, (0, 0)), first, second
    # 2 cos phi - 3 sin phi = 1, by the difference of the last two
    middle, off = math.atan2(-3, 2), math.acos(1 / math.sqrt(13))
    angles = [one.angle_rad for one in assemblies(rows)]
    assert angles == pytest.approx([middle - off, middle + off], rel=1e-15)


def test_legs_alike_let_a_platform_move_and_otherwise_it_stands_or_is_nowhere() -> None:
    points = [(0.0, 0.0), (2.0, 0.0), (1.0, 3.0)]
    pins = [(4.0, 0.0), (6.0, 0.0), (5.0, 3.0)]
    with pytest.raises(ContinuumError):
        counted(*circles(points, pins, [2, 2, 2]))
    assert len(assemblies(circles(points, pins, [2, 2.5, 2.25]))) == 4
    one, two = CircleRow((1, 0), (3, 0), 2), CircleRow((0, 1), (0, 4), 3)
    with pytest.raises(ContinuumError):
        counted(one, one, two)
    for other in (replace(one, length=2.5), replace(one, length=1e-3)):
        for rows in ((one, other, two), (one, two, other), (two, one, other)):
            assert counted(*rows) == []


@pytest.mark.parametrize("shared", ["outer", "inner", "collinear"])
def test_points_that_coincide_or_lie_on_a_line_are_no_special_case(shared: str) -> None:
    rows = drawn(SIX_PINS, 3)
    a, pins = [complex(*row.a) for row in rows], [complex(*row.pin) for row in rows]
    if shared == "outer":
        pins[1] = pins[0]
    elif shared == "inner":
        a[1] = a[0]
    else:
        a[2], pins[2] = 0.25 * a[0] + 0.75 * a[1], 0.5 * pins[0] + 0.5 * pins[1]
    there = [complex(0.5, -0.25) + np.exp(0.5j) * one for one in a]
    lengths = [float(abs(one - pin)) for one, pin in zip(there, pins, strict=True)]
    drawn_so = circles([*map(_pair, a)], [*map(_pair, pins)], lengths)
    own, other = assemblies(drawn_so), real(solutions(drawn_so, 6))
    assert len(own) == len(other) > 0
    assert [one.angle_rad for one in own] == pytest.approx(list(other[:, 0]), abs=1e-7)
    if shared == "collinear":  # Gosselin and Merlet, 1993
        assert len(own) <= 4


@pytest.mark.parametrize("kinds", MOST, ids="-".join)
def test_size_distance_and_the_order_of_legs_change_nothing(kinds: Kinds) -> None:
    rows = moved(drawn(kinds, SEEDS.get(kinds, 1)), 1.0, 0.0)
    own = np.array(counted(*rows))
    assert own.size
    assert np.array(counted(*rows[::-1])) == pytest.approx(own, rel=1e-14, abs=1e-15)
    for size in (2.0**-20, 2.0**20):
        assert np.array_equal(counted(*moved(rows, size, 0.0)), own * [1.0, size, size, 1.0])
    there = np.array(counted(*moved(rows, 1.0, 2.0**20)))
    assert np.array_equal(there[:, 0], own[:, 0])
    assert there[:, 1:3] == pytest.approx(own[:, 1:3] + 2.0**20, rel=1e-15)


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

    return tuple(map(one, rows))


def test_numbers_of_very_different_sizes_take_wider_balls_and_lose_no_digits() -> None:
    a = [(1e-150, 0.0), (0.0, 1e150), (1e-9, 1e9)]
    every = assemblies(circles(a, [(3, 4), (1e150, 1), (1e9, 7)], [5, 1e150, 1e9]))
    assert len(every) == 4
    for one in every:
        assert math.dist(one.place, (3, 4)) == pytest.approx(5.0, rel=1e-15)
