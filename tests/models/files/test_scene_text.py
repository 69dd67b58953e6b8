"""The text of a scene reads as the scene, whatever is driven; what a scene holds is not changed."""

import copy
import math
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError
from models.files.assemble import scene_text
from models.files.reading import every_shipped, load_scene, parse_scene
from models.scene import Scene
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from tests.worlds.runs import driven_by

LAWS = [
    FromRest(0.3, 12.0, 0.25),
    Accelerating(-1.0, 3.0, 0.7),
    Oscillating(1.1, 0.4, 7.0, -0.2),
    ConstantSpeed(math.pi / 3, -1e-3),
]


@pytest.mark.parametrize("name", every_shipped())
def test_every_shipped_scene_has_a_name_and_a_source_and_reads_back_as_itself(name: str) -> None:
    scene = load_scene(name)
    assert scene.name == name
    assert len(scene.source) > 20
    text = scene_text(scene)
    again = parse_scene(text, name)
    assert again == scene
    assert ("[loads." in text, "[friction." in text) == (bool(scene.loads), bool(scene.friction))
    assert list(again.links) == list(scene.links)
    assert list(again.pins) == list(scene.pins)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_every_law_reads_back_but_for_the_last_digit_of_an_angle(law: Law) -> None:
    more = {"note": 'a "quoted" \\ note', "tolerance": {"angle": 1e-5}, "branch": {"C": -1}}
    changed = replace(driven_by(law), gravity_m_s2=(0.0, -9.81), **more)
    again = parse_scene(scene_text(changed), "changed")
    assert vars(again.driver.law) == pytest.approx(vars(law), rel=1e-15)
    assert replace(again, driver=changed.driver) == changed


def test_a_law_of_another_kind_is_refused() -> None:
    class Own(Law):
        period_s = peak_speed_rad_s = 1.0
        offset_rad = 0.0
        at = turned = lambda self, _: self

    with pytest.raises(CrankcheckError, match="law Own: a scene file can not state it"):
        scene_text(driven_by(Own()))


def test_a_flywheel_stands_by_itself_and_is_added_when_it_is_read() -> None:
    scene = load_scene("compressor")
    again = parse_scene(scene_text(scene, {"crank": 0.25}), "compressor")
    own = scene.links["crank"].inertia_kg_m2
    assert again.links["crank"].inertia_kg_m2 == pytest.approx(own + 0.25, rel=1e-15)
    assert again.links["rod"] == scene.links["rod"]


PISTON, COUPLER, TRIAD = (
    scene_text(load_scene(name))
    for name in ("slider-crank-by-piston", "fourbar-by-coupler", "triad-platform")
)
STROKE = 'law = "oscillating"\ncentre_m = 0.3\namplitude_m = 0.05\nfrequency_rad_s = 10.0'
WAY = "start_m = 0.3\nspeed_m_s = 0.1\ntravel_m = 0.05"
TURN = "start_deg = 30.0\nspeed_rad_s = 1.0"


def driven(text: str, driver: str) -> str:
    found, changes = re.subn(r"\[driver\]\n(.+\n)+", f"[driver]\n{driver}\n", text)
    assert changes == 1
    return found


def numbered(branch: str) -> str:
    return re.sub(r"\[branch\]\n.*\n", "", TRIAD) + f"\n[branch]\n{branch}\n"


@pytest.mark.parametrize(("text", "driver", "found"), [
    *((PISTON, f'slider = "C"\n{driver}', ("C", "block C", "m")) for driver in (
        STROKE,
        WAY,
        f'law = "from-rest"\nrise_s = 0.1\n{WAY}',
        f'law = "accelerating"\nacceleration_m_s2 = 0.1\n{WAY}',
    )),
    *((COUPLER, f'pin = "B"\nlinks = {links}\n{TURN}', (None, links[1], "rad"))
      for links in (["crank", "coupler"], ["coupler", "crank"])),
])  # fmt: skip
def test_a_driven_slider_or_pin_is_written_as_it_is_read(
    text: str, driver: str, found: tuple[str | None, str, str]
) -> None:
    scene = parse_scene(driven(text, driver), "test")
    assert (scene.driver.slider, scene.driver.link, scene.driver.unit) == found
    assert scene.driver.is_inner == (text == COUPLER)
    assert parse_scene(scene_text(scene), "test") == scene


