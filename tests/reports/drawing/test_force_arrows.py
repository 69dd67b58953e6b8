"""Forces as arrows: at their pins, along the forces, to one scale, and inside the picture."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from models.files import load_scene
from models.scene import Scene
from reports.drawing import gif
from reports.drawing.force_arrows import CUT, LONGEST, force_arrows, rounded
from reports.drawing.shape import COLOURS, turn_of
from reports.drawing.svg import svg
from tests.analytic.dyads.test_redundant import parallelogram, with_strut

SAMPLES = 37


def test_an_arrow_goes_from_its_pin_along_its_force(fourbar: Scene) -> None:
    turn = turn_of(fourbar, SAMPLES, with_forces=True)
    assert turn.forces is not None
    arrows = force_arrows(fourbar, turn)
    for index in range(SAMPLES):
        by_tail = {tuple(arrow.tail): arrow for arrow in arrows.at(turn, index)}
        for point, bodies in turn.forces.pins.items():
            tail = tuple(turn.points[point].position[index])
            if tail in by_tail:
                arrow, force = by_tail[tail], list(bodies.values())[1][index]
                assert arrow.body == list(bodies)[1]
                np.testing.assert_allclose(arrow.tip - arrow.tail, arrows.m_per_n * force)


@pytest.mark.parametrize("name", ["shaper", "tangent", "slider-crank-offset"])
def test_all_arrows_of_a_turn_are_in_the_box(name: str) -> None:
    scene = load_scene(name)
    turn = turn_of(scene, SAMPLES, with_forces=True)
    arrows = force_arrows(scene, turn)
    low, high = arrows.box(turn)
    tips = np.array([arrow.tip for k in range(SAMPLES) for arrow in arrows.at(turn, k)])
    assert (tips > low).all()
    assert (tips < high).all()
    longest = max(
        np.hypot(*(arrow.tip - arrow.tail)) for k in range(SAMPLES) for arrow in arrows.at(turn, k)
    )
    assert longest >= LONGEST * arrows.size


def test_beside_a_dead_point_an_arrow_is_cut_off_and_has_no_head() -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    turn = turn_of(scene, 721, with_forces=True)
    arrows = force_arrows(scene, turn)
    every = [arrow for k in range(721) for arrow in arrows.at(turn, k)]
    cut = [arrow for arrow in every if not arrow.is_whole]
    assert cut
    for arrow in cut:
        length = np.hypot(*(arrow.tip - arrow.tail))
        assert length == pytest.approx(CUT * LONGEST * arrows.size)


@pytest.mark.parametrize(
    ("value", "bar"), [(0.7, 0.5), (1.0, 1.0), (199.0, 100.0), (4e-3, 2e-3), (5.0, 5.0)]
)
def test_the_bar_is_a_round_number(value: float, bar: float) -> None:
    assert rounded(value) == pytest.approx(bar, rel=1e-12)


def test_a_picture_without_forces_is_as_it_was_and_with_them_has_arrows(fourbar: Scene) -> None:
    plain, forced = svg(fourbar), svg(fourbar, with_forces=True)
    assert plain == svg(fourbar, with_forces=False)
    text = "{http://www.w3.org/2000/svg}text"
    bars = [each.text for each in ET.fromstring(forced).iter(text)]
    assert any(word is not None and word.endswith(" N") for word in bars)
    assert " N<" not in plain


def test_where_there_are_no_reactions_there_are_no_arrows_and_no_bar() -> None:
    scene = with_strut(parallelogram(1), "B0", "B1")
    assert " N<" not in svg(scene, with_forces=True)


def test_a_strip_draws_arrows(monkeypatch: pytest.MonkeyPatch) -> None:
    """A link's colour is on more of the picture with them than without."""
    monkeypatch.setattr(gif, "STRIP", 2)
    scene = load_scene("shaper")
    red = [int(COLOURS[0][k : k + 2], 16) for k in (1, 3, 5)]

    def coloured() -> int:
        with Image.open(io.BytesIO(gif.strip(scene, with_forces=True))) as image:
            return int(np.sum(np.all(np.asarray(image.convert("RGB")) == red, axis=-1)))

    with_arrows = coloured()
    monkeypatch.setattr(gif, "draw_arrows", lambda *_: None)
    assert with_arrows > coloured()
