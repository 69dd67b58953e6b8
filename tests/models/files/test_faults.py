"""Faults of scene files: each is named with its key, what was found, and a cure."""

import pytest

from models.errors import SceneError
from models.files.reading import parse_scene
from tests.models.files.test_files import GOOD
from tests.models.scene.test_elastic import GOOD as ELASTIC
from tests.models.scene.test_elastic import SECTION
from tests.models.scene.test_free_scenes import FREE
from tests.models.scene.test_gears import PLANETARY
from tests.models.scene.test_loads import PRESS, RUBBING

FAULTS: dict[str, tuple[str, dict[str, tuple[str, str, str]]]] = {
    "files": (GOOD, {
        "unknown table": ("[driver]", "[drivers]\nx = 1\n[driver]", "drivers: unknown key; did you "
                                                                    "mean driver"),
        "zero length": ("length_m = 0.25", "length_m = 0.0", "links.coupler.length_m: found 0.0; "
                                                             "use a number of at least 1e-15"),
        "coincident points": ('rocker = { bar = ["D", "C"], length_m = 0.2 '
                              '}', "rocker = { points "
                                                                               "= { D = [0.1, "
                                                                               "0.0], C = [0.1, "
                                                                               "0.0] } "
                                                                               "}", "links.rocker: "
                                                                                                                                           "length "
                                                                                                                                           "DC "
                                                                                                                                           "is "
                                                                                                                                           "0"),
        "infinity": ("D = [0.3, 0.0]", "D = [inf, 0.0]", "ground.points.D.1: found inf"),
        "two drivers as tables": ("[driver]", '[[driver]]\nlink = "rocker"\nspeed_rad_s = '
                                              '1.0\n[[driver]]', "driver: found a list of 2"),
        "two drivers as a list": ('link = "crank"', 'link = ["crank", '
                                                    '"rocker"]', "a scene has one "
                                                                                  "driver, one "
                                                                                  "link"),
        "driver at rest": ("speed_rad_s = 10.0", "speed_rad_s = 0.0", "driver: its speed is 0"),
        "unknown law": ("[driver]", '[driver]\nlaw = "jerky"', "driver.law: found 'jerky'; use one "
                                                               "of constant"),
        "driver without a ground pin": ('link = "crank"', 'link = "coupler"', "driver.link: "
                                                                              "coupler has no "
                                                                              "ground pin"),
        "branch other than 1": ("[driver]", "[branch]\nC = 2\n[driver]", "branch.C: found 2"),
        "slider on nothing": ("[driver]", '[sliders.C]\non = '
                                          '"table"\n[driver]', "sliders.C.on: found table"),
        "slider without its point": ("[driver]", '[sliders.Q]\non = '
                                                 '"ground"\n[driver]', "sliders.Q.point: "
                                                                                         "no body "
                                                                                         "has a "
                                                                                         "point Q"),
        "slider on itself": ("[driver]", '[sliders.C]\nlink = "coupler"\non = '
                                         '"coupler"\n[driver]', "slides on itself"),
        "slider named like a link": ("[driver]", '[sliders.crank]\npoint = "C"\non = '
                                                 '"ground"\n[driver]', "a link has that name too"),
        "negative mass": ("length_m = 0.25", "length_m = 0.25, mass_kg = "
                                             "-1.0", "links.coupler.mass_kg: "
                                                                                "found -1.0"),
        "inertia without mass": ("length_m = 0.25", "length_m = 0.25, mass_kg = 0.0, inertia_kg_m2 "
                                                    "= 1.0", "links.coupler: inertia_kg_m2 is 1.0 "
                                                                                                           "with "
                                                                                                           "mass_kg "
                                                                                                           "0"),
        "one point and no mass": ('rocker = { bar = ["D", "C"], length_m = 0.2 '
                                  '}', "rocker = { points = { D = [0.0, 0.0] } }", "links.rocker: "
                                                                                                                               "one "
                                                                                                                               "point "
                                                                                                                               "has "
                                                                                                                               "no "
                                                                                                                               "length"),
        "bar without length": (", length_m = 0.25", "", "bar and length_m go together"),
        "bar to itself": ('bar = ["B", "C"]', 'bar = ["B", "B"]', "joins point B to itself"),
        "name with a path": ("crank =", '"../crank" =', "a name is a letter"),
        "text that reads as a number": ("length_m = 0.25", 'length_m = "0.25"', "links.coupler.length_m: "
                                                                                "found '0.25'"),
        "truth for a number": ("length_m = 0.25", "length_m = true", "links.coupler.length_m: "
                                                                     "found True"),
        "length beyond numbers": ("length_m = 0.25", "length_m = 1e300", "links.coupler.length_m: "
                                                                         "found 1e+300"),
        "control character": ('source = "a test"', 'source = "a \\u001b[31m '
                                                   'test"', "text without "
                                                                                    "control "
                                                                                    "characters"),
        "link named as what does not move": ("crank =", "world =", "links.world: that name means "
                                                                   "the ground"),
        "letter that XML lacks": ('source = "a test"', 'source = "a \\uffff"', "text without "
                                                                               "control "
                                                                               "characters"),
        "speed whose inverse is no number": ("speed_rad_s = 10.0", "speed_rad_s = -1e-300", "driver.speed_rad_s: "
                                                                                            "found "
                                                                                            "-1e-300; "
                                                                                            "use "
                                                                                            "1e-15 "
                                                                                            "or "
                                                                                            "more, "
                                                                                            "or "
                                                                                            "-1e-15 "
                                                                                            "or "
                                                                                            "less"),
        "scene beyond digits": ("A = [0.0, 0.0]", "A = [0.0, 1e12]", "ground.points.A: 1e+12 m "
                                                                     "from the origin, 4e+12 times "
                                                                     "the longest link (0.25 m); "
                                                                     "at most 1e+12"),
        "points next to each other": ("D = [0.3, 0.0]", "D = [1e-300, 0.0]", "ground: length AD is "
                                                                             "1e-300; set the "
                                                                             "points apart"),
        "number of too many digits": ("length_m = 0.25", "length_m = " + "9" * 5000, "not valid "
                                                                                     "TOML: line "
                                                                                     "8: a number "
                                                                                     "of more "
                                                                                     "digits than "
                                                                                     "can be read"),
        "lists too deep": ("length_m = 0.25", "length_m = " + "[" * 5000, "not valid TOML: lists "
                                                                          "or tables nested too "
                                                                          "deep"),
        "no source": ('source = "a test"', "", "source: missing"),
    }),
    "free motion": (FREE, {
        "no duration": ("duration_s = 4.0", "duration_s = 0.0", "driver.duration_s: found 0.0; use "
                                                                "a number of at least 1e-15"),
        "start of what is driven": ('law = "free"', 'law = "constant"', "duration_s: unknown key"),
        "driver at two angles": ("{ crank = 30.0 }", "{ crank = 31.0 }", "start.angles_deg.crank: "
                                                                         "found 31, and start_deg "
                                                                         "of [driver] is 30; leave "
                                                                         "it out here"),
        "driver at two speeds": ("{ crank = 2.0 }", "{ crank = -2.0 }", "start.rates_rad_s.crank: "
                                                                        "found -2, and speed_rad_s "
                                                                        "of [driver] is 2; leave "
                                                                        "it out here"),
        "start of nothing": ("{ crank = 30.0 }", "{ krank = 30.0 }", "start.angles_deg: found "
                                                                     "krank; use one of crank, "
                                                                     "rod"),
        "spring in one link": ('["G", "S"]', '["A", "B"]', "springs.line.points: A and B are "
                                                           "points of crank, at a constant "
                                                           "distance; name points of two bodies"),
        "spring from nowhere": ('["G", "S"]', '["Z", "S"]', "springs.line.points: no body has a "
                                                            "point Z"),
        "spring of nothing": ("rate_n_m = 50.0, free_m = 0.1", "free_m = 0.1", "springs.line: a "
                                                                               "spring needs a "
                                                                               "rate or a damping "
                                                                               "above 0: rate_n_m "
                                                                               "or damping_n_s_m"),
        "spring of a negative length": ("free_m = 0.1", "free_m = -0.1", "springs.line: free_m is "
                                                                         "-0.1; a distance is 0 or "
                                                                         "more"),
        "spring of two kinds": ('pin = "B"', 'pin = "B", slider = "C"', "springs.turning: give its "
                                                                        "place"),
        "turning spring in newtons": ("rate_n_m_rad = 0.3", "rate_n_m = 0.3", "springs.turning: rate_n_m does not belong to a pin; give rate_n_m_rad and "
            "damping_n_m_s"),
        "spring between a body and itself": ("free_deg = -20.0", 'bodies = ["rod", "rod"]', "springs.turning.bodies: "
                                                                                            "found "
                                                                                            "rod "
                                                                                            "twice; "
                                                                                            "name "
                                                                                            "two "
                                                                                            "bodies"),
        "spring of a body elsewhere": ("free_deg = -20.0", 'bodies = ["rod", '
                                                           '"ground"]', "springs.turning.bodies: "
                                                                                         "ground "
                                                                                         "is not "
                                                                                         "at B"),
        "spring in no pin": ('pin = "B"', 'pin = "G"', "springs.turning.pin: fewer than two links, "
                                                       "or links and the ground, meet at G"),
        "spring on no slider": ('slider = "C", damping_n_s_m', 'slider = "B", '
                                                               'damping_n_s_m', "springs.along.slider: "
                                                                                              "found "
                                                                                              "B; "
                                                                                              "use "
                                                                                              "one "
                                                                                              "of "
                                                                                              "C"),
        "motor that does not reach the start": ("at_rad_s = [-40.0, 60.0]", "at_rad_s = [3.0, 60.0]", "loads.motor.at_rad_s: "
                                                                                                      "crank "
                                                                                                      "starts "
                                                                                                      "at "
                                                                                                      "2 "
                                                                                                      "rad/s, "
                                                                                                      "and "
                                                                                                      "the "
                                                                                                      "table "
                                                                                                      "goes "
                                                                                                      "from "
                                                                                                      "3 "
                                                                                                      "to "
                                                                                                      "60"),
        "motor in the unit of another": ("at_rad_s", "at_m_s", 'loads.motor: over = "omega" takes '
                                                               'at_rad_s; found at_m_s'),
        "steps that do not increase": ("[0.0, 0.25, 0.5]", "[0.0, 0.5, 0.5]", "loads.switch: found "
                                                                              "0.5 after 0.5; the "
                                                                              "instants of steps "
                                                                              "have to increase"),
        "fewer steps than values": ("[0.0, 0.25, 0.5]", "[0.0, 0.5]", "loads.switch: found 2 "
                                                                      "places and 3 values"),
        "friction of the reactions": ("torque_n_m = 0.004", "mu = 0.1, radius_m = 0.01", "friction.A: friction by mu follows from the reactions, and free motion is not "
            "computed with it; give torque_n_m"),
        "flywheel without a mass": ("flywheel_kg_m2", "mass_kg = 0.0, "
                                                      "flywheel_kg_m2", "links.crank: "
                                                                                       "flywheel_kg_m2 "
                                                                                       "is 0.01 "
                                                                                       "with "
                                                                                       "mass_kg 0; "
                                                                                       "give the "
                                                                                       "link the "
                                                                                       "mass of "
                                                                                       "its "
                                                                                       "flywheel "
                                                                                       "too"),
    }),
    "loads": (PRESS, {
        "no body": ('block = "C"\n', "", "loads.work: name the loaded body: link, or block"),
        "other link": ('link = "rod"', 'link = "rad"', "loads.gas.link: found rad; use one of "
                                                       "crank"),
        "other point": ('point = "B"', 'point = "D"', "loads.hum.point: rod has no point D; it has "
                                                      "B"),
        "no slider": ('slider = "C"\nstroke', "stroke", "loads.work: over displacement or speed, "
                                                        "or"),
        "idle slider": ('stroke = "forward"', "", "loads.work: slider needs stroke = "),
        "no point": ('point = "B"\n', "", "loads.hum: a force on link rod needs the point"),
        "point of a block": ("force_n = 500.0", 'force_n = 5.0\npoint = "C"', "leave point out"),
        "no magnitude": ("force_n = 500.0", "", "loads.work: give force_n or torque_n_m, one"),
        "torque with a point": ("torque_n_m = [0.0", 'point = "B"\ntorque_n_m = '
                                                     '[0.0', "point belongs to a force"),
        "other law": ('law = "sine"', 'law = "saw"', "loads.hum.law: found 'saw'; use one of "
                                                     "constant"),
        "other unit": ("at_m", "at_s", 'loads.gas: over = "displacement" takes at_m; found at_s'),
        "no places": ("at_m = [0.15, 0.2, 0.45]", "", 'loads.gas: over = "displacement" needs '
                                                      'at_m'),
        "period of no angle": ("at_m = [0.15", "period_deg = 90.0\nat_m = "
                                               "[0.15", 'period_deg '
                                                                                  'needs over = '
                                                                                  '"angle"'),
        "no interpolation": ('interpolation = "pchip"', "", "loads.gas.interpolation: missing"),
        "one row": ("[0.15, 0.2, 0.45]\nforce_n = [900.0, 300.0, 0.0]", "[0.15]\nforce_n = [900.0]", "loads.gas: "
                                                                                                     "found "
                                                                                                     "1 "
                                                                                                     "rows; "
                                                                                                     "a "
                                                                                                     "table "
                                                                                                     "needs "
                                                                                                     "two "
                                                                                                     "or "
                                                                                                     "more"),
        "a rise beyond numbers": ("0.15, 0.2, 0.45]", "0.0, 5e-324, 0.45]", "in rows 4.94e-324 "
                                                                            "apart, a rise beyond "
                                                                            "all"),
        "the ground": ('link = "rod"\npoint = "C"', 'link = "ground"\npoint = '
                                                    '"A"', "found ground;"),
        "a row too many": ("[0.15, 0.2, 0.45]", f"[{', '.join(f'{k}.0' for k in range(10_001))}]", "at most 10000"),
        "an odd name": ("[loads.hum]", '[loads."hum \\u202e"]', "loads.hum \\u202e: found 'hum "),
        "longer than the period": ("720.0", "180.0", "loads.valve: found rows over 4.71239, more "
                                                     "than"),
        "a period that does not close": ("period_deg = 720.0", "period_deg = 270.0", "found 0 in "
                                                                                     "the first "
                                                                                     "row and -1 "
                                                                                     "in the last"),
        "a slider without a block": ("mass_kg = 0.5", 'link = "rod"', "loads.work.block: found C; "
                                                                      "the scene has none"),
        "a list": ('[loads.hum]\nlink = "rod"', '[[loads.hum]]\nlink = "rod"', "loads.hum: found"),
    }),
    "friction": (RUBBING, {
        "negative": ("mu = 0.1", "mu = -0.1", "friction.B.mu: found -0.1; use a number of at least "
                                              "0"),
        "no radius": ("radius_m = 0.01", "", "friction.B.radius_m: missing; mu of a pin acts at "
                                             "its"),
        "radius alone": ("mu = 0.1\n", "", "friction.B: radius_m is that of a pin with mu, which "
                                           "is"),
        "two kinds": ("mu = 0.1", "mu = 0.1\ntorque_n_m = 1.0", "friction.B: found mu and "
                                                                "torque_n_m"),
        "no kind": ("torque_n_m = 0.2", "", "friction.A: found none of them; give one of mu"),
        "no joint": ("friction.B", "friction.Q", "friction.Q: no joint of two bodies has that "
                                                 "name; use one of A, B, C, piston"),
        "torque in a slider": ("force_n = 3.0", "torque_n_m = 3.0", "friction.piston.torque_n_m: "
                                                                    "belongs to a pin"),
        "a pin of three": ("[sliders", 'door = { bar = ["B", "E"], length_m = 0.3 '
                                       '}\n[sliders', "friction.B: 3 bodies meet at B"),
    }),
    "gears": (PLANETARY, {
        "unknown body": ('["sun", "planet"]', '["sun", "plant"]', "gears.inner.bodies: found "
                                                                  "plant; use one of ground, sun, "
                                                                  "arm, planet"),
        "unknown carrier": ('carrier = "arm"', 'carrier = "arms"', "gears.inner.carrier: found "
                                                                   "arms; use one of ground, sun, "
                                                                   "arm, planet"),
        "one body twice": ('["sun", "planet"]', '["sun", "sun"]', "gears.inner.bodies: found sun "
                                                                  "twice; name two bodies"),
        "carrier that is a gear": ('carrier = "arm"', 'carrier = "sun"', "gears.inner.carrier: sun "
                                                                         "is one of the two gears; "
                                                                         "name the body that "
                                                                         "carries both centres"),
        "gears on the ground": ('carrier = "arm"\ninternal', "internal", "gears.outer.carrier: "
                                                                         "ground is one of the two "
                                                                         "gears"),
        "no teeth": ("teeth = [20, 40]", "", "gears.inner.teeth: missing"),
        "part of a tooth": ("[20, 40]", "[20, 40.5]", "gears.inner.teeth.2: found 40.5; input "
                                                      "should be a valid integer"),
        "no tooth": ("[20, 40]", "[0, 40]", "gears.inner.teeth.1: found 0; input should be greater "
                                            "than or equal to 1"),
        "gear that is not pinned": ("planet]\npoints = { P", "planet]\npoints = { R", "gears.inner: "
                                                                                      "planet "
                                                                                      "shares no "
                                                                                      "point with "
                                                                                      "its carrier "
                                                                                      "arm; it "
                                                                                      "turns on "
                                                                                      "its carrier "
                                                                                      "about one "
                                                                                      "point"),
        "gear fixed to its carrier": ("Q = [0.04, 0.0]", "O = [-0.06, 0.0]", "gears.inner: planet "
                                                                             "shares P and O with "
                                                                             "its carrier arm"),
        "small ring": ("[40, 100]", "[40, 40]", "gears.outer: teeth are 40 and 40; the second of "
                                                "an internal pair is the ring, which has more "
                                                "teeth"),
        "module that does not fit": ("module_m = 0.002", "module_m = 0.0025", "gears.inner.module_m: "
                                                                              "0.0025 with 20 and "
                                                                              "40 teeth needs a "
                                                                              "centre distance of "
                                                                              "0.075 m, found 0.06 "
                                                                              "m; use 0.002,"),
        "gains power": ("efficiency = 0.98", "efficiency = 1.02", "gears.inner.efficiency: found "
                                                                  "1.02; use a number of at most "
                                                                  "1"),
        "steep": ("= 25.0", "= 60.0", "gears.outer.pressure_angle_deg: found 60.0; use a number of "
                                      "at most 45"),
        "unknown key": ("module_m", "module_mm", "gears.inner.module_mm: unknown key; did you mean "
                                                 "module_m"),
        "elastic carrier": ("[driver]", "[elastic.arm]\nflexural_n_m2 = "
                                        "1.0\n[driver]", "gears.inner: "
                                                                                        "arm is "
                                                                                        "elastic, "
                                                                                        "and gears "
                                                                                        "and "
                                                                                        "carriers "
                                                                                        "are rigid "
                                                                                        "here"),
    }),
}  # fmt: skip
"""Texts of scenes without a fault, by kind; and by name of a fault what is replaced, what by, and the
message."""


