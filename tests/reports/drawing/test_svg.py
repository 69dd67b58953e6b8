"""The SVG of a mechanism: whole, in the frame, legible on white and on black, with its forces."""

import io
import re
from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
from PIL import Image

from analytic.kinematics import solve
from models.array import Array
from models.errors import ReachError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from reports.drawing import gif, shape
from reports.drawing.force_arrows import CUT, LONGEST, force_arrows, rounded
from reports.drawing.svg import COLOURS, HEIGHT, WIDTH, svg
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.reports.page.test_style import contrast
from tests.worlds.tiers import few

SAMPLES = 37
SVG = "{http://www.w3.org/2000/svg}"
KINDS = {"fourbar-lecture-1", "shaper", "scotch-yoke", "tangent", "sixbar-stephenson"}
"""A chain, blocks on a lever and on the ground, a link that slides, a crank that locks, a plate."""


@pytest.mark.parametrize("name", few(shipped(), KINDS, "what is drawn differs between kinds"))
def test_every_link_point_and_block_is_drawn_in_the_frame(name: str) -> None:
    scene = load_scene(name)
    root = Xml.fromstring(svg(scene))
    wide, tall = float(root.get("width", 0)), float(root.get("height", 0))
    assert max(wide / WIDTH, tall / HEIGHT) == pytest.approx(1.0, abs=0.01)
    texts = list(root.iter(f"{SVG}text"))
    slid = {slider.point for slider in scene.sliders.values()}
    assert sorted(str(x.text) for x in texts) == sorted([*{*scene.pins, *slid}, *scene.links])
    bars = [each for each in root.iter(f"{SVG}polygon") if each.get("stroke-width") == "5"]
    assert len(bars) == len(scene.links)
    assert len({each.get("stroke") for each in bars}) == len(scene.links)
    for element in root.iter():
        for x, y in re.findall(r"(-?[\d.]+),(-?[\d.]+)", element.get("points", "")):
            assert -1 <= float(x) <= wide + 1
            assert -1 <= float(y) <= tall + 1
    for text in texts:
        assert 0 <= float(text.get("x", -1)) <= wide
        assert 0 <= float(text.get("y", -1)) <= tall


def test_the_path_of_a_run_is_drawn_as_far_as_it_is_finite(fourbar: Scene) -> None:
    def half(series: Array) -> Array:
        return np.concatenate([series[:200], np.full_like(series[200:], np.nan)])

    text = svg(fourbar, solve(fourbar, np.linspace(0.0, 0.6, 400)).each_series(half))
    assert "nan" not in "".join(re.findall('points="(.*?)"', text))
    assert text.count("stroke-dasharray") == 2


def test_a_mechanism_without_a_whole_turn_is_told_by_its_error(fourbar: Scene) -> None:
    long = replace(fourbar.links["crank"], points={"A": (0.0, 0.0), "B": (0.9, 0.0)})
    with pytest.raises(ReachError):
        svg(replace(fourbar, links={**fourbar.links, "crank": long}))


@pytest.mark.parametrize("paper", ["#ffffff", "#111111", "#1e1e1e"])
def test_links_are_seen_on_white_and_on_black(paper: str) -> None:
    assert [colour for colour in COLOURS if contrast(colour, paper) < 3.0] == []


def test_an_arrow_goes_from_its_pin_along_its_force(fourbar: Scene) -> None:
    turn = shape.turn_of(fourbar, SAMPLES, with_forces=True)
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
    turn = shape.turn_of(scene, SAMPLES, with_forces=True)
    arrows = force_arrows(scene, turn)
    low, high = arrows.box(turn)
    every = [arrow for k in range(SAMPLES) for arrow in arrows.at(turn, k)]
    tips = np.array([arrow.tip for arrow in every])
    assert (tips > low).all()
    assert (tips < high).all()
    assert max(np.hypot(*(x.tip - x.tail)) for x in every) >= LONGEST * arrows.size


def test_beside_a_dead_point_an_arrow_is_cut_off_and_has_no_head() -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    turn = shape.turn_of(scene, 721, with_forces=True)
    arrows = force_arrows(scene, turn)
    every = [arrow for k in range(721) for arrow in arrows.at(turn, k)]
    cut = [np.hypot(*(x.tip - x.tail)) for x in every if not x.is_whole]
    assert cut
    assert cut == pytest.approx([CUT * LONGEST * arrows.size] * len(cut))


def test_the_bar_is_a_round_number() -> None:
    bars = {0.7: 0.5, 1.0: 1.0, 199.0: 100.0, 4e-3: 2e-3, 5.0: 5.0}
    assert {value: rounded(value) for value in bars} == pytest.approx(bars, rel=1e-12)


def test_a_picture_has_arrows_and_a_bar_where_forces_act(fourbar: Scene) -> None:
    plain, forced = svg(fourbar), svg(fourbar, with_forces=True)
    assert plain == svg(fourbar, with_forces=False)
    assert any(str(each.text).endswith(" N") for each in Xml.fromstring(forced).iter(f"{SVG}text"))
    no_reactions = with_strut(parallelogram(1), "B0", "B1")
    assert " N<" not in plain + svg(no_reactions, with_forces=True)


def test_a_strip_draws_arrows(monkeypatch: pytest.MonkeyPatch) -> None:
    """A link's colour is on more of the picture with them than without."""
    monkeypatch.setattr(gif, "STRIP", 2)
    scene = load_scene("shaper")
    red = [int(shape.COLOURS[0][k : k + 2], 16) for k in (1, 3, 5)]

    def coloured() -> int:
        with Image.open(io.BytesIO(gif.strip(scene, with_forces=True))) as image:
            return int(np.sum(np.all(np.asarray(image.convert("RGB")) == red, axis=-1)))

    with_arrows = coloured()
    monkeypatch.setattr(gif, "draw_arrows", lambda *_: None)
    assert with_arrows > coloured()
