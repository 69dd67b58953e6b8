"""The page of a scene with elastic links: it moves, bends and magnifies, and loads nothing."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.files import load_scene
from reports.face.scene_report import elastic_page_of
from reports.page.scene_sections.elastic import factors
from tests.reports.page.conftest import PHONE, WIDE, Opened

STEP = """at => { const slider = document.getElementById('motion-slider');
  slider.value = at; slider.dispatchEvent(new Event('input')); }"""
COUPLER = "#motion-picture .overlays .link:nth-child(2)"


def test_a_page_bends_its_links_by_the_factor_that_is_chosen(
    browser: Browser, tmp_path: Path
) -> None:
    """A real browser alone finds what a script does wrong: some 3 s."""
    path = tmp_path / "elastic.html"
    scene = load_scene("fourbar-elastic")
    motion = DrivenElasticMotion(
        scene, scene.driver.law.period_s, Modes(3), "periodic", stiffened=True
    )
    path.write_text(elastic_page_of(motion), encoding="utf-8")
    for viewport in (WIDE, PHONE):
        context = browser.new_context(offline=True, reduced_motion="reduce", viewport=viewport)
        opened = Opened(context.new_page())
        opened.watch()
        seen = opened.page
        seen.goto(path.as_uri())
        seen.evaluate(STEP, 8)
        assert seen.locator("#motion-factor").input_value() == "50"
        bent = seen.locator(COUPLER).get_attribute("d")
        assert bent is not None
        assert bent.count("L") == 20
        assert "coupler 1.05 mm" in seen.locator("#motion-deflection").inner_text()
        seen.select_option("#motion-factor", "1")
        assert seen.locator(COUPLER).get_attribute("d") != bent
        seen.evaluate(STEP, 60)
        assert "coupler -0.669" in seen.locator("#motion-deflection").inner_text()
        wide = seen.evaluate("document.documentElement.scrollWidth")
        assert wide <= viewport["width"]
        context.close()
        assert not opened.said
        assert opened.asked == [path.as_uri()]


def test_factors_have_the_chosen_one_among_them() -> None:
    for chosen in (1.0, 2.0, 50.0, 1000.0, 2e5):
        values = [float(value) for value, _ in factors(chosen)]
        assert chosen in values
        assert values[0] == 1.0
        assert values == sorted(values)
        assert values[-1] <= 10.0 * chosen
