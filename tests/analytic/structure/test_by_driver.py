"""How the class follows the driver."""

from __future__ import annotations

from dataclasses import replace

import pytest

from analytic.structure.by_driver import StructureByDriver, by_drivers
from analytic.structure.mobility import analyse
from models.files import load_scene, parse_scene
from models.scene import Driver


def classes(name: str) -> dict[str, StructureByDriver]:
    scene = load_scene(name)
    return {one.joint.words: one for one in by_drivers(scene, analyse(scene))}


def test_a_stephenson_six_bar_is_of_class_three_by_its_far_joints() -> None:
    found = {words: one.class_number for words, one in classes("sixbar-stephenson").items()}
    assert found == {
        "pin A of ground and crank": 2,
        "pin B of crank and coupler": 2,
        "pin C of coupler and rocker": 2,
        "pin D of ground and rocker": 2,
        "pin E of coupler and rod": 3,
        "pin F of rod and lever": 3,
        "pin G of ground and lever": 3,
    }


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "shaper", "sixbar-watt", "scotch-yoke"])
def test_one_joint_is_the_scenes_own_and_has_its_groups(name: str) -> None:
    own = [one for one in classes(name).values() if one.is_own]
    structure = analyse(load_scene(name))
    assert [[group.links for group in one.groups] for one in own] == [
        [group.bodies for group in structure.groups]
    ]


def test_groups_by_a_slider_are_those_of_a_scene_that_it_drives() -> None:
    scene = load_scene("slider-crank-central")
    name = next(iter(scene.sliders))
    found = next(one for one in classes(scene.name).values() if one.joint.slider == name)
    driven = replace(
        scene, driver=Driver(f"block {name}", scene.driver.law, slider=name), branch={}
    )
    assert [one.links for one in found.groups] == [one.bodies for one in analyse(driven).groups]


RING = """
name = "ring"
source = "a test"
[ground]
points = { A = [0.0, 0.0], D = [0.3, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
bar = { bar = ["B", "C"], length_m = 0.25 }
plate = { points = { C = [0.0, 0.0], E = [0.1, 0.1], K = [0.2, 0.0] } }
swing = { bar = ["D", "K"], length_m = 0.2 }
[sliders.E]
on = "crank"
direction_deg = 20.0
[driver]
link = "crank"
speed_rad_s = 1.0
start_deg = 60.0
"""


def test_a_slider_closes_a_ring_of_four_bodies_of_class_four() -> None:
    scene = parse_scene(RING, "test")
    found = {one.joint.words: one for one in by_drivers(scene, analyse(scene))}
    (group,) = found["pin D of ground and swing"].groups
    assert (group.class_number, group.order) == (4, 2)
    assert set(group.links) == {"crank", "bar", "plate", "block E"}
