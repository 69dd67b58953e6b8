"""The pymunk space: only what the scene needs, assembled, and what it refuses."""

import numpy as np
import pymunk
import pytest

from models.files.reading import load_scene, parse_scene, shipped
from sim.pymunk.space import build
from tests.worlds.runs import start_of


def kinds(space: pymunk.Space) -> list[str]:
    return sorted(type(constraint).__name__ for constraint in space.constraints)


@pytest.mark.parametrize("name", sorted(shipped()))
def test_a_space_holds_the_bodies_alone_which_stand_and_move_as_in_the_state(name: str) -> None:
    scene = load_scene(name)
    state = start_of(scene, 0.1)
    model = build(scene, state)
    assert not model.space.shapes
    blocks = [s for s in scene.sliders.values() if s.mass_kg > 0.0]
    assert len(model.bodies) == len(scene.links) + len(blocks)
    assert not any(constraint.collide_bodies for constraint in model.space.constraints)
    for link in scene.links.values():
        body, centre = model.bodies[link.name], model.centre[link.name]
        for point, (x, y) in link.points.items():
            local = (x - centre[0], y - centre[1])
            place, speed = body.local_to_world(local), body.velocity_at_local_point(local)
            np.testing.assert_allclose(place, state.position[point], atol=1e-13)
            np.testing.assert_allclose(speed, state.velocity[point], atol=1e-11)


def test_the_crank_is_kinematic_or_under_a_servo_dynamic_with_a_motor() -> None:
    scene = load_scene("fourbar-lecture-1")
    model = build(scene, start_of(scene))
    assert model.crank.body_type == pymunk.Body.KINEMATIC
    assert kinds(model.space) == ["PivotJoint"] * 3
    servo = build(scene, start_of(scene), drive="servo")
    assert servo.crank.body_type == pymunk.Body.DYNAMIC
    assert servo.motor is not None
    assert kinds(servo.space) == ["PivotJoint"] * 4 + ["SimpleMotor"]


def test_joints_follow_from_what_slides_on_what() -> None:
    def made(name: str, **given: bool) -> list[str]:
        scene = load_scene(name)
        return kinds(build(scene, start_of(scene), **given).space)

    assert made("slider-crank-excel-350", exact_lines=False) == ["GrooveJoint", "PivotJoint"]
    assert made("slider-crank-excel-350") == ["PinJoint", "PivotJoint"]
    assert made("slider-crank-offset") == ["GrooveJoint", "PivotJoint", "PivotJoint"]
    assert made("slotted-lever") == ["GrooveJoint", "PivotJoint"]
    assert made("scotch-yoke") == ["GearJoint", "GrooveJoint", "GrooveJoint", "PivotJoint"]


@pytest.mark.parametrize("line", [20.0, 200.0, 340.0])
def test_a_gear_holds_a_sliding_link_where_it_starts_whole_turns_or_not(line: float) -> None:
    """The angles of links, and of a line and a link on it, are counted each for itself."""
    scene = parse_scene(DIE.format(line=line, lean=340.0 - line), "test")
    for time_s in np.linspace(0.0, scene.driver.law.period_s, 7):
        model = build(scene, start_of(scene, float(time_s)))
        (gear,) = (c for c in model.space.constraints if isinstance(c, pymunk.GearJoint))
        assert gear.b.angle - gear.a.angle - gear.phase == pytest.approx(0.0, abs=1e-12)


DIE = """
name = "die"
source = "test"
[ground]
points = {{ A = [0.0, 0.0], C = [0.0, -0.3] }}
[links]
crank = {{ bar = ["A", "B"], length_m = 0.1 }}
lever = {{ bar = ["C", "E"], length_m = 0.5 }}
die = {{ bar = ["B", "F"], length_m = 0.05 }}
[sliders.B]
on = "lever"
link = "die"
direction_deg = {line}
angle_deg = {lean}
[driver]
link = "crank"
speed_rad_s = 10.0
"""
