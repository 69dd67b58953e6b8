"""The page of polygons in a browser: they move, step by step."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from models.files import load_scene
from reports.sheets.polygons.polygon_instant import placed_at_time
from reports.sheets.polygons.polygon_page import polygon_page
from tests.reports.page.tab import Tab


def test_the_page_moves_and_draws_step_by_step(wide: Tab, written: Callable[[str], Path]) -> None:
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
