"""Pages of a solved scene and of a construction in a browser: they load nothing, and move with all
that is on them."""

import itertools
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from analytic.lectures.synthesis.design import Proposal
from models.files.reading import load_scene
from reports.describe.elastic_course import closely_sampled, drawn_course
from reports.figures.elastic_figures import ELASTIC_FIGURES
from reports.figures.force_figures import FORCE_FIGURES
from reports.figures.force_turn import force_turn
from reports.figures.free_figures import FREE_FIGURES, free_course
from reports.lectures.design.pages import construction_page
from reports.lectures.drawing.sheets.polygon_instant import placed_at_time
from reports.lectures.drawing.sheets.polygon_page import polygon_page
from reports.page.scene_page import elastic_page, factors, free_page, scene_page
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.reports.lectures.design.constructions.constructed import (
    burmester_curves,
    far_pole,
    rocker_by_angle,
    three_positions,
)
from tests.reports.page.conftest import Write
from tests.reports.page.tab import Tab
from tests.worlds.tiers import slowly

COUPLER = "#motion-picture .overlays .link:nth-child(2)"
PLACE, PICTURE, PLAY = "#construction-place", "#construction-picture", "#construction-play"
LINES = f"{PICTURE} .lines > g:not([hidden])"
BOXES = """all => all.map(each => {
  const { left, top, right, bottom } = each.getBoundingClientRect();
  return [left, top, right, bottom];
})"""


def moved(wide: Tab, places: tuple[int, ...], shapes: str, told: str) -> tuple[list[str], list]:
    """What is told at two places of the slider, and the shapes there, which differ."""
    words, drawn = [], []
    for at in places:
        wide.slide("motion-slider", at)
        words.append(wide.text(told))
        drawn.append(wide.drawn(shapes))
    assert drawn[0] != drawn[1]
    return words, drawn


def test_a_page_moves_with_its_forces_or_tells_the_time(wide: Tab, written: Write) -> None:
    scene = load_scene("shaper")
    wide.open(written(scene_page(scene, FORCE_FIGURES.pictures(force_turn(scene)))))
    words, drawn = moved(wide, (0, 61), "#motion-picture .force path", "#motion-torque")
    assert all(len(arrows) >= 6 for arrows in drawn)
    assert "Driving torque here: 1.93 N m." in words[0]
    free = release(load_scene("fourbar-swing"), 0.5)
    wide.open(written(free_page(free, FREE_FIGURES.pictures(free_course(free)))))
    words, _ = moved(wide, (0, 60), "#motion-picture .reference path", "#motion-angle")
    assert words == ["0.00 s", "0.250 s"]


@pytest.mark.parametrize(
    ("propped", "pictures"), [(False, 5), slowly(True, 2, reason="a figure that is missing")]
)
def test_a_page_has_the_figures_that_there_are(propped: bool, pictures: int) -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    if propped:
        scene = with_strut(scene, "B0", "B1")
    text = scene_page(scene, FORCE_FIGURES.pictures(force_turn(scene)))
    assert text.count("data:image/svg+xml;base64,") == pictures
    assert ("Reactions: none" in text) == propped
    assert "nan" not in text.partition("<main")[2].partition("<script")[0].lower().split()
    plain = scene_page(load_scene("tangent"))
    assert "force-figures" not in plain.partition("<main")[2]
    assert 'id="forces"' not in plain
    assert "<h2" in plain


def test_a_page_bends_its_links_by_the_factor_that_is_chosen(phone: Tab, written: Write) -> None:
    scene = load_scene("fourbar-elastic")
    turn_s = scene.driver.law.period_s
    motion = DrivenElasticMotion(scene, turn_s, Modes(3), "periodic", stiffened=True)
    course = drawn_course(motion, closely_sampled(scene, motion.until_s))
    seen = phone.open(written(elastic_page(motion, course, ELASTIC_FIGURES.pictures(course)))).page
    phone.slide("motion-slider", 8)
    assert seen.locator("#motion-factor").input_value() == "50"
    (bent,) = phone.drawn(COUPLER)
    assert bent.count("L") == 20
    assert "coupler 1.05 mm" in phone.text("#motion-deflection")
    seen.select_option("#motion-factor", "1")
    assert phone.drawn(COUPLER) != [bent]
    phone.slide("motion-slider", 60)
    assert "coupler -0.669" in phone.text("#motion-deflection")
    phone.needs_no_scrolling_aside()


def test_factors_have_the_chosen_one_among_them() -> None:
    for chosen in (1.0, 50.0, 2e5):
        values = [float(value) for value, _ in factors(chosen)]
        assert chosen in values
        assert values[0] == 1.0
        assert values == sorted(values)
        assert values[-1] <= 10.0 * chosen


def test_polygons_move_and_are_drawn_step_by_step(wide: Tab, written: Write) -> None:
    path = written(polygon_page(placed_at_time(load_scene("scotch-yoke"), 0.02)))
    page = wide.open(path).page
    arrows = page.locator("#polygons-velocity .head")
    whole, first = arrows.count(), wide.text("#polygons-velocity-rows")
    wide.slide("polygons-slider", 60)
    assert wide.text("#polygons-velocity-rows") != first
    wide.slide("polygons-step", 1)
    assert 0 < arrows.count() < whole
    assert "driver" in wide.text("#polygons-step-title")
    assert "one point, as omega is 0" in wide.text("#polygons-links")


