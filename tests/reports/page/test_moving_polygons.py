"""The page of polygons in a browser: they move, step by step."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser

from models.files import load_scene
from reports.sheets.polygons.polygon_instant import placed_at_time
from reports.sheets.polygons.polygon_page import polygon_page
from tests.reports.page.conftest import Opened


def test_the_page_moves_and_draws_step_by_step(browser: Browser, tmp_path: Path) -> None:
    """A real browser alone finds what a script does wrong: some 2 s."""
    path = tmp_path / "yoke.html"
    page = polygon_page(placed_at_time(load_scene("scotch-yoke"), 0.02))
    path.write_text(page, encoding="utf-8")
    context = browser.new_context(offline=True, reduced_motion="reduce")
    opened = Opened(context.new_page())
    opened.watch()
    opened.page.goto(path.as_uri())
    arrows = opened.page.locator("#polygons-velocity .head")
    whole = arrows.count()
    first = opened.page.locator("#polygons-velocity-rows").inner_text()
    move = """([id, at]) => { const range = document.getElementById(id);
      range.value = at; range.dispatchEvent(new Event('input')); }"""
    opened.page.evaluate(move, ["polygons-slider", 60])
    assert opened.page.locator("#polygons-velocity-rows").inner_text() != first
    opened.page.evaluate(move, ["polygons-step", 1])
    assert 0 < arrows.count() < whole
    assert "driver" in opened.page.locator("#polygons-step-title").inner_text()
    assert "one point, as omega is 0" in opened.page.locator("#polygons-links").inner_text()
    context.close()
    assert not opened.said
    assert opened.asked == [path.as_uri()]
