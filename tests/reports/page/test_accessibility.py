"""Every kind of page under axe-core, wide and light, and as a dark page on a phone."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe

from analytic.free.release import release
from models.files.reading import load_scene
from reports.figures.force_figures import FORCE_FIGURES
from reports.figures.force_turn import force_turn
from reports.figures.free_figures import FREE_FIGURES, free_course
from reports.lectures.drawing.sheets.polygon_instant import placed_at_time
from reports.lectures.drawing.sheets.polygon_page import polygon_page
from reports.page.build import page
from reports.page.log_page import log_page
from reports.page.model_page import model_page
from reports.page.scene_page import free_page, scene_page
from reports.store.reader import read_store
from tests.reports.page.conftest import Write, swept
from tests.reports.page.judged_logs import FACTS, SCENE, angles, judged, motion_of
from tests.reports.page.tab import PHONE, WIDE, Tab
from tests.worlds import own_models
from tests.worlds.command_line import crank_alone
from tests.worlds.tiers import slow

OPENED = """() => {
  document.querySelectorAll('details').forEach(each => { each.open = true; });
  dispatchEvent(new Event('beforeprint'));
}"""
"""Every drawer is opened and every diagram drawn, as on paper: what is hidden is not checked."""
DRAWN = "() => [...document.querySelectorAll('.chart')].every(each => each.querySelector('svg'))"


def of_sweep(folder: Path, *asked: object) -> str:
    return page(read_store(swept(folder / "store", *asked, "--no-timing")))


def of_forces(folder: Path) -> str:
    return of_sweep(folder, "shaper", "--forces", "--steps-per-turn", "90,180", "--turns", 1)


def of_free(folder: Path) -> str:
    return of_sweep(folder, "double-pendulum", "--free", "--dt", "2e-3,1e-3", "--duration", 0.5)


def of_elastic(folder: Path) -> str:
    of_mujoco = ("--engine", "mujoco", "--segments", "3", "--steps-per-turn", "360,720")
    return of_sweep(folder, "fourbar-elastic", *of_mujoco, "--turns", 1)


def of_log(_: Path) -> str:
    motion = motion_of()
    return log_page(judged(motion.time_s, angles(motion, rocker=0.5)), FACTS)


def of_model(_: Path) -> str:
    return model_page(own_models.judged(own_models.SLIDER_CRANK, "motor"), own_models.FACTS)


def of_scene(_: Path) -> str:
    shaper = load_scene("shaper")
    return scene_page(shaper, FORCE_FIGURES.pictures(force_turn(shaper)))


def of_free_scene(_: Path) -> str:
    free = release(load_scene("fourbar-swing"), 0.5)
    return free_page(free, FREE_FIGURES.pictures(free_course(free)))


def of_synthesis(folder: Path, name: str) -> str:
    ended = crank_alone("synth", "coupler", "three-positions", "-o", folder / "synth")
    assert ended.exit_code == 0, ended.output
    return (folder / "synth" / name).read_text(encoding="utf-8")


KINDS: Mapping[str, Callable[[Path], str]] = {
    "forces": of_forces,
    "free": of_free,
    "elastic": of_elastic,
    "own log": of_log,
    "own model": of_model,
    "scene": of_scene,
    "free scene": of_free_scene,
    "polygons": lambda _: polygon_page(placed_at_time(SCENE, 0.02)),
    "synthesis": lambda folder: of_synthesis(folder, "index.html"),
    "construction": lambda folder: of_synthesis(folder, "construction-1.html"),
}


def serious(tab: Tab, path: Path) -> list[str]:
    """The findings of axe-core from serious on, in both shapes of a page, with their elements."""
    found = []
    for screen, scheme in ((WIDE, "light"), (PHONE, "dark")):
        shown = tab.on(screen).open(path, color_scheme=scheme).page
        shown.evaluate(OPENED)
        shown.wait_for_function(DRAWN)
        shown.evaluate("() => dispatchEvent(new Event('afterprint'))")
        tab.needs_no_scrolling_aside()
        found += [
            f"{scheme}: {each['id']}: {node['html'][:120]}"
            for each in Axe().run(shown).response["violations"]
            for node in each["nodes"]
            if each["impact"] in ("serious", "critical")
        ]
    tab.check()
    tab.path = None
    return found


@slow("axe-core takes seconds for each page")
@pytest.mark.parametrize("kind", KINDS)
def test_no_page_has_a_serious_finding(kind: str, tab: Tab, written: Write, tmp_path: Path) -> None:
    assert serious(tab, written(KINDS[kind](tmp_path))) == []


@slow("as above")
def test_neither_has_a_study_nor_a_map_of_hard_cases(
    tab: Tab, small_page: Path, hard_page: Path
) -> None:
    for path in (small_page, hard_page):
        assert serious(tab, path) == []


@slow("as above")
def test_axe_finds_what_can_not_be_read(tab: Tab, written: Write, small_page: Path) -> None:
    text = small_page.read_text(encoding="utf-8")
    faint = text.replace("--soft: #566271", "--soft: #9aa3ad")
    assert faint != text
    assert any("color-contrast" in each for each in serious(tab, written(faint)))
