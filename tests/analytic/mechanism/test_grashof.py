"""Names of chains by Grashof, held to what their drivers can do."""

from __future__ import annotations

import pytest

from analytic.mechanism.fourbar import FourBar
from analytic.mechanism.grashof import four_bar_type, inverted_slider_crank_type, slider_crank_type
from analytic.mechanism.grashof_of_scene import grashof_of
from models.files import load_scene


@pytest.mark.parametrize(
    ("lengths", "wanted"),
    [
        ((0.1, 0.25, 0.2, 0.3), "Grashof crank-rocker"),
        ((0.2, 0.25, 0.1, 0.3), "Grashof rocker-crank"),
        ((0.25, 0.2, 0.3, 0.1), "Grashof double-crank (drag link)"),
        ((0.25, 0.1, 0.2, 0.3), "Grashof double-rocker"),
        ((0.3, 0.22, 0.25, 0.5), "non-Grashof triple-rocker (longest: ground)"),
        ((0.1, 0.3, 0.1, 0.3), "change point, parallelogram or antiparallelogram"),
        ((0.2, 0.2, 0.3, 0.3), "change point, kite (deltoid)"),
        ((0.2, 0.2, 0.2, 0.2), "change point, rhombus"),
        ((0.1, 0.2, 0.3, 0.4), "change point, between crank-rocker and triple-rocker"),
    ],
)
def test_a_four_bar_has_its_name(lengths: tuple[float, ...], wanted: str) -> None:
    found = four_bar_type(FourBar(*lengths))
    assert found.name == wanted
    assert found.is_grashof != wanted.startswith("non-Grashof")


def test_an_offset_counts() -> None:
    assert slider_crank_type(0.1, 0.3, 0.1).driver_turns
    assert not slider_crank_type(0.1, 0.3, 0.21).is_grashof
    assert slider_crank_type(0.1, 0.3, 0.2).name == "change point, offset slider-crank"
    assert slider_crank_type(0.2, 0.2, 0.0).name == "change point, isosceles central slider-crank"
    assert inverted_slider_crank_type(0.3, 0.1, 0.05).follower_turns
    assert not inverted_slider_crank_type(0.1, 0.3, 0.05).follower_turns
    assert not inverted_slider_crank_type(0.1, 0.3, 0.25).driver_turns
    with pytest.raises(ValueError, match="reach the line together"):
        slider_crank_type(0.1, 0.1, 0.3)
    for crank, ground, offset in ((0.0, 0.3, 0.1), (0.3, 0.0, 0.1), (0.1, 0.1, 0.3)):
        with pytest.raises(ValueError, match="reach the guide together"):
            inverted_slider_crank_type(crank, ground, offset)


@pytest.mark.parametrize(
    ("scene", "word"),
    [
        ("slider-crank-offset", "Grashof offset slider-crank"),
        ("whitworth", "Whitworth"),
        ("slotted-lever", "slotted lever"),
    ],
)
def test_a_scene_has_the_name_of_its_chain(scene: str, word: str) -> None:
    found = grashof_of(load_scene(scene))
    assert word in found.name


def test_a_six_bar_has_none() -> None:
    assert grashof_of(load_scene("sixbar-watt")) is None
