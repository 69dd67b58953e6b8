"""A small real store, its page, and a browser that reads it with the network off."""

import itertools
import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from models.files.reading import load_scene
from reports.output.write import provenance
from reports.page import build
from reports.stability.case import Case, Trial
from reports.stability.grading import graded
from reports.stability.matrix import Matrix
from reports.stability.running import critical
from reports.store.reader import Stored, read_store
from tests.reports.page.hostile import evil
from tests.reports.page.tab import PHONE, WIDE, Tab
from tests.worlds.command_line import crank
from tests.worlds.in_process import in_this_process

STUDY = """
scenes = ["fourbar-lecture-1", "shaper"]
steps_per_turn = [90, 180, 360]
turns = 1
variants = [
  { engine = "mujoco", profile = "as-shipped" },
  { engine = "mujoco", profile = "tuned" },
  { name = "no bias", engine = "pymunk", profile = "as-shipped", settings = { error_bias = 0.0 } },
  { engine = "pymunk", profile = "tuned" },
]
"""
"""Without its bias pymunk comes apart on the shaper."""
LINES = tuple((e, p) for e in ("mujoco", "pymunk") for p in ("as-shipped", "tuned"))
STEPS = (360.0, 90.0, 30.0, 12.0)
BETWEEN = 60.0
"""A value that stands for one that a bisection looked at."""
SCENES = {
    "fourbar-lecture-1": ("Large steps", "Crank-rocker in ever larger steps"),
    "slider-crank-offset": ("Large steps", "Offset slider-crank in ever larger steps"),
    "shaper": ("Heavy slides", "Shaper: a heavy ram on a slotted lever"),
}
Write = Callable[[str], Path]
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
INSTALL = "apt-get install chromium"
OFF = ("gpu", "quic", "background-networking", "component-update", "sync")
FLAGS = ("--no-sandbox", "--no-first-run", *(f"--disable-{each}" for each in OFF))


@pytest.fixture(scope="session")
def small_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of two scenes, four variants and three steps, timed; some of its cells fail."""
    folder = tmp_path_factory.mktemp("store")
    (folder / "study.toml").write_text(STUDY)
    return swept(folder / "out", "--study", folder / "study.toml")


def swept(folder: Path, *asked: object) -> Path:
    """The folder, now the store of a sweep; its pages tell times, good or bad."""
    with in_this_process() as patch:
        patch.setattr("reports.sweep.running.ROUNDS", 2)
        ended = crank("sweep", *asked, "-o", folder, "--jobs", 1)
    assert ended.exit_code == 0, ended.output
    return folder


@pytest.fixture(scope="session")
def small(small_folder: Path) -> Stored:
    return read_store(small_folder)


def part_of(stored: Stored, keep: pd.Series) -> Stored:
    found = replace(stored, cells=stored.cells[keep].reset_index(drop=True))
    vars(found)["_traces"] = stored._traces
    return found


@pytest.fixture(scope="session")
def tiny(small: Stored) -> Stored:
    """One line of it, untimed: three cells of one scene in one engine."""
    cells = small.cells
    line = (cells["scene"] == "fourbar-lecture-1") & (cells["engine"] == "pymunk")
    found = part_of(small, line & (cells["variant"] == "tuned"))
    times = [c for c in cells if c.startswith("us_per_step") or c == "s_per_turn"]
    found.cells[times] = float("nan")
    return found


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory) -> Write:
    def write(text: str) -> Path:
        path = tmp_path_factory.mktemp("page") / "report.html"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture(scope="session")
def small_page(small: Stored, written: Write) -> Path:
    return written(build.page(small))


@pytest.fixture(scope="session")
def evil_page(small: Stored, written: Write) -> Path:
    return written(build.page(evil(small)))


def case_of(name: str) -> Case:
    (group, title), scene = SCENES[name], load_scene(name)
    return Case(
        name=f"{name}-steps", group=group, title=title, source=scene.source,
        truth="The closed form at every instant.",
        expected="follows, with an error that falls with the square of the step",
        parameter="steps in a turn", values=STEPS, labels=tuple(f"{n:g}" for n in STEPS),
        trial=lambda steps: Trial(scene, steps),
    )  # fmt: skip


@pytest.fixture(scope="session")
def matrix() -> Matrix:
    """Three scenes in ever larger steps, in both engines with both profiles."""
    runs, pictures, ends = [], [], []
    cases = [case_of(name) for name in SCENES]
    for case, line in itertools.product(cases, LINES):
        found = [graded(case, *line, steps, draw=True) for steps in (*STEPS, BETWEEN)]
        own = [replace(run, grid=run.value != BETWEEN) for run, _ in found]
        runs += own
        pictures += [picture for _, picture in found if picture is not None]
        ends.append(critical(case, own))
    facts = provenance({"mujoco": "4.0.0", "pymunk": "7.3.1"})
    known = tuple(case.facts() for case in cases)
    return Matrix(facts, known, tuple(runs), tuple(ends), tuple(pictures))


@pytest.fixture(scope="session")
def hard_page(matrix: Matrix, written: Write) -> Path:
    return written(build.stability_page(matrix))


@pytest.fixture(scope="session")
def tiny_page(tiny: Stored, written: Write) -> Path:
    return written(build.page(tiny))


def chromium() -> str:
    """Debian's Chromium; skips where there is none, and fails in CI."""
    for name in BROWSERS:
        if path := shutil.which(name):
            return path
    if os.environ.get("CI"):
        pytest.fail(f"no browser, and this is CI: {INSTALL}")
    pytest.skip(f"no browser: {INSTALL}")


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    path = chromium()
    with sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=path, args=list(FLAGS))
        yield started
        started.close()


@pytest.fixture(scope="session")
def tab(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Tab:
    return Tab.of(browser, tmp_path_factory.mktemp("tab"))


@pytest.fixture
def wide(tab: Tab) -> Iterator[Tab]:
    """The tab on a computer: `open` or `visit` a page in it, which is checked afterwards."""
    yield tab.on(WIDE)
    tab.check()


@pytest.fixture
def phone(tab: Tab) -> Iterator[Tab]:
    yield tab.on(PHONE)
    tab.check()


@pytest.fixture
def page(opened: Tab) -> Page:
    return opened.page
