"""Laws of a cam: derivatives, peaks as in textbooks, continuity named, faults refused."""

import math
import pickle

import mpmath  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from models.scene.cam_laws import KINDS, CamLaw, CamSegment, peak_factors

SMOOTH = [kind for kind in KINDS if kind not in ("dwell", "table")]
DEG = math.pi / 180.0


def rise_and_return(kind: str, lift: float = 0.02) -> CamLaw:
    rest = CamSegment("dwell", 60 * DEG)
    up, down = CamSegment(kind, 100 * DEG, lift), CamSegment(kind, 140 * DEG, -lift)
    return CamLaw((up, rest, down, rest))


def by_its_acceleration(kind: str, u: mpmath.mpf) -> mpmath.mpf:
    """Rises of unit lift, as textbooks write them, in 50 digits (Norton, ch. 8)."""
    pi = mpmath.pi
    if kind == "uniform":
        return u
    if kind == "parabolic":
        return 2 * u**2 if u < 0.5 else 1 - 2 * (1 - u) ** 2
    if kind == "harmonic":
        return (1 - mpmath.cos(pi * u)) / 2
    if kind == "cycloidal":
        return u - mpmath.sin(2 * pi * u) / (2 * pi)
    if kind == "3-4-5":
        return 10 * u**3 - 15 * u**4 + 6 * u**5
    if kind == "4-5-6-7":
        return 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7
    if u > 0.5:  # both modified laws are odd about the middle
        return 1 - by_its_acceleration(kind, 1 - u)
    if kind == "modified-sine":
        c = pi / (4 + pi)
        if u < mpmath.mpf(1) / 8:
            return c * (u - mpmath.sin(4 * pi * u) / (4 * pi))
        return 1 / (4 + pi) * (2 + pi * u - mpmath.mpf(9) / 4 * mpmath.sin((4 * pi * u + pi) / 3))
    top = 8 * pi / (2 + pi)
    first = top / (4 * pi) * (u - mpmath.sin(4 * pi * u) / (4 * pi))
    if u < mpmath.mpf(1) / 8:
        return first
    eighth, speed = mpmath.mpf(1) / 8, top / (4 * pi)
    lift = top / (4 * pi) * (eighth - 1 / (4 * pi))
    if u < 3 * eighth:
        return lift + speed * (u - eighth) + top * (u - eighth) ** 2 / 2
    lift, speed = lift + speed / 4 + top / 32, speed + top / 4
    x = u - 3 * eighth
    return lift + speed * x + top / (4 * pi) ** 2 * (1 - mpmath.cos(4 * pi * x))


@pytest.mark.parametrize("kind", SMOOTH)
def test_lift_and_derivatives_are_those_of_the_textbooks_formula_in_50_digits(kind: str) -> None:
    law = rise_and_return(kind)
    # Between knots, none of them in reach of the difference's step of 1e-10 of the span.
    shares = np.array([0.011, 0.09, 0.21, 0.34, 0.43, 0.57, 0.69, 0.83, 0.91, 0.989])
    peaks = (1.0, 2.2, 8.0, 80.0)
    for begin, span, lift, base in ((0.0, 100.0, 0.02, 0.0), (160.0, 140.0, -0.02, 0.02)):
        angle = (begin + shares * span) * DEG
        found = law.at(angle)
        with mpmath.workdps(50):
            for order in range(4):
                exact = [
                    mpmath.diff(
                        lambda u: by_its_acceleration(kind, u), mpmath.mpf(float(u)), order, h=1e-12
                    )
                    for u in (angle / DEG - begin) / span
                ]
                unit = lift / (span * DEG) ** order
                expected = (base if order == 0 else 0.0) + unit * np.array(exact, dtype=float)
                off = np.abs(found[order] - expected).max() / abs(unit) / peaks[order]
                assert off < 1e-12, (order, off)


