"""The closed-form dyads against fifty digits: their error never exceeds the bound they carry."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from mpmath import mp

from analytic.dyads import rrr
from analytic.dyads.parts import OpenError, Sliding, Turning
from analytic.dyads.plane import EPS, ZERO, PointError, PointKinematics, Vec, fixed_point
from models.array import Array
from tests.analytic.change_points.jets import Jet
from tests.analytic.dyads.dyad_cases import BUNCH, KINDS, Bunch, Draw, Exact, Moved
from tests.worlds.tiers import at_length, slowly

LEVELS = ("position", "rate", "acceleration")
SURE = 20.0
"""Rates have a bound wherever the sine exceeds so many times the square root of rounding."""


@dataclass(frozen=True)
class Found:
    """Errors and bounds at the three levels, (N, 3), one row per unknown; what they belong to.

    ``said`` is the sine that the dyad itself gives.
    """

    error: Array
    bound: Array
    sine: Array
    said: Array
    size: Array

    def complaint(self, level: int) -> str:
        error, bound = self.error[:, level], self.bound[:, level]
        i = int(np.nanargmax(error - bound))
        return f"{LEVELS[level]}: error {error[i]:.3g} above {bound[i]:.3g} at sine {self.sine[i]}"


def _levels(unknown: Turning | Sliding) -> tuple[list[Array], list[Array]]:
    """Values and bounds as arrays (3, n); the direction of a turning unknown comes apart."""
    if isinstance(unknown, Turning):
        values = [np.zeros(BUNCH), unknown.omega, unknown.alpha]
    else:
        values = [unknown.s, unknown.speed, unknown.acceleration]
    bounds = (np.broadcast_to(np.asarray(b, dtype=float), (BUNCH,)) for b in unknown.error)
    return values, list(bounds)


def _angle_between(unknown: Turning, i: int, angle: Jet) -> float:
    """By how much a direction is off the true angle, modulo whole turns."""
    c, s = mp.cos_sin(angle.value)
    x, y = mp.mpf(float(unknown.turn.x[i])), mp.mpf(float(unknown.turn.y[i]))
    return abs(math.atan2(float(c * y - s * x), float(c * x + s * y)))


def _compare(bunch: Bunch, shift: Exact | Moved) -> Found:
    """The true errors of a bunch; NaN where the exact dyad, stretched, has no rates."""
    rows, bounds = [], []
    solved = [(u, *_levels(u)) for u in (bunch.dyad.first, bunch.dyad.second)]
    for i in range(BUNCH):
        for (unknown, values, bound), truth in zip(solved, bunch.truth(i, shift), strict=True):
            exact = (truth.value, truth.rate, truth.second)
            row = [abs(float(float(v[i]) - e)) for v, e in zip(values, exact, strict=True)]
            if isinstance(unknown, Turning):
                row[0] = _angle_between(unknown, i, truth)
            rows.append(row)
            bounds.append([float(b[i]) for b in bound])
    return Found(
        np.array(rows),
        np.array(bounds),
        np.repeat(bunch.sine, 2),
        np.repeat(np.broadcast_to(bunch.dyad.sine, (BUNCH,)), 2),
        np.repeat(bunch.size, 2),
    )


def _many(kind: str, count: int, *, wrong: tuple[float, float] | None = None) -> Found:
    found = []
    for number in range(count // BUNCH):
        rng = np.random.default_rng([number, len(kind), ord(kind[1]), wrong is None])
        bunch = KINDS[kind](Draw(rng, wrong=wrong))
        found.append(_compare(bunch, Exact() if wrong is None else Moved(rng)))
    columns = zip(*(vars(f).values() for f in found), strict=True)
    return Found(*(np.concatenate(column) for column in columns))


def _assert_bounded(found: Found) -> None:
    """No error above its bound, no bound missing; without a true rate, none is claimed."""
    assert not np.isnan(found.bound).any()
    assert not np.isnan(found.error[:, 0]).any()
    for level in range(3):
        error, bound = found.error[:, level], found.bound[:, level]
        inside = np.where(np.isnan(error), np.isinf(bound), error <= bound)
        assert inside.all(), found.complaint(level)


def _assert_certain_off_toggle(found: Found, kind: str) -> None:
    """Bounds are finite but for a strip about toggle whose width rounding gives.

    Two lines that cross lose their crossing where their angle is rounding; the others fold, and
    lose their rates where the sine is the square root of rounding.
    """
    strip = EPS * (1.0 + found.size)
    edge = SURE * (strip if kind in ("PRP", "RPP") else np.sqrt(strip))
    assert np.isfinite(found.bound[found.sine > edge]).all()
    if kind in ("RRR", "RRP", "RPR"):
        assert np.isfinite(found.bound[:, 0]).all()


def many(quick: int) -> pytest.MarkDecorator:
    more = slowly(10_000, reason="one in a thousand is nearer to toggle than to rounding")
    most = at_length(100_000, reason="one in ten thousand, half a minute of each kind")
    return pytest.mark.parametrize("count", [quick, more, most])


@many(400)
@pytest.mark.parametrize("kind", KINDS)
def test_error_never_exceeds_the_bound(kind: str, count: int) -> None:
    found = _many(kind, count)
    _assert_bounded(found)
    _assert_certain_off_toggle(found, kind)
    # Its square is a difference of lengths, or of angles.
    power = 1 if kind in ("PRP", "RPP") else 2
    off = np.abs(found.said**power - found.sine**power)
    assert (off <= SURE * EPS * (1.0 + found.size)).all()
    # A line through its pin (RPR without offset) has no toggle, so there are fewer of those.
    assert (found.sine < 2e-3).mean() > 0.3, "half of the dyads are meant to stand near toggle"


@many(100)
@pytest.mark.parametrize("kind", KINDS)
def test_bound_covers_inputs_that_are_wrong_by_their_stated_error(kind: str, count: int) -> None:
    """From rounding up to errors as large as the links, in places, rates, and turning guides."""
    found = _many(kind, count, wrong=(1e-13, 1.0))
    _assert_bounded(found)
    known = np.isfinite(found.bound) & (found.error > 0.0)
    # Not by being boundless: most have a bound, and it is of the size of the change.
    assert known[:, 0].mean() > 0.6
    assert np.median(found.bound[known] / found.error[known]) < 50.0


def test_a_dyad_that_is_open_raises_with_its_shortage_and_by_rounding_alone_closes() -> None:
    at, l1, l2 = fixed_point((0.3, -0.2)), 0.4, 0.7
    for apart, short in ((1.35, 0.25), (0.1, 0.2)):
        place = Vec(0.3 + np.array([0.5, apart]), -0.2)  # the first one closes
        other = PointKinematics(place, ZERO, ZERO, None)
        with pytest.raises(OpenError) as opened:
            rrr.solve(at, other, l1, l2, 1)
        assert opened.value.short_m[1] == pytest.approx(short, abs=1e-15)
    at, l1, l2 = fixed_point((0.0, 0.0)), 0.4, 0.7
    apart = np.array([l1 + l2, math.nextafter(l1 + l2, 2.0), (l1 + l2) * (1 + 8 * EPS)])
    other = PointKinematics(Vec(apart, 0.0 * apart), ZERO, ZERO, at.error)
    dyad = rrr.solve(at, other, l1, l2, 1, certified=True)
    assert isinstance(dyad.first, Turning)
    assert np.arctan2(dyad.first.turn.y, dyad.first.turn.x) == pytest.approx(0.0, abs=1e-7)
    assert (dyad.first.error.theta < 1e-6).all()
    assert np.isinf(dyad.first.error.omega).all()


def test_what_hangs_on_an_uncertain_rate_is_uncertain_itself() -> None:
    """Also where the rate is not a number, and its share is nothing times infinity."""
    lost = PointError(1e-9, math.inf, math.inf)
    for rate in (0.0, math.inf, math.nan):
        still = Vec(np.full(3, rate), np.zeros(3))
        at = PointKinematics(Vec(np.linspace(0.0, 0.1, 3), np.zeros(3)), still, still, lost)
        with np.errstate(invalid="ignore"):
            dyad = rrr.solve(at, fixed_point((0.5, 0.2)), 0.4, 0.3, 1, certified=True)
        for unknown in (dyad.first, dyad.second):
            assert isinstance(unknown, Turning)
            assert (unknown.error.theta < 1e-7).all()
            assert np.isinf(unknown.error.omega).all()
            assert np.isinf(unknown.error.alpha).all()
