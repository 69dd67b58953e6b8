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


def test_free_scenes_ship_and_all_of_them_are_let_go() -> None:
    assert len(shipped("free")) >= 8
    free = {*shipped("free"), "fourbar-elastic-pulse"}
    for name in every_shipped():
        assert load_scene(name).is_free == (name in free)


def test_the_shipped_chain_is_the_one_that_is_made() -> None:
    made, read = WindowChain(2).scene(), load_scene("fourbar-chain")
    assert read.driver == Driver("rocker0", Released(math.pi / 2, -1.0, 10.0))
    words = {key: getattr(read, key) for key in ("name", "source", "note", "driver")}
    assert replace(made, **words) == read


FAULTS = {
    "no duration": ("duration_s = 4.0", "duration_s = 0.0", "driver.duration_s: found 0.0; use a number of at least 1e-15"),
    "speed whose inverse is no number": ("speed_rad_s = 2.0", "speed_rad_s = 1e-300", "driver.speed_rad_s: found 1e-300"),
    "start of what is driven": ('law = "free"', 'law = "constant"', "duration_s: unknown key"),
    "driver at two angles": ("{ crank = 30.0 }", "{ crank = 31.0 }", "start.angles_deg.crank: found 31, and start_deg of [driver] is 30; leave it out here"),
    "driver at two speeds": ("{ crank = 2.0 }", "{ crank = -2.0 }", "start.rates_rad_s.crank: found -2, and speed_rad_s of [driver] is 2; leave it out here"),
    "start of nothing": ("{ crank = 30.0 }", "{ krank = 30.0 }", "start.angles_deg: found krank; use one of crank, rod"),
    "start of no slider": ("{ C = 0.38 }", "{ D = 0.38 }", "start.displacements_m: found D; use one of C"),
    "start that is no number": ("{ C = 0.38 }", "{ C = nan }", "start.displacements_m.C: found nan"),
    "unknown key of a start": ("displacements_m", "displacement_m", "start.displacement_m: unknown key; did you mean displacements_m"),
    "spring in one link": ('["G", "S"]', '["A", "B"]', "springs.line.points: A and B are points of crank, which lie as far apart as ever; name points of two bodies"),
    "spring in the ground": ('["G", "S"]', '["G", "H"]', "springs.line.points: G and H are points of ground"),
    "spring from a point to itself": ('["G", "S"]', '["B", "B"]', "springs.line: found B twice; name two points"),
    "spring from nowhere": ('["G", "S"]', '["Z", "S"]', "springs.line.points: no body has a point Z"),
    "spring of nothing": ("rate_n_m = 50.0\nfree_m = 0.1", "free_m = 0.1", "springs.line: a spring needs a rate or a damping above 0: rate_n_m or damping_n_s_m"),
    "spring with a negative rate": ("rate_n_m = 50.0", "rate_n_m = -50.0", "springs.line.rate_n_m: found -50.0"),
    "spring of a negative length": ("free_m = 0.1", "free_m = -0.1", "springs.line: free_m is -0.1; a distance is 0 or more"),
    "spring of two kinds": ('pin = "B"', 'pin = "B"\nslider = "C"', "springs.turning: name where it is"),
    "turning spring in newtons": ("rate_n_m_rad = 0.3", "rate_n_m = 0.3", "springs.turning: rate_n_m does not go with a pin; give rate_n_m_rad and damping_n_m_s"),
    "spring between a body and itself": ("free_deg = -20.0", 'bodies = ["rod", "rod"]', "springs.turning.bodies: found rod twice; name two bodies"),
    "spring of a body elsewhere": ("free_deg = -20.0", 'bodies = ["rod", "ground"]', "springs.turning.bodies: ground is not at B"),
    "spring in no pin": ('pin = "B"', 'pin = "G"', "springs.turning.pin: fewer than two links, or links and the ground, meet at G"),
    "spring on no slider": ('slider = "C"\ndamping_n_s_m', 'slider = "B"\ndamping_n_s_m', "springs.along.slider: found B; use one of C"),
    "unknown key of a spring": ("damping_n_s_m = 0.2", "damping_n_s_m = 0.2\nrate_n = 1.0", "springs.along.rate_n: unknown key; did you mean rate_n_m"),
    "motor that does not reach the start": ("at_rad_s = [-40.0, 60.0]", "at_rad_s = [3.0, 60.0]", "loads.motor.at_rad_s: crank starts at 2 rad/s, and the table goes from 3 to 60"),
    "motor in the unit of another": ("at_rad_s", "at_m_s", 'loads.motor: over = "omega" takes at_rad_s; found at_m_s'),
    "motor of a block": ('link = "crank"\nlaw = "table"', 'block = "C"\nlaw = "table"', 'over = "omega" is the angular velocity of a link; name it by link'),
    "pulse without a period": ("period_s = 0.2", "period_s = 0.0", "loads.pulse.period_s: found 0.0"),
    "pulse over an angle": ("period_s = 0.2", 'over = "angle"\nperiod_s = 0.2', "loads.pulse.over: unknown key"),
    "steps that do not increase": ("[0.0, 0.25, 0.5]", "[0.0, 0.5, 0.5]", "loads.switch: found 0.5 after 0.5; the instants of steps have to increase"),
    "fewer steps than values": ("[0.0, 0.25, 0.5]", "[0.0, 0.5]", "loads.switch: found 2 places and 3 values"),
    "waves without a period": ("period_deg = 360.0\n", "", 'loads.waves: over = "angle" needs period_deg'),
    "friction of the reactions": ("torque_n_m = 0.004", "mu = 0.1\nradius_m = 0.01", "friction.A: friction by mu follows from the reactions, and free motion is not worked out with it; give torque_n_m"),
    "flywheel without a mass": ("flywheel_kg_m2", "mass_kg = 0.0, flywheel_kg_m2", "links.crank: flywheel_kg_m2 is 0.01 with mass_kg 0; give the link the mass of its flywheel too"),
    "negative flywheel": ("flywheel_kg_m2 = 0.01", "flywheel_kg_m2 = -0.01", "links.crank.flywheel_kg_m2: found -0.01"),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_what_can_not_be_is_named_with_its_place(fault: str) -> None:
    old, new, message = FAULTS[fault]
    assert old in FREE
    with pytest.raises(SceneError) as error:
        parse_scene(FREE.replace(old, new, 1), "file")
    assert message in str(error.value)


def test_a_driven_scene_has_no_start() -> None:
    driven = FREE.replace('law = "free"', 'law = "constant"').replace("duration_s = 4.0\n", "")
    with pytest.raises(SceneError, match='start: it goes with law = "free"; a driven mechanism'):
        parse_scene(driven, "file")


def test_what_has_no_mass_is_not_let_go() -> None:
    light = FREE.replace(", flywheel_kg_m2 = 0.01", "").replace("mass_kg = 0.5", "")
    light = light.replace("length_m = 0.1 }", "length_m = 0.1, mass_kg = 0.0 }")
    light = light.replace("length_m = 0.3 }", "length_m = 0.3, mass_kg = 0.0 }")
    with pytest.raises(SceneError, match="links: no body has a mass") as error:
        parse_scene(light, "file")
    assert len(error.value.faults) == 1


def test_a_start_may_say_again_what_the_driver_says() -> None:
    scene = parse_scene(FREE, "good")
    assert scene.start.angles_rad["crank"] == scene.driver.law.offset_rad
    again = replace(scene, start=replace(scene.start, angles_rad={"crank": math.radians(30.0)}))
    assert again == scene


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "fourbar-double-rocker", "slotted-lever"])
def test_it_begins_where_the_law_is_and_lasts_ten_of_its_turns(name: str) -> None:
    scene = load_scene(name)
    law, free = scene.driver.law, let_go(scene)
    assert free.is_free
    began, speed, _ = law.at(0.0)
    expected = Released(float(began), float(speed), 10.0 * law.period_s)
    assert vars(free.driver.law) == pytest.approx(vars(expected))
    for one in ("links", "branch", "driver.link"):
        assert attrgetter(one)(free) == attrgetter(one)(scene)


def test_what_is_let_go_already_stays_as_it_is_but_for_a_time_that_is_given() -> None:
    scene = load_scene("fourbar-swing")
    assert let_go(scene) is scene
    longer = let_go(scene, 12.0)
    assert longer.driver.law.period_s == 12.0
    assert longer.driver.law.offset_rad == math.fabs(scene.driver.law.offset_rad)