REFUSED = [
    *((driven(PISTON, driver), said) for driver, said in (
        (f'slider = "C"\npin = "B"\n{STROKE}', r"driver.pin: unknown key; known: slider, law"),
        (f'slider = "X"\n{WAY}', "found X; use one of C"),
        ('slider = "C"\nstart_m = 0.3\nspeed_m_s = 0.1', "driver.travel_m: missing"),
        (f'slider = "C"\n{WAY.replace("0.1", "0.0")}', "its speed is 0"),
        (f'slider = "C"\nlaw = "free"\n{WAY}', "found 'free'; use one of constant, oscillating"),
        (f'pin = "A"\nlinks = ["crank", "rod"]\n{TURN}', "pin A joins ground, crank, not rod"),
        (f'pin = "A"\nlinks = ["crank", "ground"]\n{TURN}', "name the ground first"),
        (f'pin = "Q"\n{TURN}', "no body has such a point"),
        (f'pin = "B"\nlinks = ["rod", "rod"]\n{TURN}', "rod twice"),
        (f'pin = "C"\n{TURN}', "slider = 'C', or a pin of two"),
        (
            f'slider = "C"\n{STROKE.replace("0.05", "0.12")}',
            r"the loop cannot close at B.* can stand at -0.4 to -0.2 m and 0.2 to 0.4 m"),
    )),
    (
        driven(COUPLER, f'pin = "B"\nlinks = ["crank", "coupler"]\nlaw = "free"\n{TURN}'),
        "free motion has no drive: name a link at the ground"),
    *((numbered(branch), said) for branch, said in (
        ("plate = 7", "numbered from 1 to at most 6"),
        ("plate = 5", "has 2 assemblies; give a number from 1 to 2$"),
        ("leg1 = 1", "separates no assemblies; it has plate"),
    )),
    (
        TRIAD.replace("E = [0.25", "E = [0.01"),
        "the group about plate ends in a limit position at 88.2668 deg"),
    (
        TRIAD.replace("E = [0.25", "E = [9.0"),
        "the group about plate has no assembly; start elsewhere"),
]  # fmt: skip


def moved(scene: Scene) -> None:
    analyse(scene)
    solve(scene, np.linspace(0.0, scene.driver.law.period_s, 49))


@pytest.mark.parametrize(("text", "said"), REFUSED, ids=[said for _, said in REFUSED])
def test_what_can_not_drive_or_stand_so_is_refused_with_what_would_do(text: str, said: str) -> None:
    with pytest.raises(CrankcheckError) as refused:
        moved(parse_scene(text, "test"))
    assert re.search(said, " ".join(str(refused.value).split()))


@pytest.mark.parametrize(("change", "arguments"), [
    ("__setitem__", ("E", (0.0, 0.0))), ("__delitem__", ("A",)), ("__ior__", ({"E": (0.0, 0.0)},)),
    ("update", ({"E": (0.0, 0.0)},)), ("setdefault", ("E", (0.0, 0.0))), ("pop", ("A",)),
    ("popitem", ()), ("clear", ()),
])  # fmt: skip
def test_a_scene_is_not_changed(change: str, arguments: tuple[object, ...]) -> None:
    scene = load_scene("fourbar-lecture-1")
    for each in (scene, copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert each == scene
        rocker = each.links["rocker"].points
        for mapping in (each.ground, each.links, each.branch, rocker, each.pins):
            with pytest.raises(TypeError, match="make another one"):
                getattr(mapping, change)(*arguments)


def test_it_is_made_anew_and_what_it_was_made_of_is_its_own() -> None:
    given = {"A": (0.0, 0.0), "D": (0.2, 0.0)}
    scene = replace(load_scene("fourbar-lecture-1"), ground=given)
    given["D"] = (0.3, 0.0)
    assert scene.ground == {"A": (0.0, 0.0), "D": (0.2, 0.0)}
    moved = replace(scene, ground={**scene.ground, "D": (0.25, 0.0)})
    assert moved.ground["D"] == (0.25, 0.0)
