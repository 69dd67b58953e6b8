"""Planets that fit, against every tooth of both central gears tried in turn."""

import cmath
import math

import pytest

from analytic.gears.assembly import PlanetStage, check_planets, planet_stages
from models.errors import CrankcheckError
from models.files.reading import parse_scene
from models.scene.pairs import Gear
from tests.models.scene.test_gears import PLANETARY


def stage(sun: int, p: int, q: int, other: int, *, internal: bool = True) -> PlanetStage:
    first = Gear("s", ("sun", "planet"), (sun, p), "arm")
    second = Gear("r", ("planet", "end"), (q, other), "arm", internal)
    arm = {"O": (0.0, 0.0), "P": (0.06, 0.0)}
    points = {
        "arm": arm,
        "sun": {"O": (0.0, 0.0)},
        "end": {"O": (0.0, 0.0)},
        "planet": {"P": (0.0, 0.0)},
    }
    (found,) = planet_stages([first, second], points)
    return found


@pytest.mark.parametrize("teeth", [(20, 40, 40, 100, True), (21, 19, 19, 59, True),
                                   (15, 24, 18, 60, True), (100, 99, 100, 99, False),
                                   (30, 20, 16, 34, False)])  # fmt: skip
def test_planets_fit_where_some_pair_of_teeth_does(teeth: tuple[int, int, int, int, bool]) -> None:
    """At 2 pi/n the planet is turned until it meshes with the sun, tooth by tooth: does one of
    these turns mesh with the other central gear too?"""
    sun, p, q, other, internal = teeth
    sign = -1 if internal else 1
    for count in range(1, 13):
        fits = False
        for j in range(p):
            turn = (sun / count + j) / p  # p turn = sun/n + j, in turns
            phase = q * turn - sign * other / count
            fits |= abs(phase - round(phase)) < 1e-9
        assert (stage(sun, p, q, other, internal=internal).period % count == 0) == fits


def scene_of(planets: dict[str, float], ring: int = 100) -> tuple[PlanetStage, ...]:
    text = PLANETARY
    head, gears = text.split("[gears.inner]")
    head = head.replace("P = [0.06, 0.0]", ", ".join(
        f"{n.upper()} = [{0.06 * math.cos(math.radians(a))}, {0.06 * math.sin(math.radians(a))}]"
        for n, a in planets.items()))  # fmt: skip
    head = head.replace("[links.planet]\npoints = { P = [0.0, 0.0], Q = [0.04, 0.0] }\n", "")
    for n in planets:
        head += f"[links.{n}]\npoints = {{ {n.upper()} = [0.0, 0.0], Q{n} = [0.04, 0.0] }}\n"
    tables = ""
    for n in planets:
        pair = gears.split("[driver]")[0].replace('"planet"', f'"{n}"').replace("100]", f"{ring}]")
        tables += f"[gears.{n}1]" + pair.replace("[gears.outer]", f"[gears.{n}2]")
    scene = parse_scene(head + tables + "[driver]" + text.split("[driver]")[1], "made")
    return tuple(planet_stages(scene.gears.values(), scene.points_of))


def test_planets_of_a_scene_are_found_and_placed() -> None:
    stages = scene_of({"p": 0.0, "q": 120.0, "r": 240.0})
    assert [one.planet for one in stages] == ["p", "q", "r"]
    assert {one.kind for one in stages} == {stages[0].kind}
    assert stages[0].period == 120
    check_planets(stages)
    check_planets(scene_of({"p": 0.0, "q": 90.0, "r": 213.0}))
    with pytest.raises(CrankcheckError) as error:
        check_planets(scene_of({"p": 0.0, "q": 91.0}))
    assert str(error.value) == (
        "q can not be assembled where it is: 91 degrees from p, equal planets fit each 3 degrees "
        "((20 + 100) = 120 places); evenly spread, numbers that work: 1, 2, 3, 4"
    )


def test_numbers_of_planets_that_do_not_fit_or_overlap_are_refused() -> None:
    (one,) = scene_of({"p": 0.0})
    one.check(3)
    assert one.counts == [1, 2, 3, 4]
    for count, message in (
        (7, "7 equal planets like p can not be assembled: (20 + 100)/7 = 17.1429 "
         "has to be a whole number; numbers that work: 1, 2, 3, 4"),
        (5, "5 equal planets like p overlap: 4 have room beside each other; numbers that work: "
         "1, 2, 3, 4"),
        (0, "0 equal planets like p can not be assembled"),
    ):  # fmt: skip
        with pytest.raises(CrankcheckError) as error:
            one.check(count)
        assert message in str(error.value)


@pytest.mark.parametrize(("sun", "planet"), [(20, 40), (40, 20), (60, 20), (17, 90), (30, 28)])
def test_planets_have_room_where_their_circles_do_not_touch(sun: int, planet: int) -> None:
    one = stage(sun, planet, planet, sun + 2 * planet)
    pitch = 0.12 / (sun + planet)  # the module; centres are 0.06 m apart
    tip = 0.5 * pitch * (planet + 2)
    for count in range(2, 40):
        apart = abs(0.06 - 0.06 * cmath.exp(1j * math.tau / count))
        assert (apart > 2.0 * tip) == (count <= one.most)
