"""Strokes, time ratios and extreme speeds by closed forms and by sweeps of the reference."""

import math
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from analytic.kinematics import solve, solve_driven
from analytic.mechanism.cycle import Along, Output, Travel, extreme_speeds, series, travel, travels
from analytic.mechanism.fourbar import (
    FourBar,
    four_bar_type,
    grashof_of,
    inverted_slider_crank_type,
    slider_crank_type,
)
from models.errors import CrankcheckError, ReachError, StructureError
from models.files.reading import load_scene, parse_scene
from models.scene import Driver
from models.scene.driver import passing
from models.scene.laws import ConstantSpeed
from tests.analytic.four_bars import fourbar, rocker_limits_rad, time_ratio

CHANGE = "change point"
STILL = """
name = "still"
source = "a test"
ground.points = {{ A = [0.0, 0.0], D = [0.3, 0.0], E = [0.1, 0.0] }}
links.crank = {{ bar = ["A", "B"], length_m = 0.1 }}
links.rod = {{ bar = ["{rod}", "C"], length_m = 0.25 }}
links.rocker = {{ bar = ["{rocker}", "C"], length_m = 0.2 }}
driver = {{ link = "crank", speed_rad_s = 10.0 }}
"""
CRANK_ROCKERS = [(0.1, 0.25, 0.2, 0.3), (0.2, 0.9, 0.7, 0.6), (0.05, 0.3, 0.1, 0.28)]
Lengths = tuple[float, float, float, float]


@pytest.mark.parametrize(
    ("lengths", "of_class", "name"),
    [
        ((0.1, 0.25, 0.2, 0.3), "crank-rocker", "Grashof crank-rocker"),
        ((0.2, 0.25, 0.1, 0.3), "crank-rocker", "Grashof rocker-crank"),
        ((0.25, 0.2, 0.3, 0.1), "double-crank", "Grashof double-crank (drag link)"),
        ((0.25, 0.1, 0.2, 0.3), "double-rocker", "Grashof double-rocker"),
        ((0.3, 0.22, 0.25, 0.5), "triple-rocker", "non-Grashof triple-rocker (longest: ground)"),
        ((0.1, 0.3, 0.1, 0.3), CHANGE, f"{CHANGE}, parallelogram or antiparallelogram"),
        ((0.2, 0.2, 0.3, 0.3), CHANGE, f"{CHANGE}, kite (deltoid)"),
        ((0.2, 0.2, 0.2, 0.2), CHANGE, f"{CHANGE}, rhombus"),
        ((0.1, 0.2, 0.3, 0.4), CHANGE, f"{CHANGE}, between crank-rocker and triple-rocker"),
    ],
)
def test_a_four_bar_has_its_class_and_its_name(lengths: Lengths, of_class: str, name: str) -> None:
    assert FourBar(*lengths).grashof_class == of_class
    assert FourBar(*(1e3 * x for x in lengths)).grashof_class == of_class
    found = four_bar_type(FourBar(*lengths))
    assert found.name == name
    assert (found.margin_m >= 0.0) != name.startswith("non-Grashof")


def test_lengths_that_make_no_fourbar_are_refused() -> None:
    with pytest.raises(ValueError, match=r"longest exceeds the sum of the others by 0\.4 m"):
        FourBar(0.1, 0.2, 0.3, 1.0)
    with pytest.raises(ValueError, match="above 0"):
        FourBar(0.1, 0.0, 0.3, 0.3)


def test_lengths_are_read_from_a_scene() -> None:
    assert FourBar.of(load_scene("fourbar-lecture-1")) == FourBar(0.1, 0.25, 0.2, 0.3)
    assert FourBar.of(load_scene("fourbar-double-rocker")) == FourBar(0.25, 0.1, 0.2, 0.3)
    with pytest.raises(StructureError, match="shaper: not a four-bar; its groups are RPR, RRP"):
        FourBar.of(load_scene("shaper"))


@pytest.mark.parametrize("rod", ["A", "E"])
def test_two_links_that_stand_still_are_no_four_bar_and_pass_no_change_point(rod: str) -> None:
    scene = parse_scene(STILL.format(rod=rod, rocker="D"), "test")
    with pytest.raises(StructureError, match="still: not a four-bar; rod and rocker lie between"):
        FourBar.of(scene)
    motion = solve(scene, np.linspace(0.0, 1.0, 100))
    assert motion.crossings == ()
    assert not np.ptp(motion.points["C"].position, axis=0).any()
    assert not motion.links["rod"].omega.any()


