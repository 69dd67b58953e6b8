"""All assemblies of random triads against a homotopy that follows paths to them."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

from analytic.assur.assemblies import Assembly, assemblies
from analytic.assur.leg_rows import AngleRow, CircleRow, LegRow, LineRow
from models.errors import CrankcheckError
from tests.analytic.assur.drawn_rows import MOST, SINGULAR, drawn
from tests.analytic.assur.homotopy import real, solutions
from tests.worlds.tiers import at_length, slowly

Kinds = tuple[str, str, str]


@pytest.mark.parametrize(
    "seeds",
    [
        range(6),
        slowly(range(6, 1000), reason="rare rows, with assemblies that lie close together"),
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
        for one in own:
            apart = [away(one, *other) for other in real(every)]
            assert sum(each < 1e-6 for each in apart) == 1, (seed, apart)
            left = max(abs(residual(row, one)) for row in rows)
            size = 1.0 + max(map(abs, one.place))
            assert left < 2e-15 * size * size, (seed, left)


def away(one: Assembly, angle: float, x: float, y: float) -> float:
    """How far an assembly is from a pose, its place in lengths of itself."""
    size = 1.0 + math.hypot(*one.place)
    return abs(math.remainder(one.angle_rad - angle, math.tau)) + (
        math.dist(one.place, (x, y)) / size
    )


def residual(row: LegRow, one: Assembly) -> float:
    """What an assembly leaves of a row."""
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


SEEDS = {
    ("RR", "RR", "RR"): (47,),
    ("RR", "RR", "PR"): (31,),
    ("RR", "RR", "RP"): (44,),
    ("RR", "PR", "RP"): (70,),
}
"""Of drawn rows with as many assemblies as there can be, where these are rare."""


@pytest.mark.parametrize("count", [16, slowly(150, reason="rare rows that may have more")])
@pytest.mark.parametrize("kinds", MOST, ids="-".join)
def test_no_kind_has_more_and_each_can_have_as_many_as_said(kinds: Kinds, count: int) -> None:
    seeds = {*range(count), *SEEDS.get(kinds, ())}
    numbers = {len(assemblies(drawn(kinds, seed))) for seed in seeds}
    assert max(numbers) == MOST[kinds]
    assert all(number % 2 == MOST[kinds] % 2 for number in numbers)


@pytest.mark.parametrize("kinds", SINGULAR, ids="-".join)
def test_kinds_with_two_legs_that_hold_the_angle_have_none(kinds: Kinds) -> None:
    with pytest.raises(CrankcheckError, match="hold the angle"):
        assemblies(drawn(kinds, 1))


def test_every_choice_of_three_legs_is_solved_or_singular() -> None:
    assert len(MOST) + len(SINGULAR) == 20  # of four kinds, three with repetition


def test_they_come_by_increasing_angle_whatever_the_order_of_the_legs() -> None:
    for kinds in MOST:
        one, two, three = drawn(kinds, 1)
        every = assemblies((one, two, three))
        angles = [each.angle_rad for each in every]
        assert angles == sorted(angles)
        assert all(-math.pi < angle <= math.pi for angle in angles)
        for rows in ((two, three, one), (three, two, one)):
            again = np.array([(each.angle_rad, *each.place) for each in assemblies(rows)])
            own = np.array([(each.angle_rad, *each.place) for each in every])
            assert again == pytest.approx(own, rel=1e-14, abs=1e-15)


def test_a_mechanism_of_class_ii_loads_no_python_flint() -> None:
    say = (
        "import sys, numpy; from analytic.kinematics import solve; from models import files;"
        "solve(files.load_scene('fourbar-swing'), numpy.zeros(1)); sys.exit('flint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", say], check=False).returncode == 0
