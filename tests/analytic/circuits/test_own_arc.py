"""The branch of any mechanism, whatever drives it, against the same one driven elsewhere."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from analytic.circuits.circuits import circuits_of
from analytic.circuits.own_arc import own_arc
from analytic.circuits.rotatability import Rotation, rotations
from analytic.dyads.driven import driver_scale
from models.errors import ReachError
from models.files import load_scene


def turning(name: str) -> dict[tuple[str, str], Rotation]:
    scene = load_scene(name)
    return {(one.link, one.against): one for one in rotations(scene, own_arc(scene))}


def test_a_piston_stops_where_crank_and_rod_are_in_line() -> None:
    scene = load_scene("slider-crank-by-piston")
    arc = own_arc(scene)
    ends = [end.angle_rad * driver_scale(scene) for end in (arc.low, arc.high) if end is not None]
    assert ends == pytest.approx([0.2, 0.4], rel=1e-12)
    assert turning(scene.name)["rod", "ground"].low_rad == pytest.approx(-math.asin(1.0 / 3.0))


def test_a_start_that_is_none_is_refused_with_where_it_can_stand() -> None:
    scene = load_scene("slider-crank-by-piston")
    elsewhere = replace(scene.driver, law=replace(scene.driver.law, centre_rad=0.0))  # type: ignore[call-arg]  # of a law that swings
    with pytest.raises(ReachError, match=r"can stand at -0\.4 to -0\.2 m and"):
        own_arc(replace(scene, driver=elsewhere))


def test_a_four_bar_does_the_same_whichever_joint_drives() -> None:
    other = load_scene("fourbar-lecture-1")
    by_coupler = turning("fourbar-by-coupler")
    for one in rotations(other, circuits_of(other).own[1]):
        told = by_coupler[one.link, one.against]
        assert abs(told.turns) == abs(one.turns)
        assert one.turns or told.swing_rad == pytest.approx(one.swing_rad, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "other", "links"),
    [
        ("triad-platform", "triad-platform-by-leg", ("leg2", "leg3", "plate")),
        ("triad-slider", "triad-slider-by-rocker", ("rocker", "plate")),
    ],
)
def test_links_of_a_triad_swing_as_far_as_where_one_of_them_drives(
    name: str, other: str, links: tuple[str, ...]
) -> None:
    told, dyads = turning(name), turning(other)
    for link in links:
        swings = [each[link, "ground"].swing_rad for each in (told, dyads)]
        assert swings[0] == pytest.approx(swings[1], rel=1e-7), link