def test_a_drawn_cam_turns_and_touches_its_roller(wide: Tab, written: Write) -> None:
    wide.open(written(scene_page(load_scene("cam-roller"), {})))
    _, drawn = moved(wide, (0, 20, 61), "#motion-picture .reference .curve", "#motion-angle")
    for shapes in drawn:
        cam, roller = (np.array(re.findall(r"[\d.]+", shape), float) for shape in shapes)
        cam, roller = cam.reshape(-1, 2), roller.reshape(-1, 2)
        fine = np.concatenate([cam + s * (np.roll(cam, 1, 0) - cam) for s in np.linspace(0, 1, 9)])
        middle = roller.mean(axis=0)
        gap = np.min(np.hypot(*(fine - middle).T)) - np.hypot(*(roller[0] - middle))
        assert gap == pytest.approx(0.0, abs=0.1)  # pixels


@pytest.fixture(scope="module")
def rocker(written: Write) -> Path:
    return written(construction_page(rocker_by_angle()))


def test_keys_lead_from_step_to_step_and_through_the_positions(wide: Tab, written: Write) -> None:
    page = wide.open(written(construction_page(three_positions()))).page
    seen = []
    for _ in range(5):
        seen.append((wide.text(PLACE), page.locator(LINES).count()))
        page.keyboard.press("ArrowLeft")
    steps = [(f"Step {k} of 4", lines) for k, lines in ((4, 16), (3, 13), (2, 8), (1, 3))]
    assert seen == [*steps, ("Before the first step", 0)]
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    told = []
    for _ in range(3):
        told.append(wide.text(PLACE))
        assert page.locator(f"{PICTURE} .poses .met").count() == 1
        page.keyboard.press("ArrowRight")
    assert [words.split(", ")[1] for words in told] == [f"position {k} of 3" for k in (1, 2, 3)]


def test_a_construction_begins_with_its_finished_drawing_and_moves_on(
    wide: Tab, rocker: Path
) -> None:
    page = wide.open(rocker).page
    assert wide.text(PLACE) == "Step 5 of 5"
    assert page.locator(f"{PICTURE} .lines > g[hidden]").count() == 0
    wide.open(rocker, reduced_motion="no-preference")
    page.wait_for_function(f"() => document.querySelector('{PLAY}').textContent === 'Pause'")
    wide.elapse(60_000)  # round after round, and never back to the empty frame
    assert wide.text(PLACE).startswith("crank at")
    assert wide.text(PLAY) == "Pause"


def test_buttons_lead_to_a_step_or_a_whole_one_without_motion(wide: Tab, rocker: Path) -> None:
    page = wide.open(rocker).page
    page.locator("#construction-steps button").nth(1).click()
    assert wide.text(PLACE) == "Step 2 of 5"
    assert wide.text("[aria-current=step]") == "The line B1 B2, and its extension."
    for way, step in (("forward", 3), ("back", 2)):
        page.locator(f"#construction-{way}").click()
        assert wide.text(PLACE) == f"Step {step} of 5"
    wide.slide("construction-slider", float(page.get_attribute("#construction-slider", "max")))
    assert wide.text(PLACE).startswith("crank at")
    wide.elapse(0)
    page.locator(PLAY).click()
    seen = [wide.text(PLACE)]
    partly, hidden = ":not([stroke-dasharray=none])", f"{PICTURE} .lines > g[hidden] path"
    for _ in range(7):
        wide.elapse(2500)
        seen.append(wide.text(PLACE))
        whole = page.locator(hidden).count()
        assert page.locator(f"{PICTURE} .lines path{partly}").count() == whole
    assert seen[:5] == [f"Step {k} of 5" for k in range(1, 6)]
    assert seen[5:7] == ["crank at 205°, position 1 of 2", "crank at 25°, position 2 of 2"]
    assert wide.text(PLAY) == "Play"


@pytest.mark.parametrize(("make", "size"), [(burmester_curves, "phone"), (far_pole, "wide")])
def test_it_can_be_read_without_scrolling_aside(
    make: Callable[[], Proposal], size: str, written: Write, request: pytest.FixtureRequest
) -> None:
    tab: Tab = request.getfixturevalue(size)
    page = tab.open(written(construction_page(make()))).page
    tab.needs_no_scrolling_aside()
    assert page.locator("#construction-words").is_visible() == (size == "phone")
    far = tab.text("#construction-far")
    assert far.startswith("Off the picture: P12 at (-4.95, 25) m") == (make is far_pole)
    letters = page.locator(f"{PICTURE} .dots text").evaluate_all(BOXES)
    ((start, _, end, _),) = page.locator(PICTURE).evaluate_all(BOXES)
    assert len(letters) >= 8
    assert all(start - 1 < left and right < end + 1 for left, _, right, _ in letters)
    for (x0, y0, x1, y1), (left, top, right, bottom) in itertools.combinations(letters, 2):
        assert x0 + 3 >= right or left + 3 >= x1 or y0 + 5 >= bottom or top + 5 >= y1