def test_peak_factors_are_those_of_the_textbooks_table() -> None:
    # Norton, Design of Machinery, 5th ed., table 8-3 (peak factors), to the digits printed there;
    # H. A. Rothbart (ed.), Cam Design Handbook, 2004, p. 35, eq. 2.17 to 2.19: 2 h and 4 h.
    printed = {
        "parabolic": (2.000, 4.000, math.inf),
        "harmonic": (1.571, 4.945, math.inf),
        "modified-trapezoid": (2.000, 4.888, 61.0),
        "modified-sine": (1.760, 5.528, 69.0),
        "3-4-5": (1.875, 5.777, 60.0),
        "cycloidal": (2.000, 6.283, 40.0),
        "4-5-6-7": (2.188, 7.526, 52.0),
    }
    for kind, (speed, acceleration, jerk) in printed.items():
        found = peak_factors(kind)
        assert found[0] == pytest.approx(speed, abs=1e-3)
        assert found[1] == pytest.approx(acceleration, rel=2.1e-3)
        assert found[2] == pytest.approx(jerk, rel=1.5e-2)
    assert peak_factors("uniform") == (1.0, math.inf, math.inf)
    # Closed forms: pi^2 / 2, 10 / sqrt(3), 4 pi^2, 84 sqrt(5) / 25, 32 pi^2 / (pi + 2).
    assert peak_factors("harmonic")[1] == pytest.approx(math.pi**2 / 2, rel=1e-14)
    assert peak_factors("3-4-5")[1] == pytest.approx(10 / math.sqrt(3), rel=1e-14)
    assert peak_factors("cycloidal")[2] == pytest.approx(4 * math.pi**2, rel=1e-14)
    assert peak_factors("4-5-6-7")[:2] == pytest.approx((35 / 16, 84 * 5**0.5 / 25), rel=1e-14)
    top = 32 * math.pi**2 / (math.pi + 2)
    assert peak_factors("modified-trapezoid")[2] == pytest.approx(top, rel=1e-14)


@pytest.mark.parametrize("kind", SMOOTH)
def test_jumps_are_named_where_they_are_and_as_large_as_they_are(kind: str) -> None:
    law = rise_and_return(kind)
    smooth = {"uniform": 0, "parabolic": 1, "harmonic": 1, "4-5-6-7": 3}
    assert law.continuous == smooth.get(kind, 2)
    jumps = {round(one.angle_rad / DEG, 6): one for one in law.jumps}
    ends = set() if kind == "4-5-6-7" else {0.0, 100.0, 160.0, 300.0}
    assert set(jumps) == ends | ({50.0, 230.0} if kind == "parabolic" else set())
    for angle, one in jumps.items():
        step = 1e-9
        before, after = (law.at(np.array([angle * DEG + x])) for x in (-step, step))
        for k in range(law.continuous + 2):
            jump = float(after[k][0] - before[k][0])
            assert one[1 + k] == pytest.approx(jump, abs=1e-6), (angle, k)
    # Steps of a unit law over span^n: 3-4-5 has a jerk of 60, parabolic an acceleration of 4.
    if kind == "3-4-5":
        assert jumps[0.0] == pytest.approx((0, 0, 0, 0, 60 * 0.02 / (100 * DEG) ** 3), rel=1e-12)
    if kind == "parabolic":
        assert jumps[50.0].acceleration == pytest.approx(-8 * 0.02 / (100 * DEG) ** 2, rel=1e-12)


def test_any_turn_has_the_same_lift_and_a_law_that_begins_high_has_its_lowest_dwell_at_0() -> None:
    law = rise_and_return("cycloidal")
    phi = np.linspace(0.0, math.tau, 200, endpoint=False)
    for turn in (-3, 5):
        assert np.allclose(law.at(phi + turn * math.tau), law.at(phi), rtol=0, atol=1e-13)
    first, rest, down, last = law.segments
    other = CamLaw((down, last, first, rest))
    assert np.allclose(other.at(phi).value, law.at(phi + 160 * DEG).value, rtol=0, atol=1e-16)
    assert other.extremes[0] == pytest.approx((0.0, 0.02), abs=1e-17)
    assert law.at(np.array(0.3)).value.shape == ()
    for angle in (*phi.tolist(), -0.3, 100.0, math.tau, np.nextafter(math.tau, 0.0)):
        every = [float(rate) for rate in law.at(np.array(angle))]
        assert law.at_one(angle) == pytest.approx(every, rel=1e-13, abs=1e-15)
    assert hash(pickle.loads(pickle.dumps(law))) == hash(law)
    assert other != law == rise_and_return("cycloidal")


