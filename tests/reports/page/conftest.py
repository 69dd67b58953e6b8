"""A small real store, its page, and a browser that reads it with the network off."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, Request, sync_playwright
from rich.console import Console

from reports.cli.commands import sweep as command
from reports.cli.measuring import SweepRequest
from reports.page.build import page, stability_page
from reports.stability.matrix import Matrix
from reports.store.reader import Stored, read_store
from tests.reports.page import hard_runs
from tests.worlds.in_process import in_this_process

STUDY = """
scenes = ["fourbar-lecture-1", "shaper"]
steps_per_turn = [90, 180, 360]
turns = 1
[[variants]]
engine = "mujoco"
profile = "as-shipped"
[[variants]]
engine = "mujoco"
profile = "tuned"
[[variants]]
name = "no bias"                    # comes apart on the shaper
engine = "pymunk"
profile = "as-shipped"
settings = { error_bias = 0.0 }
[[variants]]
engine = "pymunk"
profile = "tuned"
"""
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
INSTALL = "apt-get install chromium"
FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
WIDE, PHONE = {"width": 1280, "height": 900}, {"width": 390, "height": 844}


@pytest.fixture(scope="session")
def small_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of two scenes, four variants and three steps, timed; some of its cells fail."""
    folder = tmp_path_factory.mktemp("store")
    study = folder / "study.toml"
    study.write_text(STUDY)
    nowhere = Console(file=StringIO())
    with in_this_process() as patch:
        patch.setattr("reports.sweep.running.ROUNDS", 2)  # the pages tell times, good or bad
        command.sweep(SweepRequest(folder / "out", study=study, jobs=1), nowhere, nowhere)
    return folder / "out"


@pytest.fixture(scope="session")
def small(small_folder: Path) -> Stored:
    return read_store(small_folder)


@pytest.fixture(scope="session")
def small_page(small: Stored, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of the small store, as a file."""
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(page(small), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def hard_matrix() -> Matrix:
    """Three scenes in ever larger steps, in both engines with both profiles."""
    return hard_runs.matrix()


@pytest.fixture(scope="session")
def hard_page(hard_matrix: Matrix, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of the hard cases alone, as a file."""
    path = tmp_path_factory.mktemp("hard") / "stability.html"
    path.write_text(stability_page(hard_matrix), encoding="utf-8")
    return path


@dataclass
class Opened:
    """A page in the browser, with all that it said and asked for."""

    page: Page
    said: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    first: object = None

    def watch(self) -> None:
        def on_console(message: ConsoleMessage) -> None:
            self.said.append(f"{message.type}: {message.text}")

        def on_request(request: Request) -> None:
            self.asked.append(request.url)

        self.page.on("console", on_console)
        self.page.on("pageerror", lambda error: self.said.append(f"error: {error}"))
        self.page.on("request", on_request)

    def show(self, section: str) -> None:
        """Scroll to a section and wait for its diagrams."""
        self.page.locator(f"#{section}").scroll_into_view_if_needed()
        for chart in self.page.locator(f"#{section} .chart").all():
            chart.scroll_into_view_if_needed()
            chart.locator(".main-svg").first.wait_for()

    def remember(self) -> None:
        """Note how all choices and switches stand."""
        self.first = self.page.evaluate(STATE)

    def restore(self) -> None:
        """Put all choices and switches back to where they stood."""
        self.page.evaluate(RESTORE, self.first)


STATE = """() => ({
  choices: [...document.querySelectorAll('select')].map(each => [each.id, each.value]),
  boxes: [...document.querySelectorAll('[data-item]')].map(
    each => [each.closest('.legend').id, each.dataset.item, each.checked]),
})"""
RESTORE = """({choices, boxes}) => {
  for (const [id, value] of choices) {
    const each = document.getElementById(id);
    if (each.value !== value) { each.value = value; each.dispatchEvent(new Event('change')); }
  }
  for (const [legend, item, checked] of boxes) {
    const each = document.querySelector(`#${legend} [data-item="${item}"]`);
    if (each.checked !== checked) each.click();
  }
}"""


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


@pytest.fixture(scope="module")
def open_page(browser: Browser) -> Iterator[Callable[..., Opened]]:
    """Opens a file with the network off: ``open_page(path, phone=..., **options)``."""
    contexts = []

    def opened(path: Path, phone: bool = False, **options: object) -> Opened:
        options = {"reduced_motion": "reduce", "viewport": PHONE if phone else WIDE, **options}
        if phone:
            options |= {"has_touch": True, "is_mobile": True}
        context = browser.new_context(offline=True, **options)
        contexts.append(context)
        found = Opened(context.new_page())
        found.watch()
        found.page.goto(path.as_uri())
        found.remember()
        return found

    yield opened
    for context in contexts:
        context.close()