def test_a_rocker_on_the_pivot_of_the_crank_is_no_four_bar_nor_are_links_that_do_not_meet() -> None:
    scene = parse_scene(STILL.format(rod="B", rocker="A"), "test")
    with pytest.raises(StructureError, match=r"still: not a four-bar; lengths .* above 0"):
        FourBar.of(scene)
    text = STILL.format(rod="A", rocker="D").replace("0.25", "0.05")
    with pytest.raises(ReachError, match=r"cannot close at C, it is open by 0\.05 m"):
        solve(parse_scene(text, "test"), np.zeros(3))


@pytest.mark.parametrize("lengths", CRANK_ROCKERS)
@pytest.mark.parametrize("branch", [1, -1])
def test_swing_and_time_ratio_are_those_of_the_motion(lengths: Lengths, branch: int) -> None:
    found = travel(fourbar(*lengths, branch), "rocker")
    assert found.stroke == pytest.approx(np.ptp(rocker_limits_rad(*lengths)), abs=1e-12)
    assert found.time_ratio == pytest.approx(time_ratio(*lengths), abs=1e-9)
    assert found.time_ratio >= 1.0


@pytest.mark.parametrize(
    "lengths", [CRANK_ROCKERS[1], (0.25, 0.2, 0.3, 0.1), (0.25, 0.1, 0.2, 0.3)]
)
def test_transmission_extremes_are_those_of_a_sweep(lengths: Lengths) -> None:
    """The angle at C between coupler and rocker, from the places of B, C and D."""
    bar = FourBar(*lengths)
    near, far = bar.driver_range_rad
    theta = np.linspace(near + 1e-12, far - 1e-12, 5001)
    motion = solve_driven(fourbar(*lengths), theta, np.ones(1), np.zeros(1), bound=False)
    b, c, d = (motion.points[p].position @ (1.0, 1.0j) for p in "BCD")
    mu = np.abs(np.angle((b - c) / (d - c)))
    low, high = bar.transmission_rad
    tolerance = 1e-6 if bar.driver_turns_fully else 1e-4  # a square root at the ends of the range
    assert mu.min() == pytest.approx(low, abs=tolerance)
    assert mu.max() == pytest.approx(high, abs=tolerance)


@pytest.mark.parametrize("e", [0.0, -0.02, 0.15])
def test_stroke_and_time_ratio_of_the_slider_crank(e: float) -> None:
    """On either side of the pivot: to and fro change places, the ratio stays above 1; as in lecture
    "Tong hop co cau", by the angle between the rod's limit positions."""
    scene, r, rod = load_scene("slider-crank-offset"), 0.1, 0.3
    scene = replace(scene, sliders={"C": replace(scene.sliders["C"], through_m=(0.0, -e))})
    found = travel(scene, "C")
    stroke = math.sqrt((rod + r) ** 2 - e**2) - math.sqrt((rod - r) ** 2 - e**2)
    imbalance = abs(math.asin(e / (rod - r)) - math.asin(e / (rod + r)))
    assert (found.high_at_rad - found.low_at_rad) % math.tau > math.pi or e <= 0.0
    assert found.stroke == pytest.approx(stroke, abs=1e-15)
    ratio = (math.pi + imbalance) / (math.pi - imbalance)
    assert found.time_ratio == pytest.approx(ratio, rel=1e-13)


@pytest.mark.parametrize("short", [1e-3, 1e-12])
def test_a_lever_that_swings_back_between_two_looks_is_seen_to(short: float) -> None:
    """With the block next to the pivot it goes half a turn back in a millionth of one."""
    ground = {"A": (0.0, 0.1 / (1.0 - short)), "C": (0.0, 0.0)}
    found = travel(replace(load_scene("slotted-lever"), ground=ground), "lever")
    assert found.stroke == pytest.approx(2.0 * math.asin(1.0 - short), abs=1e-8)
    narrow = 2.0 * math.acos(1.0 - short)  # math.pi - beta, with its digits
    assert found.time_ratio == pytest.approx((math.tau - narrow) / narrow, rel=1e-3)


def test_limit_positions_are_where_the_output_rests() -> None:
    for name, output in (("shaper", "F"), ("sixbar-watt", "lever"), ("slider-crank-offset", "C")):
        scene = load_scene(name)
        found = travel(scene, output)
        at = np.array([found.low_at_rad, found.high_at_rad])
        place, rate, _ = series(solve_driven(scene, at, np.ones(2), np.zeros(2)), output)
        assert np.allclose(rate, 0.0, rtol=0, atol=1e-12)
        assert np.allclose(np.diff(place), found.stroke, rtol=0, atol=1e-12)
        dense = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 4001), bound=False)
        swept, _, _ = series(dense, output)
        assert np.ptp(swept) == pytest.approx(found.stroke, abs=1e-5 * found.stroke)
        assert np.ptp(swept) <= found.stroke + 1e-12