@pytest.mark.parametrize(
    ("kind", "fault"), [(kind, fault) for kind, (_, faults) in FAULTS.items() for fault in faults]
)
def test_fault_is_named_with_its_place(kind: str, fault: str) -> None:
    text, (old, new, message) = FAULTS[kind][0], FAULTS[kind][1][fault]
    assert old in text
    with pytest.raises(SceneError) as error:
        parse_scene(text.replace(old, new, 1), "file.toml")
    assert message in str(error.value)
    assert str(error.value).startswith("file.toml: ")
    assert kind != "loads" or len(error.value.faults) == 1


COUPLER = '{ bar = ["B", "C"], length_m = 0.75'
ROCKER = 'rocker = { bar = ["D", "C"], length_m = 0.75 }\n'
PLATE, ARM = ", points = { E = [0.3, 0.1] }", 'arm = { bar = ["E", "F"], length_m = 0.2 }\n'
SLIDER = """
[sliders.C]
link = "coupler"
on = "ground"
"""
HEAVY = SECTION + 'density_kg_m3 = 2700.0\n[start]\nshape = "periodic"\n'
RAMP = ELASTIC.replace("speed_rad_s = 7.37", 'law = "from-rest"\nspeed_rad_s = 7.37\nrise_s = 0.3')


@pytest.mark.parametrize(("text", "message"), [
    *((ELASTIC + table, message) for table, message in (
        ("[elastic.coupler]\n", "its stiffness is missing: give flexural_n_m2"),
        ("[elastic.coupler]\nflexural_n_m2 = 1.0\nstretches = true\n", "give axial_n"),
        ("[elastic.coupler]\nflexural_n_m2 = 1.0\nbends = false\n", "neither bends nor stretches"),
        ("[elastic.coupler]\nmodulus_pa = 7e10\nwidth_m = 0.03\n", "width_m goes with height_m"),
        (SECTION + "area_m2 = 1e-4\n", "two sections"),
        (SECTION + "flexural_n_m2 = 1.0\n", "gives flexural_n_m2 and axial_n too"),
        ("[elastic.coupler]\nflexural_n_m2 = 1.0\ndensity_kg_m3 = 1.0\n", "goes with a section"),
        ("[elastic.coupler]\nflexural_n_m2 = -1.0\n", "flexural_n_m2"),
        (SECTION + "density_kg_m3 = 2700.0\ndamping_s = 1e9\n", "from 0.0258 on its first mode no "
                                                                "longer swings"),
        ("[elastic.rod]\nflexural_n_m2 = 1.0\n", "no link of that name; use one of"),
        ("[elastic.crank]\nflexural_n_m2 = 1.0\n", "the driver has to be a rigid link"),
        (SECTION.replace("0.003", "0.08"), "its length is 9.38 heights of its section"),
        (SECTION + '[friction.C]\ntorque_n_m = 0.1\n', "can not be combined"),
        (SECTION + '[loads.push]\nlink = "coupler"\ntorque_n_m = 0.1\n', "bends it by its place"),
        ('[start]\nshape = "straight"\n', "no link of the scene is elastic"),
    )),
    (ELASTIC.replace(COUPLER, COUPLER + ", mass_kg = 1.0") + HEAVY, "its section and density_kg_m3 "
                                                                    "give 0.18225"),
    (ELASTIC.replace(COUPLER, COUPLER + (", points = { E = [0.9, 0.0] "
                                        "}")) + HEAVY, "uniform slender "
                                                                                  "beam from B to "
                                                                                  "C"),
    (ELASTIC.replace(COUPLER, COUPLER + ", inertia_kg_m2 = 1.0") + HEAVY, "uniform slender beam "
                                                                          "from B to C"),
    (RAMP + HEAVY, "driver of constant speed"),
    (ELASTIC.replace(COUPLER, COUPLER + ", mass_kg = 0.0") + SECTION, "give it mass_kg, or "
                                                                      "density_kg_m3"),
    (ELASTIC.replace(ROCKER, ROCKER + ARM).replace(COUPLER, COUPLER + PLATE) + SECTION, "lies "
                                                                                        "between "
                                                                                        "two pins; "
                                                                                        "it has 3: "
                                                                                        "B, C, E"),
    (ELASTIC.replace(ROCKER, "") + SLIDER + SECTION, "holds it by a moment"),
])  # fmt: skip
def test_fault_of_an_elastic_link_is_named(text: str, message: str) -> None:
    with pytest.raises(SceneError) as error:
        parse_scene(text, "test")
    assert message in str(error.value)
