"""The driver's reachable range, held to the four-bar's closed form, and what names it."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from analytic.circuits.circuits import circuits_of
from analytic.circuits.own_arc import own_arc
from analytic.kinematics import reach, solve, solve_driven
from analytic.mechanism.fourbar import FourBar
from models.errors import ReachError
from models.files import load_scene, shipped
from tests.analytic.four_bars import fourbar
from tests.worlds.tiers import slowly

WHOLE = [(-math.pi, math.pi)]
SWINGING = [
    (0.25, 0.1, 0.2, 0.3),  # double-rocker: one range to each side
    (0.3, 0.5, 0.15, 0.3),  # about the far side: a range that holds pi
    (0.3, 0.2, 0.3, 0.25),  # triple-rocker about the near side: a range that holds 0
]
TURN_FULLY = ["fourbar-lecture-1", "slider-crank-offset", "whitworth", "shaper", "sixbar-watt"]
TURN_FULLY += ["triad-platform"]


def closed_form(bar: FourBar) -> list[tuple[float, float]]:
    """The ranges that the closed form gives, as `reach` writes them."""
    near, far = bar.driver_range_rad
    if bar.driver_turns_fully:
        return WHOLE
    if far >= math.pi - 1e-12:
        return [(near, math.tau - near)]
    if near <= 1e-12:
        return [(-far, far)]
    return [(-far, -near), (near, far)]


@pytest.mark.parametrize("lengths", [*SWINGING, (0.1, 0.25, 0.2, 0.3)])
def test_range_is_that_of_the_closed_form(lengths: tuple[float, float, float, float]) -> None:
    found, wanted = reach(fourbar(*lengths)), closed_form(FourBar(*lengths))
    assert np.shape(found) == np.shape(wanted)
    assert np.allclose(found, wanted, rtol=0, atol=1e-7)


@pytest.mark.parametrize("count", [60, slowly(1000, reason="random lengths, some near a limit")])
def test_range_of_random_fourbars_is_that_of_the_closed_form(count: int) -> None:
    rng, kinds = np.random.default_rng(3), set()
    for _ in range(count):
        lengths = tuple(float(x) for x in rng.uniform(0.1, 1.0, 4))
        if max(lengths) > 0.95 * (sum(lengths) - max(lengths)):
            continue
        wanted = closed_form(FourBar(*lengths))
        if len(wanted) == 1 and 0.0 < math.tau - (wanted[0][1] - wanted[0][0]) < 0.01:
            continue  # narrower than the scan promises to see
        if min(b - a for a, b in wanted) < 0.01:
            continue
        found = reach(fourbar(*lengths))
        assert np.shape(found) == np.shape(wanted), lengths
        # The square root at toggle turns rounding of the shortage into 1e-8 of the angle.
        assert np.allclose(found, wanted, rtol=0, atol=1e-6), lengths
        kinds.add((len(wanted), wanted[0][1] > math.pi, wanted[0][0] < 0.0))
    assert len(kinds) >= 3, "full turns, two ranges, and ranges that hold 0 or pi"


@pytest.mark.parametrize("name", shipped())
def test_driver_of_every_shipped_scene_stays_in_reach(name: str) -> None:
    scene = load_scene(name)
    theta = scene.driver.law.at(np.linspace(0.0, scene.driver.law.period_s, 500))[0]
    turned = (theta + math.pi) % math.tau - math.pi
    inside = [(low <= turned) & (turned <= high) for low, high in reach(scene)]
    assert np.any(inside, axis=0).all()


def test_ends_of_the_range_can_be_solved_and_what_is_beyond_cannot() -> None:
    for lengths in SWINGING:
        scene = fourbar(*lengths)
        for low, high in reach(scene):
            motion = solve_driven(scene, np.array([low, high]), np.ones(1), np.zeros(1))
            assert (motion.conditioning["C"] < 1e-6).all()
            for beyond in (low - 1e-9, high + 1e-9):
                with pytest.raises(ReachError):
                    solve_driven(scene, np.array([beyond]), np.ones(1), np.zeros(1))


def test_error_names_the_angle_the_gap_and_the_range() -> None:
    scene = load_scene("fourbar-double-rocker")
    with pytest.raises(ReachError) as raised:
        solve_driven(scene, np.array([0.7, 1.6, 1.2]), np.ones(3), np.zeros(3))
    said = str(raised.value)
    worst = math.hypot(0.3 - 0.25 * math.cos(1.6), 0.25 * math.sin(1.6)) - 0.3
    assert f"driver at {math.degrees(1.6):.6g} deg: the loop cannot close at C" in said
    assert f"open by {worst:.3g} m" in said
    near, far = (math.degrees(a) for a in FourBar(0.25, 0.1, 0.2, 0.3).driver_range_rad)
    assert f"-{far:.6g} to -{near:.6g} deg and {near:.6g} to {far:.6g} deg" in said


def test_loop_that_never_closes_says_by_how_much() -> None:
    """Nearest with the crank towards D: 1 - 0.1 - (0.05 + 0.05) m are missing."""
    with pytest.raises(ReachError, match=r"cannot be assembled at any angle of crank") as raised:
        solve(fourbar(0.1, 0.05, 0.05, 1.0), np.zeros(1))
    assert re.search(r"nearest at -?0 deg, open by 0\.8 m", str(raised.value))


def test_range_that_holds_pi_is_named_as_one() -> None:
    scene = fourbar(0.3, 0.5, 0.15, 0.3)
    near = math.degrees(FourBar(0.3, 0.5, 0.15, 0.3).driver_range_rad[0])
    with pytest.raises(ReachError, match=f"crank can stand at {near:.6g} to {360 - near:.6g} deg"):
        solve(scene, np.zeros(1))


def test_range_of_the_whole_chain_is_that_of_its_worst_dyad() -> None:
    """The ram's rod is too short for the lever's arc about the middle of the stroke."""
    scene = load_scene("shaper")
    rod = replace(scene.links["rod"], points={"E": (0.0, 0.0), "F": (0.05, 0.0)})
    ram = replace(scene.sliders["F"], through_m=(0.0, 0.53))
    links, sliders = {**scene.links, "rod": rod}, {**scene.sliders, "F": ram}
    short = replace(scene, links=links, sliders=sliders)
    found = reach(short)
    assert found
    assert found != WHOLE
    for low, high in found:
        solve_driven(short, np.linspace(low, high, 50), np.ones(1), np.zeros(1))


def test_parallel_lines_that_never_cross_are_said_to_be_open() -> None:
    scene = load_scene("scotch-yoke")
    yoke, slot = scene.sliders["Y"], scene.sliders["B"]
    parallel = {"Y": replace(yoke, through_m=(0.0, 0.4)), "B": replace(slot, direction_rad=0.0)}
    said = r"cannot be assembled at any angle of crank.*open by 0\.3 m"
    with pytest.raises(ReachError, match=said):
        solve(replace(scene, sliders=parallel), np.zeros(1))


@pytest.mark.parametrize("name", TURN_FULLY)
def test_crank_that_turns_fully_has_the_whole_turn(name: str) -> None:
    assert reach(load_scene(name)) == WHOLE


def test_parallelogram_does_not_raise_at_its_change_points() -> None:
    scene = fourbar(0.1, 0.3, 0.1, 0.3)
    assert reach(scene) == WHOLE
    theta = np.array([0.0, math.pi, -math.pi, math.tau])
    motion = solve_driven(scene, theta, np.ones(1), np.zeros(1))
    assert np.isfinite(motion.links["rocker"].theta).all()


def test_a_triad_that_goes_on_for_more_than_a_turn_and_ends_is_told_with_both_ends() -> None:
    scene = load_scene("triad-slider")
    plate = scene.links["plate"]
    plate = replace(plate, points={**plate.points, "E": (0.5, 0.0)})
    scene = replace(scene, links={**scene.links, "plate": plate}, branch={"plate": 2})
    ((low, high),) = reach(scene)
    assert math.degrees(high - low) == pytest.approx(365.09, abs=0.01)
    ends = "crank can stand at -315.094 to 49.9984 deg."
    with pytest.raises(ReachError, match=re.escape(ends)):
        solve(scene, np.linspace(0.0, 0.1, 50))
    assert own_arc(scene).range_rad == pytest.approx((low, high), abs=1e-9)


def test_a_gap_in_a_narrow_range_is_found() -> None:
    """A crank of 600 m that swings by 0.24 degrees, and can not stand in the middle 0.006 of it."""
    lengths = (596.4151759095241, 0.18391558696195465, 2.1549374201702505, 598.3859439717008)
    near, far = FourBar(*lengths).driver_range_rad
    scene = fourbar(*lengths)
    found = reach(scene)
    assert np.array(found) == pytest.approx(np.array([(-far, -near), (near, far)]), abs=1e-9)
    arcs = [arc for circuit in circuits_of(scene).circuits for arc in circuit]
    own = np.array(sorted({arc.range_rad for arc in arcs}))
    assert own == pytest.approx(np.array(found), abs=1e-9)