def test_output_without_limits_is_refused() -> None:
    with pytest.raises(CrankcheckError, match="lever never turns back"):
        travel(load_scene("whitworth"), "lever")
    said = "no link or slider 'ram'; it has crank, lever, rod, B, F"
    with pytest.raises(CrankcheckError, match=said):
        travel(load_scene("shaper"), "ram")
    scene = load_scene("fourbar-double-rocker")
    turning = replace(scene, driver=Driver(scene.driver.link, ConstantSpeed(0.0, 1.0)))
    with pytest.raises(ReachError, match="driver can stand at"):
        travel(turning, "rocker")


def test_travels_of_many_outputs_take_the_work_of_one(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene("sixbar-watt")
    asked = Mock(wraps=solve_driven)
    monkeypatch.setattr("analytic.mechanism.cycle.solve_driven", asked)
    found = travels(scene, (*scene.links, *scene.sliders))
    together = asked.call_count
    moving = [output for output, one in found.items() if isinstance(one, Travel)]
    assert len(moving) > 2
    for output in moving:
        asked.reset_mock()
        assert travel(scene, output) == found[output]
        assert asked.call_count == together


def test_an_offset_counts_in_the_name_of_a_chain_and_a_six_bar_has_none() -> None:
    assert slider_crank_type(0.1, 0.3, 0.1).driver_turns
    assert slider_crank_type(0.1, 0.3, 0.21).margin_m < 0.0
    assert slider_crank_type(0.1, 0.3, 0.2).name == "change point, offset slider-crank"
    assert slider_crank_type(0.2, 0.2, 0.0).name == "change point, isosceles central slider-crank"
    assert inverted_slider_crank_type(0.3, 0.1, 0.05).follower_turns
    assert not inverted_slider_crank_type(0.1, 0.3, 0.05).follower_turns
    assert not inverted_slider_crank_type(0.1, 0.3, 0.25).driver_turns
    with pytest.raises(ValueError, match="reach the line together"):
        slider_crank_type(0.1, 0.1, 0.3)
    for crank, ground, offset in ((0.0, 0.3, 0.1), (0.3, 0.0, 0.1), (0.1, 0.1, 0.3)):
        with pytest.raises(ValueError, match="reach the guide together"):
            inverted_slider_crank_type(crank, ground, offset)
    names = ("slider-crank-offset", "whitworth", "slotted-lever")
    words = ("Grashof offset slider-crank", "Whitworth", "slotted lever")
    for name, word in zip(names, words, strict=True):
        assert word in grashof_of(load_scene(name)).name
    assert grashof_of(load_scene("sixbar-watt")) is None


EACH = [("fourbar-lecture-1", "rocker"), ("fourbar-lecture-1", Along("C", -1.0))]
EACH += [("slider-crank-offset", "C"), ("shaper", "F"), ("shaper", "rod"), ("whitworth", "lever")]


@pytest.mark.parametrize(("name", "output"), EACH)
def test_no_sample_is_faster_and_there_is_no_acceleration(name: str, output: Output) -> None:
    """To rounding: that of a speed, and that of an angle by the third rate of the place."""
    scene = load_scene(name)
    scene = replace(scene, driver=Driver(scene.driver.link, ConstantSpeed(0.0, 1.0)))
    found = extreme_speeds(scene, [output])[output]
    at = np.array([one.driver_rad for one in found])
    _, rate, second = series(solve_driven(scene, at, np.ones(1), np.zeros(1)), output)
    dense = solve(scene, np.linspace(0.0, math.tau, 20_001))
    _, rates, seconds = series(dense, output)
    third = np.abs(np.gradient(seconds, dense.time_s)).max()
    assert np.abs(second).max() < 1e-14 * (third + np.abs(seconds).max()) * math.tau
    assert [one.rate for one in found] == list(rate)
    size = np.abs(rates).max()
    assert rates.max() <= rate.max() + 1e-14 * size
    assert rates.min() >= rate.min() - 1e-14 * size
    assert rates.max() == pytest.approx(rate.max(), abs=1e-6 * size)
    sign = np.sign(seconds[:-1])
    assert len(found) == np.count_nonzero(sign != np.roll(sign, 1))


def test_a_block_is_fastest_where_a_cubic_has_its_root_and_a_crank_nowhere() -> None:
    """With n rod over crank and s = sin^2 of its angle: s^3 - n^2 s^2 - n^4 s + n^4 = 0, which is
    X'' = 0 of the Excel paper, squared, without the factor that has no root."""
    for length in (2.5, 3.5):
        scene, n = load_scene(f"slider-crank-excel-{round(100 * length)}"), length / 2.0
        roots = np.roots([1.0, -(n**2), -(n**4), n**4])
        (s,) = (float(r.real) for r in roots if abs(r.imag) < 1e-12 and 0.0 < r.real < 1.0)
        at = math.asin(math.sqrt(s))
        found = [one.driver_rad for one in extreme_speeds(scene, ["C"])["C"]]
        assert found == pytest.approx([at, math.tau - at], abs=1e-13)
    even = extreme_speeds(load_scene("scotch-yoke"), ["crank", "yoke", "Y"])
    assert (even["crank"], even["yoke"], len(even["Y"])) == ((), (), 2)


def test_a_point_of_the_crank_travels_its_diameter_along_every_direction() -> None:
    scene = load_scene("fourbar-lecture-1")
    for direction in (0.0, 1.0, -2.5):
        along = Along("B", direction)
        found = travel(scene, along)
        assert found.stroke == pytest.approx(0.2, rel=1e-14)
        assert found.time_ratio == pytest.approx(1.0, rel=1e-14)
        assert found.high_at_rad == pytest.approx(direction % math.tau, abs=1e-15)
    with pytest.raises(CrankcheckError, match="A never turns back"):
        travel(scene, Along("A", 0.0))


def test_a_swinging_driver_has_its_limits_at_the_ends_of_its_swing() -> None:
    """Tangent mechanism: y = h tan(phi), and the sleeve goes out to both sides from h."""
    scene, h, end = load_scene("tangent"), 0.15, math.radians(40.0)
    assert travel(scene, "P").stroke == pytest.approx(2.0 * h * math.tan(end), rel=1e-14)
    assert travel(scene, "P").time_ratio == pytest.approx(1.0, rel=1e-14)
    sleeve = travel(scene, "sleeve")
    assert sleeve.stroke == pytest.approx(h / math.cos(end) - h, rel=1e-13)
    assert (sleeve.limits, sleeve.time_ratio) == (4, pytest.approx(1.0, rel=1e-13))
    lever = extreme_speeds(scene, ["lever"])["lever"]
    assert [one.rate for one in lever] == pytest.approx([end, -end], rel=1e-14)
    law, extremes = scene.driver.law, extreme_speeds(scene, ["sleeve"])["sleeve"]
    for one in extremes:
        omega, _ = passing(law, one.driver_rad, clockwise=one.rate * one.driver_rad < 0.0)
        there = solve_driven(scene, np.array([one.driver_rad]), np.array([omega]), np.zeros(1))
        speed = there.sliders["sleeve"].speed[0]
        assert speed == pytest.approx(one.rate * law.frequency_rad_s, rel=1e-13)


def test_time_ratio_of_one_that_turns_back_on_its_way_is_between_the_outermost() -> None:
    """The shaper's rod is highest at both ends of the ram's stroke, and lowest in between."""
    rod, ram = (travel(load_scene("shaper"), output) for output in ("rod", "F"))
    assert (rod.limits, ram.limits) == (4, 2)
    assert rod.time_ratio == pytest.approx(ram.time_ratio, rel=1e-12)
    assert rod.period_rad == pytest.approx(math.pi, rel=1e-12)


def test_a_rest_is_neither_a_reversal_nor_an_extreme_speed() -> None:
    roller = load_scene("cam-roller")
    lift, stop = roller.cams["disc"].profile.law.segments[:2]
    part = replace(lift, lift=0.5 * lift.lift, span_rad=0.5 * lift.span_rad)
    pause = replace(stop, span_rad=0.5 * stop.span_rad)
    segments = (part, pause, part, pause, *roller.cams["disc"].profile.law.segments[2:])
    pair = roller.cams["disc"]
    profile = replace(pair.profile, law=replace(pair.profile.law, segments=segments))
    stepped = replace(roller, cams={"disc": replace(pair, profile=profile)})
    for scene, rises in ((roller, 1), (stepped, 2)):
        assert travel(scene, "guide").limits == 2
        rates = [one.rate for one in extreme_speeds(scene, ["guide"])["guide"]]
        # 15/8 of the mean speed (3-4-5), 2 (cycloidal); Norton, Design of Machinery, table 8-3
        ups = [1.875 * 0.02 / math.radians(120.0)] * rises
        assert rates == pytest.approx([*ups, -2.0 * 0.02 / math.radians(120.0)], rel=1e-12)
