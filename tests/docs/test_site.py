"""The whole site is built, and read in a browser from files with the network off."""

import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, TimeoutError, sync_playwright

from docs.site.building import build
from docs.site.staging import pages
from tests.reports.page.conftest import FLAGS, PHONE, WIDE, chromium
from tests.worlds.tiers import slow

pytestmark = slow("the site is built twice and read in a browser; `make docs` builds it as well")
SIDEWAYS = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Some 12 s, most of them for the references; the examples are tried by tests/test_docs.py."""
    folder = tmp_path_factory.mktemp("docs") / "site"
    assert build(folder, examples=False) == []
    return folder


def test_each_page_is_there(site: Path) -> None:
    built = {path.relative_to(site).with_suffix("").as_posix() for path in site.rglob("*.html")}
    assert built == {"404", *(place.removesuffix(".md") for place in pages())}


def test_a_site_with_a_fault_is_not_built(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    faulty = {"index.md": "# A\n\n[b](b.md) [c][analytic.none]\n"}
    monkeypatch.setattr("docs.site.building.pages", lambda: faulty)
    before = (site / "index.html").read_bytes()
    (fault,) = build(site, examples=False)
    parts = ("index.md", "page does not exist", "unresolved autoref")
    assert [part for part in parts if part not in fault] == []
    assert "Traceback" not in fault
    assert (site / "index.html").read_bytes() == before


def test_it_reads_in_a_browser_without_a_network(site: Path) -> None:
    """In a thread of its own, as other tests of this process may have a browser open."""
    path = chromium()
    with ThreadPoolExecutor(1) as thread:
        faults = thread.submit(faults_in_browser, path, site).result()
    assert not faults


def faults_in_browser(path: str, site: Path) -> list[str]:
    """What pages ask of the network, or say is wrong; pages that scroll sideways; and a search that
    does not find."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=list(FLAGS))
        wide = browser.new_context(offline=True, viewport=WIDE, color_scheme="light")
        phone = browser.new_context(offline=True, viewport=PHONE, color_scheme="dark")
        found = [*visited(wide, site), *visited(phone, site), *sought(wide, site)]
        browser.close()
    return found


def visited(context: BrowserContext, site: Path) -> list[str]:
    faults: list[str] = []
    page = context.new_page()
    page.on("request", lambda one: None if one.url[:5] == "file:" else faults.append(one.url))
    page.on("pageerror", lambda error: faults.append(str(error)))
    for place in sorted(site.rglob("*.html")):
        if place.name == "404.html":  # is served anywhere, with addresses to match
            continue
        page.goto(place.as_uri())
        if (beside := page.evaluate(SIDEWAYS)) > 0:
            faults.append(f"{place.relative_to(site)} scrolls {beside} px sideways")
    return faults


def sought(context: BrowserContext, site: Path) -> list[str]:
    """A word that the first page has not: shown as soon as the search has found it."""
    page = context.new_page()
    page.goto((site / "index.html").as_uri())
    page.keyboard.press("Control+k")
    page.keyboard.type("coriolis")
    try:
        page.get_by_text(re.compile("oriolis")).first.wait_for(timeout=20_000)
    except TimeoutError as late:
        return [f"the search finds nothing of Coriolis: {late}"]
    typed = page.get_by_placeholder("Search").input_value()
    return [] if typed == "coriolis" else [f"the search keeps {typed!r} of coriolis"]
