"""The text of a scene reads as the scene."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from models.errors import CrankcheckError
from models.files import every_shipped, load_scene, parse_scene
from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from models.scene_text import scene_text

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
    scene = load_scene("fourbar-lecture-1")
    changed = replace(
        scene,
        driver=replace(scene.driver, law=law),
        note='a "quoted" \\ note',
        gravity_m_s2=(0.0, -9.81),
        tolerance={"angle": 1e-5},
        branch={"C": -1},
    )
    again = parse_scene(scene_text(changed), "changed")
    assert vars(again.driver.law) == pytest.approx(vars(law), rel=1e-15)
    assert replace(again, driver=changed.driver) == changed


def test_a_law_of_another_kind_is_refused() -> None:
    class Own(Law):
        period_s = peak_speed_rad_s = 1.0
        offset_rad = 0.0
        at = turned = lambda self, _: self

    scene = load_scene("fourbar-lecture-1")
    other = replace(scene, driver=replace(scene.driver, law=Own()))
    with pytest.raises(CrankcheckError, match="law Own: a scene file has no words for it"):
        scene_text(other)


def test_a_flywheel_stands_by_itself_and_is_added_when_it_is_read() -> None:
    scene = load_scene("compressor")
    again = parse_scene(scene_text(scene, {"crank": 0.25}), "compressor")
    own = scene.links["crank"].inertia_kg_m2
    assert again.links["crank"].inertia_kg_m2 == pytest.approx(own + 0.25, rel=1e-15)
    assert again.links["rod"] == scene.links["rod"]
