"""The pages of docs are true: their examples run from top to bottom, and every name of the face is
shown."""

import re
import shutil
from pathlib import Path

import pytest

import crankcheck
from crankcheck import engine, testing
from tests.worlds.pages import IN_PARTS, blocks, faults_of, scripts
from tests.worlds.tiers import few

DOCS = Path(__file__).parents[1] / "docs"
PAGES = {
    path.relative_to(DOCS).with_suffix("").as_posix(): path.read_text(encoding="utf-8")
    for path in sorted(DOCS.rglob("*.md"))
}
EXAMPLE = re.compile("^```(console|python)", re.M)
WITH_EXAMPLES = [
    name for name, page in PAGES.items() if EXAMPLE.search(page) and name not in IN_PARTS
]
(ENGINES,) = (page for page in PAGES.values() if "`examples/engine/penalty_engine.py` is" in page)
MADE = {"forces": "figs", "elastic": "figs", "how-to/own-model": "out"}
"""Folders that a page has made, and names all files of."""
SHORT = ("index",)
"""Pages whose commands take some tenths of a second."""


@pytest.mark.parametrize(
    "name", few(WITH_EXAMPLES, SHORT, "studies of seconds each; `make docs` runs them too")
)
def test_what_a_page_shows_is_what_is_printed(name: str, tmp_path: Path) -> None:
    """All that stands on pages: of some 100 commands nothing else says that they print it."""
    page = PAGES[name]
    if "$ patch " in page and shutil.which("patch") is None:
        pytest.skip("no patch: apt-get install patch")
    assert not faults_of(page, tmp_path)
    if folder := MADE.get(name):
        names = set(re.findall(r"`([^`\n]+)`", page))
        made = list((tmp_path / folder).iterdir())
        assert made
        assert not [path for path in made if not {path.name, path.stem} & names]


def words_of_code(page: str) -> set[str]:
    """Words between backticks, but for those of blocks."""
    prose = re.sub(r"```.*?```", "", page, flags=re.DOTALL)
    return set(re.findall(r"\w+", " ".join(re.findall(r"`[^`]+`", prose))))


def test_every_public_name_stands_on_its_page_and_examples_show_what_they_print() -> None:
    page = PAGES["python"]
    examples = re.findall(r"\w+", " ".join(blocks(page, "python")))
    assert not {*crankcheck.__all__, *testing.__all__} - words_of_code(page) - set(examples)
    assert len(scripts(page)) >= 10
    assert all(shown is not None for _, shown in scripts(page))
    assert not set(engine.__all__) - words_of_code(ENGINES)