@pytest.mark.parametrize(("order", "smooth"), [(1, 0), (3, 2), (5, 3), (7, 3)])
def test_a_table_of_a_turn_goes_through_its_points_and_converges_with_its_order(
    order: int, smooth: int
) -> None:
    def error(rows: int) -> float:
        x = np.linspace(0.0, math.tau, rows + 1)
        lift = np.exp(np.sin(x)) - 1.0
        points = tuple(zip(x.tolist(), [*lift[:-1].tolist(), 0.0], strict=True))
        law = CamLaw((CamSegment("table", math.tau, 0.0, points, order),))
        assert law.continuous == smooth
        assert np.allclose(law.at(x).value, lift, rtol=0, atol=1e-14)
        phi = np.linspace(0.0, math.tau, 777)
        return float(np.abs(law.at(phi).value - np.exp(np.sin(phi)) + 1.0).max())

    assert math.log2(error(24) / error(48)) == pytest.approx(order + 1, abs=1.1)


def test_a_table_between_dwells_comes_to_rest_at_both_ends() -> None:
    shares = np.linspace(0.0, 1.0, 9)
    lifts = 0.02 * shares**3 * (10 - 15 * shares + 6 * shares**2)
    rows = tuple(zip((2.0 * shares).tolist(), lifts.tolist(), strict=True))
    fall = tuple((angle, -lift) for angle, lift in rows)
    up, down = CamSegment("table", 2.0, 0.02, rows), CamSegment("table", 2.0, -0.02, fall)
    rest = CamSegment("dwell", math.pi - 2.0)
    law = CamLaw((up, rest, down, rest))
    assert law.continuous == 2
    # The 3-4-5 polynomial is a spline of degree 5 itself.
    poly = CamLaw(tuple(CamSegment("3-4-5", 2.0, x.lift) if x.points else x for x in law.segments))
    phi = np.linspace(0.0, math.tau, 500)
    assert np.allclose(law.at(phi), poly.at(phi), rtol=0, atol=1e-12)
    assert law.peaks == pytest.approx(poly.peaks, rel=1e-9)
    assert law.stroke == pytest.approx(0.02, rel=1e-14)


def test_extremes_are_those_of_a_dense_search_and_never_below_it() -> None:
    phi = np.linspace(0.0, math.tau, 40_001)
    for kind in SMOOTH:
        law = rise_and_return(kind)
        for order, rate in enumerate(law.at(phi)):
            least, largest = law.extremes[order]
            scale = 1e-12 + np.abs(rate).max()
            assert -1e-12 <= (rate.min() - least) / scale < 1e-3
            assert -1e-12 <= (largest - rate.max()) / scale < 1e-3


def test_bad_laws_are_refused_with_the_number_that_is_off() -> None:
    rise, rest = CamSegment("3-4-5", 2.0, 0.02), CamSegment("dwell", 2.0)
    for segments, text in (
        ((rise, rest), r"does not|short of 360"),
        ((CamSegment("3-4-5", 4.0, 1.0), CamSegment("3-4-5", 4.0, -1.0)), "98.3662 over 360"),
        ((), "0 segments are 0 deg, 360 short of 360"),
        ((rise, CamSegment("harmonic", math.tau - 2.0, -0.019)), r"lift is 0.001 from"),
    ):
        with pytest.raises(ValueError, match=text):
            CamLaw(segments)
    points = ((0.0, 0.0), (1.0, 1.0))
    for arguments, text in (
        (("trapezoid", 1.0, 1.0), "no kind of motion 'trapezoid'; there are"),
        (("3-4-5", 0.0, 1.0), "span above 0"),
        (("3-4-5", math.nan, 1.0), "span above 0"),
        (("3-4-5", 1.0, math.inf), "finite"),
        (("3-4-5", 1.0, 0.0), "0 is a dwell"),
        (("dwell", 1.0, 0.5), "0 is a dwell"),
        (("table", 1.0, 1.0), "found 0 points"),
        (("3-4-5", 1.0, 1.0, points), "found 2 points"),
        (("table", 1.0, 1.0, points, 4), "there are 1, 3, 5, 7"),
        (("table", 1.0, 1.0, points[::-1]), "angles increase"),
        (("table", 1.0, 1.0, points[:1]), "2 or more"),
        (("table", 1.0, 2.0, points), "ends at its span and lift"),
        (("table", math.tau, 0.0, ((0.0, 0.0), (3.0, 1.0), (math.tau, 0.0))), "7 or more"),
    ):
        with pytest.raises(ValueError, match=text):
            CamSegment(*arguments)
