"""Reach, circuits, and what links do: by closed forms, and of six-bars by a count on a grid."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from analytic.dyads.chunk import driver_scale
from analytic.kinematics import reach, solve, solve_driven
from analytic.lectures.circuits.arcs import own_arc
from analytic.lectures.circuits.circuits import Position, circuits_of, transmissions
from analytic.lectures.circuits.rotatability import (
    Rotation,
    circuit_rotations,
    dead_points,
    rotations,
)
from analytic.mechanism.fourbar import FourBar
from models.errors import CrankcheckError, ReachError
from models.files.reading import load_scene
from models.scene import Driver, Scene
from models.scene.driver import Released
from tests.analytic.four_bars import fourbar, random_bars, rocker_limits_rad
from tests.worlds.tiers import slow, slowly

WHOLE = [(-math.pi, math.pi)]
SWINGING = [
    (0.25, 0.1, 0.2, 0.3),  # double-rocker: one range to each side
    (0.3, 0.5, 0.15, 0.3),  # about the far side: a range that holds pi
    (0.3, 0.2, 0.3, 0.25),  # triple-rocker about the near side: a range that holds 0
]


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


@pytest.mark.parametrize("count", [30, slowly(1000, reason="random lengths, some near a limit")])
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


def test_a_crank_turns_fully_or_to_ends_that_can_be_solved_and_beyond_can_not() -> None:
    for name in ("whitworth", "sixbar-watt", "triad-platform"):
        assert reach(load_scene(name)) == WHOLE
    for lengths in SWINGING:
        scene, wanted = fourbar(*lengths), closed_form(FourBar(*lengths))
        assert np.array(reach(scene)) == pytest.approx(np.array(wanted), abs=1e-7)
        for low, high in reach(scene):
            motion = solve_driven(scene, np.linspace(low, high, 3), np.ones(1), np.zeros(1))
            assert (motion.conditioning["C"][[0, 2]] < 1e-6).all()
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


def parallel() -> Scene:
    """A yoke that slides on the line of its own slot."""
    scene = load_scene("scotch-yoke")
    yoke, slot = scene.sliders["Y"], scene.sliders["B"]
    sliders = {"Y": replace(yoke, through_m=(0.0, 0.4)), "B": replace(slot, direction_rad=0.0)}
    return replace(scene, sliders=sliders)


NEAR = math.degrees(FourBar(*SWINGING[1]).driver_range_rad[0])
NOWHERE = "cannot be assembled at any angle of crank.*"
OUT = {
    f"crank can stand at {NEAR:.6g} to {360 - NEAR:.6g} deg": fourbar(*SWINGING[1]),
    NOWHERE + r"open by 0\.3 m": parallel(),
    # with the crank towards D: 1 - 0.1 - (0.05 + 0.05) m are missing
    NOWHERE + r"nearest at -?0 deg, open by 0\.8 m": fourbar(0.1, 0.05, 0.05, 1.0),
}


@pytest.mark.parametrize("said", OUT)
def test_what_is_out_of_reach_says_by_how_much_or_where_it_is_not(said: str) -> None:
    with pytest.raises(ReachError, match=said):
        solve(OUT[said], np.zeros(1))


@slow("rare: an arc that is longer than a turn, and ends")
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


@pytest.mark.parametrize("count", [15, slowly(150, reason="random lengths")])
def test_a_four_bar_has_two_circuits_if_it_is_grashof_and_else_one(count: int) -> None:
    seen = [0, 0]
    for bar in random_bars(3, count, 1e-3):
        found = circuits_of(fourbar(bar.driver, bar.coupler, bar.rocker, bar.ground)).circuits
        grashof = bar.excess_m < 0.0
        assert len(found) == (2 if grashof else 1), bar
        assert all((arc.low is None) == bar.driver_turns_fully for c in found for arc in c)
        seen[grashof] += 1
    assert min(seen) > 2 * count // 15


@pytest.mark.parametrize(("rod", "arcs"), [(0.3, [1, 1, 1, 1]), (0.12, [2, 2])])
def test_circuits_of_a_stephenson_six_bar_are_those_counted_on_a_grid(
    rod: float, arcs: list[int]
) -> None:
    """Of all its configurations at 720 angles, each joined to the near ones at the next angle."""
    scene = load_scene("sixbar-stephenson")
    points = {"E": (0.0, 0.0), "F": (rod, 0.0)}
    links = {**scene.links, "rod": replace(scene.links["rod"], points=points)}
    found = circuits_of(replace(scene, links=links)).circuits
    assert [len(circuit) for circuit in found] == arcs


def test_defects_are_told_apart() -> None:
    circuits = circuits_of(load_scene("fourbar-double-rocker"))
    number, own = circuits.own
    low, high = own.range_rad
    first, last = Position(low + 0.1, own.signs), Position(high - 0.1, own.signs)
    middle = Position(0.5 * (low + high), own.signs)
    assert circuits.defect([first, middle, last]) == "none"
    assert circuits.defect([last, middle, first]) == "none"
    assert circuits.defect([first, last, middle]) == "order"
    back = next(arc for arc in circuits.circuits[number] if arc is not own)
    assert circuits.defect([first, Position(middle.driver_rad, back.signs)]) == "branch"
    other = circuits.circuits[1 - number][0]
    there = Position(sum(other.range_rad) / 2, other.signs)
    assert circuits.defect([first, there]) == "circuit"
    with pytest.raises(CrankcheckError, match="can not be assembled; these signs can at"):
        circuits.place(Position(math.pi, own.signs))


def test_circuits_that_meet_in_change_points_are_one() -> None:
    parallelogram = fourbar(0.1, 0.3, 0.1, 0.3)
    assert reach(parallelogram) == WHOLE
    found = circuits_of(parallelogram)
    assert found.change_points
    assert len(found.circuits) == 1


def turning(name: str) -> dict[tuple[str, str], Rotation]:
    scene = load_scene(name)
    return {(one.link, one.against): one for one in rotations(scene, own_arc(scene))}


def test_a_piston_stops_where_crank_and_rod_are_in_line_and_starts_nowhere_else() -> None:
    scene = load_scene("slider-crank-by-piston")
    arc = own_arc(scene)
    ends = [end.angle_rad * driver_scale(scene) for end in (arc.low, arc.high) if end is not None]
    assert ends == pytest.approx([0.2, 0.4], rel=1e-12)
    assert turning(scene.name)["rod", "ground"].low_rad == pytest.approx(-math.asin(1.0 / 3.0))
    elsewhere = replace(scene.driver, law=replace(scene.driver.law, centre_rad=0.0))
    with pytest.raises(ReachError, match=r"can stand at -0\.4 to -0\.2 m and"):
        own_arc(replace(scene, driver=elsewhere))


def test_links_of_a_triad_swing_as_far_as_where_one_of_them_drives() -> None:
    told, dyads = turning("triad-slider"), turning("triad-slider-by-rocker")
    for link in ("rocker", "plate"):
        swing = dyads[link, "ground"].swing_rad
        assert told[link, "ground"].swing_rad == pytest.approx(swing, rel=1e-7), link


def test_a_crank_rocker_swings_and_transmits_as_its_closed_form_says() -> None:
    scene = load_scene("fourbar-lecture-1")
    bar, circuits = FourBar.of(scene), circuits_of(scene)
    told = turning(scene.name)
    assert told["crank", "ground"].turns == 1
    assert told["coupler", "crank"].turns == -1
    swing = np.ptp(rocker_limits_rad(0.1, 0.25, 0.2, 0.3))
    assert told["rocker", "ground"].swing_rad == pytest.approx(swing, rel=1e-12)
    (dyad,), merit = transmissions(circuits)
    assert (dyad.smallest_rad.value, dyad.largest_rad.value) == pytest.approx(bar.transmission_rad)
    assert merit.value == pytest.approx(min(math.sin(mu) for mu in bar.transmission_rad))
    dead = dead_points(circuits, list(told.values()))
    assert [point.where for point in dead] == ["crank and coupler in line"] * 2
    assert {point.input for point in dead} == {"rocker"}


def test_without_a_drive_links_move_over_the_whole_circuit() -> None:
    """Led by the rocker, which turns back at its limits, the crank of a crank-rocker goes on round:
    all links do what they do behind the crank, though a branch of the rocker's has half of it."""
    led = turning("fourbar-lecture-1")
    scene = fourbar(0.2, 0.25, 0.1, 0.3)
    free = replace(scene, driver=Driver("crank", Released(1.0, 0.0, 1.0)))
    circuits = circuits_of(free)
    for circuit in circuits.circuits:
        found = {(one.link, one.against): one for one in circuit_rotations(circuits, circuit[0])}
        assert [len(circuit), abs(found["rocker", "ground"].turns)] == [2, 1]
        for own, other in (("crank", "rocker"), ("coupler", "coupler")):
            swing = led[other, "ground"].swing_rad
            assert found[own, "ground"].swing_rad == pytest.approx(swing, rel=1e-9)
        assert found["crank", "ground"].turns == found["coupler", "ground"].turns == 0
        assert found["coupler", "crank"].swing_rad == pytest.approx(
            led["rocker", "coupler"].swing_rad, rel=1e-9
        )
    dead = dead_points(circuits, circuit_rotations(circuits, circuits.own[1]))
    assert {(p.input, p.where) for p in dead} == {("crank", "coupler and rocker in line")}
    assert len(dead) == 2
    assert rotations(free, circuits.own[1])[2].turns == 0


def test_a_driver_that_swings_is_dead_where_its_dyad_is_in_line() -> None:
    scene = load_scene("fourbar-double-rocker")
    circuits = circuits_of(scene)
    turning = rotations(scene, circuits.own[1])
    assert all(one.turns == 0 for one in turning)
    low, high = FourBar.of(scene).driver_range_rad
    found = [p for p in dead_points(circuits, turning) if p.input == "driver"]
    assert [p.driver_rad for p in found] == pytest.approx([low, high], abs=1e-12)
    assert {p.where for p in found} == {"coupler and rocker in line"}


def test_pressure_angle_of_an_offset_slider_crank_is_its_closed_form() -> None:
    scene = load_scene("slider-crank-central")
    crank, rod = (math.dist(*scene.links[name].points.values()) for name in ("crank", "rod"))
    (dyad,), _ = transmissions(circuits_of(scene))
    assert dyad.pressure_rad == pytest.approx(math.asin(crank / rod))
