"""What links do, against closed forms of the four-bar and the slider-crank."""

from __future__ import annotations

import math

import pytest

from analytic.circuits.circuits import circuits_of
from analytic.circuits.dead_points import dead_points
from analytic.circuits.rotatability import rotations
from analytic.circuits.transmission import transmissions
from analytic.mechanism.fourbar import FourBar
from models.files import load_scene


def test_a_crank_rocker_swings_and_transmits_as_its_closed_form_says() -> None:
    scene = load_scene("fourbar-lecture-1")
    bar, circuits = FourBar.of(scene), circuits_of(scene)
    turning = {(one.link, one.against): one for one in rotations(scene, circuits.own[1])}
    assert turning["crank", "ground"].turns == 1
    assert turning["coupler", "crank"].turns == -1
    assert turning["rocker", "ground"].swing_rad == pytest.approx(bar.rocker_swing_rad, rel=1e-12)
    (dyad,), merit = transmissions(circuits)
    assert (dyad.smallest_rad.value, dyad.largest_rad.value) == pytest.approx(bar.transmission_rad)
    assert merit.value == pytest.approx(min(math.sin(mu) for mu in bar.transmission_rad))
    dead = dead_points(circuits, list(turning.values()))
    assert [point.where for point in dead] == ["crank and coupler in line"] * 2
    assert {point.input for point in dead} == {"rocker"}


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


@pytest.mark.parametrize(("name", "turns"), [("whitworth", 1), ("slotted-lever", 0)])
def test_the_guide_turns_in_whitworths_quick_return_alone(name: str, turns: int) -> None:
    scene = load_scene(name)
    _, own = circuits_of(scene).own
    turning = {(one.link, one.against): one for one in rotations(scene, own)}
    assert turning["lever", "ground"].turns == turns
