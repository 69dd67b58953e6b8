"""The page of a solved scene: it loads nothing, moves its forces, and tells the largest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from analytic.free.release import release
from models.files import load_scene
from reports.face.scene_report import free_page_of, page_of
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.reports.page.tab import Tab

Write = Callable[[str], Path]


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
