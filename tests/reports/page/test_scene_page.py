"""Pages of a solved scene in a browser: they load nothing, and move with all that is on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from models.files import load_scene
from reports.face.scene_report import elastic_page_of, free_page_of, page_of
from reports.page.scene_sections.elastic import factors
from reports.sheets.polygons.polygon_instant import placed_at_time
from reports.sheets.polygons.polygon_page import polygon_page
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.reports.page.tab import PHONE, WIDE, Tab
from tests.worlds.tiers import slowly

COUPLER = "#motion-picture .overlays .link:nth-child(2)"
Write = Callable[[str], Path]


@pytest.fixture(scope="module")
def elastic(written: Write) -> Path:
    scene = load_scene("fourbar-elastic")
    motion = DrivenElasticMotion(
        scene, scene.driver.law.period_s, Modes(3), "periodic", stiffened=True
    )
    return written(elastic_page_of(motion))


def test_a_page_moves_with_its_forces_and_says_nothing_wrong(wide: Tab, written: Write) -> None:
    path = written(page_of(load_scene("shaper"), with_forces=True))
    wide.open(path)
    seen = []
    for at in (0, 61):
        wide.slide("motion-slider", at)
        told = wide.page.locator("#motion-torque").inner_text()
        seen.append((wide.drawn("#motion-picture .force path"), told))
    assert not wide.said
    assert wide.asked == [wide.file.as_uri()]
    assert seen[0] != seen[1]
    assert all(len(arrows) >= 6 for arrows, _ in seen)
    assert "Driving torque here: 1.93 N m." in seen[0][1]


def test_a_free_motion_moves_and_tells_the_time(wide: Tab, written: Write) -> None:
    wide.open(written(free_page_of(release(load_scene("fourbar-swing"), 0.5))))
    seen = []
    for at in (0, 60):
        wide.slide("motion-slider", at)
        shape = wide.drawn("#motion-picture .reference path")
        seen.append((shape, wide.page.locator("#motion-angle").inner_text()))
    assert not wide.said
    assert seen[0][0] != seen[1][0]
    assert (seen[0][1], seen[1][1]) == ("0.00 s", "0.250 s")


def test_a_page_without_forces_has_none() -> None:
    text = page_of(load_scene("tangent"), with_forces=False)
    assert "force-figures" not in text.partition("<main")[2]
    assert 'id="forces"' not in text
    assert "<h2" in text


@pytest.mark.parametrize(("propped", "pictures"), [(False, 5), (True, 2)])
def test_a_page_has_the_figures_that_there_are(propped: bool, pictures: int) -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    if propped:
        scene = with_strut(scene, "B0", "B1")
    text = page_of(scene, with_forces=True)
    assert text.count("data:image/svg+xml;base64,") == pictures
    assert ("Reactions: none" in text) == propped
    assert "nan" not in text.partition("<main")[2].partition("<script")[0].lower().split()


@pytest.mark.parametrize(
    ("size", "width"),
    [
        ("phone", PHONE["width"]),
        slowly("wide", WIDE["width"], reason="what fits a phone fits a computer"),
    ],
)
def test_a_page_bends_its_links_by_the_factor_that_is_chosen(
    elastic: Path, size: str, width: int, request: pytest.FixtureRequest
) -> None:
    tab: Tab = request.getfixturevalue(size)
    seen = tab.open(elastic).page
    tab.slide("motion-slider", 8)
    assert seen.locator("#motion-factor").input_value() == "50"
    (bent,) = tab.drawn(COUPLER)
    assert bent.count("L") == 20
    assert "coupler 1.05 mm" in seen.locator("#motion-deflection").inner_text()
    seen.select_option("#motion-factor", "1")
    assert tab.drawn(COUPLER) != [bent]
    tab.slide("motion-slider", 60)
    assert "coupler -0.669" in seen.locator("#motion-deflection").inner_text()
    assert seen.evaluate("document.documentElement.scrollWidth") <= width
    assert not tab.said
    assert tab.asked == [tab.file.as_uri()]


def test_factors_have_the_chosen_one_among_them() -> None:
    for chosen in (1.0, 2.0, 50.0, 1000.0, 2e5):
        values = [float(value) for value, _ in factors(chosen)]
        assert chosen in values
        assert values[0] == 1.0
        assert values == sorted(values)
        assert values[-1] <= 10.0 * chosen


def test_polygons_move_and_are_drawn_step_by_step(wide: Tab, written: Write) -> None:
    path = written(polygon_page(placed_at_time(load_scene("scotch-yoke"), 0.02)))
    page = wide.open(path).page
    arrows = page.locator("#polygons-velocity .head")
    whole = arrows.count()
    first = page.locator("#polygons-velocity-rows").inner_text()
    wide.slide("polygons-slider", 60)
    assert page.locator("#polygons-velocity-rows").inner_text() != first
    wide.slide("polygons-step", 1)
    assert 0 < arrows.count() < whole
    assert "driver" in page.locator("#polygons-step-title").inner_text()
    assert "one point, as omega is 0" in page.locator("#polygons-links").inner_text()
    assert not wide.said
    assert wide.asked == [wide.file.as_uri()]
