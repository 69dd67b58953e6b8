"""The SVG of a mechanism: whole, in the frame, and legible on white and on black."""

from __future__ import annotations

import re
from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import ReachError
from models.files import load_scene, shipped
from models.scene import Scene
from reports.drawing.svg import COLOURS, HEIGHT, WIDTH, svg
from tests.worlds.tiers import few

SVG = "{http://www.w3.org/2000/svg}"
KINDS = {"fourbar-lecture-1", "shaper", "scotch-yoke", "tangent", "sixbar-stephenson"}
"""A chain, blocks on a lever and on the ground, a link that slides, a crank that locks, a plate."""


@pytest.mark.parametrize("name", few(shipped(), KINDS, "what is drawn differs between kinds"))
def test_every_link_point_and_block_is_drawn_in_the_frame(name: str) -> None:
    scene = load_scene(name)
    root = Xml.fromstring(svg(scene))
    wide, tall = float(root.get("width", 0)), float(root.get("height", 0))
    assert max(wide / WIDTH, tall / HEIGHT) == pytest.approx(1.0, abs=0.01)
    texts = [each.text for each in root.iter(f"{SVG}text")]
    slid = {slider.point for slider in scene.sliders.values()}
    assert sorted(map(str, texts)) == sorted([*{*scene.pins, *slid}, *scene.links])
    bars = [each for each in root.iter(f"{SVG}polygon") if each.get("stroke-width") == "5"]
    assert len(bars) == len(scene.links)
    assert len({each.get("stroke") for each in bars}) == len(scene.links)
    for element in root.iter():
        for x, y in re.findall(r"(-?[\d.]+),(-?[\d.]+)", element.get("points", "")):
            assert -1 <= float(x) <= wide + 1
            assert -1 <= float(y) <= tall + 1
    for text in root.iter(f"{SVG}text"):
        assert 0 <= float(text.get("x", -1)) <= wide
        assert 0 <= float(text.get("y", -1)) <= tall


def test_the_path_of_a_run_is_drawn_as_far_as_it_is_finite(fourbar: Scene) -> None:
    time_s = np.linspace(0.0, 0.6, 400)
    moved = solve(fourbar, time_s).each_series(
        lambda series: np.where((np.arange(400) < 200).reshape(-1, *[1] * (series.ndim - 1)),
                                series, np.nan)
    )  # fmt: skip
    text = svg(fourbar, moved)
    assert "nan" not in "".join(re.findall('points="(.*?)"', text))
    assert text.count("stroke-dasharray") == 2


def test_a_mechanism_without_a_whole_turn_is_told_by_its_error(fourbar: Scene) -> None:
    crank = fourbar.links["crank"]
    long = replace(crank, points={"A": (0.0, 0.0), "B": (0.9, 0.0)})
    with pytest.raises(ReachError):
        svg(replace(fourbar, links={**fourbar.links, "crank": long}))


def luminance(colour: str) -> float:
    """As the rules for legible pages have it (WCAG 2.2)."""
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts
    ]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


@pytest.mark.parametrize("colour", COLOURS)
@pytest.mark.parametrize("paper", ["#ffffff", "#111111", "#1e1e1e"])
def test_links_are_seen_on_white_and_on_black(colour: str, paper: str) -> None:
    low, high = sorted((luminance(colour), luminance(paper)))
    assert (high + 0.05) / (low + 0.05) >= 3.0
