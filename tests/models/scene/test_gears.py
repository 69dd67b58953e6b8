"""Gears of a scene: their tables, their relation, and scenes that are moved, turned and scaled."""

import math
import pickle
from dataclasses import replace

import pytest

from models.files.assemble import scene_text
from models.files.reading import every_shipped, load_scene, parse_scene
from models.scene.moved import mirrored, moved, rotated, scaled
from models.scene.pairs import Gear

PLANETARY = """
name = "planetary"
source = "a test"
[ground.points]
O = [0.0, 0.0]
[links.sun]
points = { O = [0.0, 0.0], S = [0.02, 0.0] }
[links.arm]
points = { O = [0.0, 0.0], P = [0.06, 0.0] }
[links.planet]
points = { P = [0.0, 0.0], Q = [0.04, 0.0] }
[gears.inner]
bodies = ["sun", "planet"]
teeth = [20, 40]
carrier = "arm"
module_m = 0.002
efficiency = 0.98
[gears.outer]
bodies = ["planet", "ground"]
teeth = [40, 100]
carrier = "arm"
internal = true
pressure_angle_deg = 25.0
[driver]
link = "sun"
speed_rad_s = 10.0
"""


def test_gears_are_read_and_read_back_as_themselves() -> None:
    scene = parse_scene(PLANETARY, "good")
    assert parse_scene(scene_text(scene), "again") == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    angle = math.radians(25.0)
    assert scene.gears == {
        "inner": Gear("inner", ("sun", "planet"), (20, 40), "arm", module_m=0.002, efficiency=0.98),
        "outer": Gear("outer", ("planet", "ground"), (40, 100), "arm", True, None, angle),
    }
    with pytest.raises(TypeError, match="not changed"):
        scene.gears["inner"] = scene.gears["outer"]


def test_relations_hold_where_circles_roll() -> None:
    """Circles roll: the points of both gears at the pitch point have one velocity."""
    for gear in parse_scene(PLANETARY, "good").gears.values():
        first, second = gear.teeth
        own, arm = 1.3, -0.4
        # Of the first gear's centre at 0, the pitch point lies at its radius, and beyond both of
        # an internal pair; the second centre at the sum, or minus the difference, of the radii.
        centre = first + second if not gear.internal else first - second
        speed = arm * centre
        other = (own * first - speed) / (first - centre)
        rates = {gear.bodies[0]: own, gear.bodies[1]: other, gear.carrier: arm}
        assert sum(c * rates[body] for body, c in gear.relation.items()) == pytest.approx(0.0)
        assert sum(gear.relation.values()) == 0


def test_centres_and_modules_follow_from_shared_points() -> None:
    scene = parse_scene(PLANETARY, "good")
    inner, outer = scene.gears.values()
    assert inner.pivots(scene.points_of) == ("O", "P")
    assert outer.pivots(scene.points_of) == ("P", "O")
    assert inner.module(scene.points_of) == 0.002
    assert outer.module(scene.points_of) == pytest.approx(0.002)
    concentric = replace(inner, bodies=("sun", "ground"), module_m=None)
    assert concentric.module(scene.points_of) is None


def test_gears_survive_moves_turns_mirrors_and_scales() -> None:
    scene = parse_scene(PLANETARY, "good")
    for other in (moved(scene, (1.0, 2.0)), mirrored(scene, ())):
        assert other.gears == scene.gears
    turned = rotated(scene, 0.7).gears  # against the ring on the ground the others are turned
    assert turned == scene.gears | {"outer": replace(scene.gears["outer"], phase_rad=-0.7)}
        assert parse_scene(scene_text(other), "again").gears == scene.gears
    large = scaled(scene, 3.0)
    assert large.gears["inner"].module_m == pytest.approx(0.006)
    assert large.gears["outer"] == scene.gears["outer"]
    assert large.gears["outer"].module(large.points_of) == pytest.approx(0.006)
    parse_scene(scene_text(large), "large")  # the centre distance fits the module


def test_scenes_without_gears_write_none() -> None:
    assert not any("gears" in scene_text(load_scene(name)) for name in every_shipped()
                   if not load_scene(name).gears)  # fmt: skip
