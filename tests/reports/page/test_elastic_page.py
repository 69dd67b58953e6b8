"""The page of a scene with elastic links: it moves, bends and magnifies, and loads nothing."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.files import load_scene
from reports.face.scene_report import elastic_page_of
from reports.page.scene_sections.elastic import factors
from tests.reports.page.tab import PHONE, WIDE, Tab
from tests.worlds.tiers import slowly

COUPLER = "#motion-picture .overlays .link:nth-child(2)"


@pytest.fixture(scope="module")
def path(written: Callable[[str], Path]) -> Path:
    scene = load_scene("fourbar-elastic")
    motion = DrivenElasticMotion(
        scene, scene.driver.law.period_s, Modes(3), "periodic", stiffened=True
    )
    return written(elastic_page_of(motion))


@pytest.mark.parametrize(
    ("size", "width"),
    [
        ("phone", PHONE["width"]),
        slowly("wide", WIDE["width"], reason="what fits a phone fits a computer"),
    ],
)
def test_a_page_bends_its_links_by_the_factor_that_is_chosen(
    path: Path, size: str, width: int, request: pytest.FixtureRequest
) -> None:
    tab: Tab = request.getfixturevalue(size)
    seen = tab.open(path).page
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
