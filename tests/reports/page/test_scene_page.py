"""The page of a solved scene: it loads nothing, moves its forces, and tells the largest."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from analytic.free.release import release
from models.files import load_scene
from reports.face.scene_report import free_page_of, page_of
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.reports.page.conftest import Opened

STEP = """at => { const slider = document.getElementById('motion-slider');
  slider.value = at; slider.dispatchEvent(new Event('input')); }"""


def test_a_page_moves_with_its_forces_and_says_nothing_wrong(
    browser: Browser, tmp_path: Path
) -> None:
    """A real browser alone finds what a script does wrong: some 2 s."""
    path = tmp_path / "shaper.html"
    path.write_text(page_of(load_scene("shaper"), with_forces=True), encoding="utf-8")
    context = browser.new_context(offline=True)
    opened = Opened(context.new_page())
    opened.watch()
    opened.page.goto(path.as_uri())
    seen = []
    for at in (0, 61):
        opened.page.evaluate(STEP, at)
        arrows = opened.page.locator("#motion-picture .force path").all()
        told = opened.page.locator("#motion-torque").inner_text()
        seen.append(([each.get_attribute("d") for each in arrows], told))
    context.close()
    assert not opened.said
    assert opened.asked == [path.as_uri()]
    assert seen[0] != seen[1]
    assert all(len(arrows) >= 6 for arrows, _ in seen)
    assert "Driving torque here: 1.93 N m." in seen[0][1]


def test_a_free_motion_moves_and_tells_the_time(browser: Browser, tmp_path: Path) -> None:
    """As above: some 2 s."""
    path = tmp_path / "swing.html"
    path.write_text(free_page_of(release(load_scene("fourbar-swing"), 0.5)), encoding="utf-8")
    context = browser.new_context(offline=True)
    opened = Opened(context.new_page())
    opened.watch()
    opened.page.goto(path.as_uri())
    seen = []
    for at in (0, 60):
        opened.page.evaluate(STEP, at)
        links = opened.page.locator("#motion-picture .reference path").all()
        shape = [each.get_attribute("d") for each in links]
        seen.append((shape, opened.page.locator("#motion-angle").inner_text()))
    context.close()
    assert not opened.said
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
