"""Every page has a place in the site, and its links lead somewhere, there and in the checkout."""

from __future__ import annotations

import posixpath
import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import pytest

from docs.site.building import HERE
from docs.site.python_pages import home, references
from docs.site.staging import (
    CODE,
    LINK,
    MADE,
    ROOT,
    Sources,
    anchor_of,
    outside_code,
    pages,
    relinked,
    section,
    sources,
)

WRITTEN = sources()
SITE = pages()


def navigation() -> list[str]:
    """The pages of the navigation, in its order."""
    config = tomllib.loads((HERE / "zensical.toml").read_text(encoding="utf-8"))
    return list(leaves(config["project"]["nav"]))


def leaves(entries: list[Any]) -> Iterator[str]:
    for entry in entries:
        if isinstance(entry, str):
            yield entry
        else:
            (below,) = entry.values()
            yield from [below] if isinstance(below, str) else leaves(below)


def test_every_page_stands_in_the_navigation_once() -> None:
    assert sorted(navigation()) == sorted(SITE)


def test_every_page_begins_with_its_title() -> None:
    assert not [path for path, page in WRITTEN.text.items() if not page.startswith("# ")]


def anchors(page: str) -> set[str]:
    prose = re.sub(r"^```.*?^```", "", page, flags=re.DOTALL | re.MULTILINE)
    titles = re.findall(r"^#+ (.+)$", prose, re.MULTILINE)
    return {anchor_of(title.replace("`", "")) for title in titles}


def dead_links(text: Mapping[str, str]) -> Iterator[str]:
    """Of the checkout; anchors that are made with the site are left to the site's own check."""
    for path, page in text.items():
        for _, target in LINK.findall(CODE.sub("", page)):
            file, _, anchor = target.partition("#")
            there = posixpath.normpath(posixpath.join(posixpath.dirname(path), file))
            there = there if file else path
            if ":" in target:
                continue
            if there not in text and not (ROOT / there).exists():
                yield f"{path}: {target}: there is no {there}"
            elif anchor and not MADE.search(text[there]) and anchor not in anchors(text[there]):
                yield f"{path}: {target}: no such heading"


def test_every_link_leads_somewhere() -> None:
    assert not list(dead_links(WRITTEN.text))


def test_dead_links_are_seen() -> None:
    page = "# A\n[x](nowhere.md) [y](#b) [z](#a) `[in code](none.md)` [w](https://example.org)\n"
    faults = list(dead_links({"docs/a.md": page}))
    assert faults == [
        "docs/a.md: nowhere.md: there is no docs/nowhere.md",
        "docs/a.md: #b: no such heading",
    ]


def test_every_name_of_code_that_a_page_refers_to_is_there_and_public() -> None:
    names = {name for page in WRITTEN.text.values() for name in references(page)}
    assert not sorted(name for name in names if not home(name) or "._" in name)


def test_names_of_code_are_found_in_both_ways_of_writing() -> None:
    page = "[solve][analytic.kinematics.solve], [analytic.dyads.plane][], [`models.scene.Scene`][]"
    assert references(page) == {
        "analytic.kinematics.solve",
        "analytic.dyads.plane",
        "models.scene.Scene",
    }
    assert home("analytic.kinematics.solve") == "analytic.kinematics"
    assert home("models.motion.State.point_velocities") == home("models.motion.no_such") == ""


@pytest.mark.parametrize(
    ("link", "path", "place", "sited"),
    [
        ("[a](docs/free.md#b)", "README.md", "tour.md", "[a](free.md#b)"),
        ("[a](#scenes)", "README.md", "tour.md", "[a](reference/scenes.md)"),
        ("[a](#speed)", "README.md", "tour.md", "[a](#speed)"),
        ("[a](../README.md)", "docs/free.md", "free.md", "[a](tour.md)"),
        ("[a](../README.md#scenes)", "docs/free.md", "free.md", "[a](reference/scenes.md)"),
        ("[a](../../README.md#scenes)", "docs/reference/scenes.md", "reference/scenes.md", "a"),
        ("[a](../examples/engine)", "docs/free.md", "free.md", "a"),
        ("[a](nowhere.md)", "docs/free.md", "free.md", "[a](nowhere.md)"),
        ("`[a](docs/free.md)`", "README.md", "tour.md", "`[a](docs/free.md)`"),
        ("![a](a.svg)", "docs/free.md", "free.md", "![a](a.svg)"),
    ],
)
def test_links_are_as_the_site_has_its_places(link: str, path: str, place: str, sited: str) -> None:
    text = {"README.md": "", "docs/free.md": "", "docs/reference/scenes.md": ""}
    written = Sources(text, {"scenes": "reference/scenes.md"})
    assert relinked(link, path, place, written) == sited


def test_a_section_of_the_readme_stands_on_one_page() -> None:
    assert "my-slider-crank" in SITE["reference/scenes.md"]
    assert "my-slider-crank" not in SITE["tour.md"]
    assert "\n## Hard cases\n" in SITE["tour.md"]
    with pytest.raises(ValueError, match="no section 'Never'"):
        section(WRITTEN.text["README.md"], "Never")


def test_what_is_made_is_on_its_page() -> None:
    assert not [place for place, page in SITE.items() if MADE.search(page)]
    assert "## crankcheck verify" in SITE["reference/commands.md"]
    assert "::: crankcheck.solve" in SITE["reference/python.md"]
    assert "[analytic.dyads](analytic/dyads.md)" in SITE["reference/theory-code.md"]


def test_code_is_left_as_it_is() -> None:
    page = "a `a` a\n\n```console\n$ a\n```\n\n- b\n\n  ```text\n  a\n  ```\n"
    assert outside_code(page, lambda prose: prose.replace("a", "A")) == page.replace(
        "a `a` a", "A `a` A"
    )
