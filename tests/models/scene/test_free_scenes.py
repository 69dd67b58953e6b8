"""Scenes that are let go: what their files say, and what is refused before anything moves."""

import math
from dataclasses import replace
from operator import attrgetter

import pytest

from models.errors import SceneError
from models.files.assemble import scene_text
from models.files.reading import every_shipped, load_scene, parse_scene, shipped
from models.scene import Driver
from models.scene.driver import Released, let_go
from models.scene.hard import WindowChain
from models.scene.loads import LineSpring, PinSpring, SlideSpring
from tests.worlds.let_go import EVERYTHING

FREE = EVERYTHING.replace(
    "rates_rad_s = {", "displacements_m = { C = 0.38 }\nspeeds_m_s = { C = -0.1 }\nrates_rad_s = {"
)


def test_what_a_free_scene_says_is_read_and_reads_back_as_itself() -> None:
    scene = parse_scene(FREE, "good")
    assert parse_scene(scene_text(scene), "again") == scene
    assert scene.is_free
    assert scene.driver.law == Released(math.radians(30.0), 2.0, 4.0)
    assert scene.links["crank"].inertia_kg_m2 == pytest.approx(0.01 + 0.1 * 0.1**2 / 12)
    assert scene.springs == {
        "line": LineSpring("line", 50.0, 0.0, 0.1, ("G", "S")),
        "turning": PinSpring("turning", 0.3, 0.01, math.radians(-20.0), "B", ("crank", "rod")),
        "along": SlideSpring("along", 0.0, 0.2, 0.0, "C"),
    }
    assert scene.start.displacements_m == {"C": 0.38}
    # The start may say again what the driver says.
    assert scene.start.angles_rad["crank"] == scene.driver.law.offset_rad
    again = replace(scene, start=replace(scene.start, angles_rad={"crank": math.radians(30.0)}))
    assert again == scene


def test_free_scenes_ship_and_all_are_let_go_and_the_chain_is_the_one_that_is_made() -> None:
    assert len(shipped("free")) >= 8
    free = {*shipped("free"), "fourbar-elastic-pulse"}
    for name in every_shipped():
        assert load_scene(name).is_free == (name in free)
    made, read = WindowChain(2).scene(), load_scene("fourbar-chain")
    assert read.driver == Driver("rocker0", Released(math.pi / 2, -1.0, 10.0))
    words = {key: getattr(read, key) for key in ("name", "source", "note", "driver")}
    assert replace(made, **words) == read


def test_what_is_driven_has_no_start_and_what_has_no_mass_is_not_let_go() -> None:
    driven = FREE.replace('law = "free"', 'law = "constant"').replace("duration_s = 4.0\n", "")
    with pytest.raises(SceneError, match='start: only for law = "free"; a driven mechanism'):
        parse_scene(driven, "file")
    light = FREE.replace(", flywheel_kg_m2 = 0.01", "").replace("mass_kg = 0.5", "")
    light = light.replace("length_m = 0.1 }", "length_m = 0.1, mass_kg = 0.0 }")
    light = light.replace("length_m = 0.3 }", "length_m = 0.3, mass_kg = 0.0 }")
    with pytest.raises(SceneError, match="links: no body has a mass") as error:
        parse_scene(light, "file")
    assert len(error.value.faults) == 1


def test_let_go_it_begins_where_the_law_is_for_ten_of_its_turns_or_a_time_that_is_given() -> None:
    for name in ("fourbar-lecture-1", "fourbar-double-rocker", "slotted-lever"):
        scene = load_scene(name)
        law, free = scene.driver.law, let_go(scene)
        assert free.is_free
        began, speed, _ = law.at(0.0)
        expected = Released(float(began), float(speed), 10.0 * law.period_s)
        assert vars(free.driver.law) == pytest.approx(vars(expected))
        for one in ("links", "branch", "driver.link"):
            assert attrgetter(one)(free) == attrgetter(one)(scene)
    scene = load_scene("fourbar-swing")
    assert let_go(scene) is scene
    longer = let_go(scene, 12.0)
    assert longer.driver.law.period_s == 12.0
    assert longer.driver.law.offset_rad == math.fabs(scene.driver.law.offset_rad)
