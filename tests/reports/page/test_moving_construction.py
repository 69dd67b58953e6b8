"""The page of a construction in a browser: step after step, then the mechanism."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from analytic.synthesis.design import Proposal
from reports.sheets.constructions.construction_page import construction_page
from tests.reports.page.tab import Tab
from tests.reports.sheets.constructions.constructed import (
    burmester_curves,
    far_pole,
    rocker_by_angle,
    three_positions,
)
from tests.worlds.tiers import slowly

PLACE, PICTURE, PLAY = "#construction-place", "#construction-picture", "#construction-play"
LINES = f"{PICTURE} .lines > g:not([hidden])"
Write = Callable[[str], Path]


@pytest.fixture(scope="module")
def three(written: Write) -> Path:
    return written(construction_page(three_positions()))


@pytest.fixture(scope="module")
def rocker(written: Write) -> Path:
    return written(construction_page(rocker_by_angle()))


def test_keys_lead_from_step_to_step_and_through_the_positions(wide: Tab, three: Path) -> None:
    page = wide.open(three).page
    seen = []
    for _ in range(5):
        seen.append((page.locator(PLACE).inner_text(), page.locator(LINES).count()))
        page.keyboard.press("ArrowLeft")
    assert seen == [
        ("Step 4 of 4", 16),
        ("Step 3 of 4", 13),
        ("Step 2 of 4", 8),
        ("Step 1 of 4", 3),
        ("Before the first step", 0),
    ]
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    told = []
    for _ in range(3):
        told.append(page.locator(PLACE).inner_text())
        assert page.locator(f"{PICTURE} .poses .met").count() == 1
        page.keyboard.press("ArrowRight")
    assert [words.split(", ")[1] for words in told] == [f"position {k} of 3" for k in (1, 2, 3)]
    assert not wide.said


def test_the_mechanism_covers_the_pose_that_it_is_in(wide: Tab, three: Path) -> None:
    page = wide.visit(three).page
    wide.slide("construction-slider", 0)
    for _ in range(7):
        page.keyboard.press("ArrowRight")
    assert "position 3" in page.locator(PLACE).inner_text()
    ends = """each => each.getAttribute('d').match(/-?[\\d.]+/g).slice(0, 4).map(Number)"""
    pose = page.locator(f"{PICTURE} .poses .met path").evaluate(ends)
    links = page.locator(f"{PICTURE} .reference .link").evaluate_all(f"all => all.map({ends})")
    assert min(max(abs(a - b) for a, b in zip(pose, one, strict=True)) for one in links) < 0.5


def test_buttons_the_slider_and_the_words_go_to_a_step(wide: Tab, rocker: Path) -> None:
    page = wide.open(rocker).page
    page.locator("#construction-steps button").nth(1).click()
    assert page.locator(PLACE).inner_text() == "Step 2 of 5"
    assert page.locator("[aria-current=step]").inner_text() == "The line B1 B2, and its extension."
    page.locator("#construction-forward").click()
    page.locator("#construction-forward").click()
    assert page.locator(PLACE).inner_text() == "Step 4 of 5"
    page.locator("#construction-back").click()
    assert page.locator(PLACE).inner_text() == "Step 3 of 5"
    wide.slide("construction-slider", float(page.get_attribute("#construction-slider", "max") or 0))
    assert page.locator(PLACE).inner_text().startswith("crank at")
    assert not wide.said


def test_those_who_want_no_motion_get_whole_steps(wide: Tab, rocker: Path) -> None:
    page = wide.visit(rocker).page
    wide.elapse(0)
    page.locator(PLAY).click()
    seen = [page.locator(PLACE).inner_text()]
    for _ in range(7):
        wide.elapse(2500)
        seen.append(page.locator(PLACE).inner_text())
        assert page.locator(f"{PICTURE} .lines path:not([stroke-dasharray=none])").count() == (
            page.locator(f"{PICTURE} .lines > g[hidden] path").count()
        )
    assert seen[:5] == [f"Step {k} of 5" for k in range(1, 6)]
    assert seen[5:7] == ["crank at 205°, position 1 of 2", "crank at 25°, position 2 of 2"]
    assert page.locator(PLAY).inner_text() == "Play"


def test_it_plays_by_itself_once_where_motion_is_welcome(wide: Tab, rocker: Path) -> None:
    page = wide.open(rocker, reduced_motion="no-preference").page
    page.wait_for_function(
        "() => document.querySelector('#construction-play').innerText == 'Pause'"
    )
    page.keyboard.press(" ")
    assert page.locator(PLAY).inner_text() == "Play"
    wide.elapse(0)
    page.keyboard.press(" ")
    wide.elapse(1000)
    assert page.locator(PLAY).inner_text() == "Pause"
    wide.elapse(17_000)
    assert page.locator(PLACE).inner_text().startswith("crank at")
    assert not wide.said


OTHER = "each size and each figure is read once: what one has with the other is slow"


@pytest.mark.parametrize(
    ("make", "size"),
    [
        (burmester_curves, "phone"),
        (far_pole, "wide"),
        slowly(burmester_curves, "wide", reason=OTHER),
        slowly(far_pole, "phone", reason=OTHER),
    ],
)
def test_it_can_be_read_without_scrolling_aside(
    make: Callable[[], Proposal], size: str, written: Write, request: pytest.FixtureRequest
) -> None:
    tab: Tab = request.getfixturevalue(size)
    page = tab.open(written(construction_page(make()))).page
    width = page.evaluate("[document.documentElement.scrollWidth, innerWidth]")
    assert width[0] <= width[1]
    assert page.locator("#construction-words").is_visible() == (size == "phone")
    far = page.locator("#construction-far").inner_text()
    assert far.startswith("Off the picture: P12 at (-4.95, 25) m") == (make is far_pole)
    letters = page.locator(f"{PICTURE} .dots text").evaluate_all(
        """all => all.map(each => {
          const { left, top, right, bottom } = each.getBoundingClientRect();
          return [left, top, right, bottom];
        })"""
    )
    box = page.locator(PICTURE).bounding_box()
    assert box is not None
    assert len(letters) >= 8
    for k, (left, top, right, bottom) in enumerate(letters):
        assert left > box["x"] - 1
        assert right < box["x"] + box["width"] + 1
        for other in letters[:k]:
            inner = (
                left + 3 < other[2],
                other[0] + 3 < right,
                top + 5 < other[3],
                other[1] + 5 < bottom,
            )
            assert not all(inner)
    assert not tab.said
    assert all(asked.startswith("file:") for asked in tab.asked)
