"""Every page has a place in the site, and its links lead somewhere, there and in the checkout, as
those of the README do; the references are whole: every command with every option, every name of the
face."""

import posixpath
import re
import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import pytest

import crankcheck
from crankcheck import engine, testing
from docs.site import staging
from docs.site.building import HERE
from docs.site.commands_page import commands_page
from docs.site.docstrings import one_by_one
from docs.site.python_pages import face_page, home, others_page, references, theory_rooms
from docs.site.staging import MADE, ROOT, relinked, sources
from tests.worlds.command import COMMAND
from tests.worlds.pages import ran

WRITTEN = sources()
site = cache(staging.pages)
"""Made where it is asked for: all commands are loaded for it."""


def leaves(entries: list[Any]) -> Iterator[str]:
    for entry in entries:
        if isinstance(entry, str):
            yield entry
        else:
            (below,) = entry.values()
            yield from [below] if isinstance(below, str) else leaves(below)


def test_every_page_stands_in_the_navigation_once_and_begins_with_its_title() -> None:
    config = tomllib.loads((HERE / "zensical.toml").read_text(encoding="utf-8"))
    assert sorted(leaves(config["project"]["nav"])) == sorted(site())
    assert not [path for path, page in WRITTEN.items() if not page.startswith("# ")]


def anchors(page: str) -> set[str]:
    """Of the headings, as GitHub and the site make them."""
    prose = re.sub(r"^```.*?^```", "", page, flags=re.DOTALL | re.MULTILINE)
    titles = re.findall(r"^#+ (.+)$", prose, re.MULTILINE)
    kept = (re.sub(r"[^\w\- ]", "", title.strip().lower()) for title in titles)
    return {title.replace(" ", "-") for title in kept}


def dead_links(text: Mapping[str, str]) -> Iterator[str]:
    """Of the checkout; anchors that are made with the site are left to the site's own check."""
    for path, page in text.items():
        for _, target in staging.LINK.findall(staging.CODE.sub("", page)):
            file, _, anchor = target.partition("#")
            there = posixpath.normpath(posixpath.join(posixpath.dirname(path), file))
            there = there if file else path
            if ":" in target:
                continue
            if there not in text and not (ROOT / there).exists():
                yield f"{path}: {target}: there is no {there}"
            elif anchor and not MADE.search(text[there]) and anchor not in anchors(text[there]):
                yield f"{path}: {target}: no such heading"


def test_every_link_leads_somewhere_and_dead_ones_are_seen() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert not list(dead_links({**WRITTEN, "README.md": readme}))
    page = "# A\n[x](nowhere.md) [y](#b) [z](#a) `[in code](none.md)` [w](https://example.org)\n"
    faults = ["nowhere.md: there is no docs/nowhere.md", "#b: no such heading"]
    found = list(dead_links({"docs/a.md": page}))
    assert found == [f"docs/a.md: {fault}" for fault in faults]


def test_every_name_of_code_that_a_page_refers_to_in_either_way_is_there_and_public() -> None:
    named = {name for page in WRITTEN.values() for name in references(page)}
    assert not sorted(name for name in named if not home(name) or "._" in name)
    page = "[solve][analytic.kinematics.solve], [analytic.dyads.plane][], [`models.scene.Scene`][]"
    names = {"analytic.kinematics.solve", "analytic.dyads.plane", "models.scene.Scene"}
    assert references(page) == names
    assert home("analytic.kinematics.solve") == "analytic.kinematics"
    assert home("models.motion.State.point_velocities") == home("models.motion.no_such") == ""


@pytest.mark.parametrize(
    ("link", "path", "sited"),
    [
        ("[a](docs/free.md#b)", "CHANGELOG.md", "[a](free.md#b)"),
        ("[a](../CHANGELOG.md)", "docs/free.md", "[a](changes.md)"),
        ("[a](reference/scenes.md#b)", "docs/free.md", "[a](reference/scenes.md#b)"),
        ("[a](https://example.org)", "docs/free.md", "[a](https://example.org)"),
        ("[a](../README.md#b)", "docs/free.md", "a"),
        ("[a](nowhere.md)", "docs/free.md", "[a](nowhere.md)"),
        ("`[a](docs/free.md)`", "CHANGELOG.md", "`[a](docs/free.md)`"),
        ("![a](a.svg)", "docs/free.md", "![a](a.svg)"),
    ],
)
def test_links_are_as_the_site_has_its_places(link: str, path: str, sited: str) -> None:
    written = {"CHANGELOG.md", "docs/free.md", "docs/reference/scenes.md"}
    assert relinked(link, path, written) == sited


def test_code_is_left_as_it_is_and_what_is_made_is_on_its_page() -> None:
    code = "\n\n```console\n$ a\n```\n\n- b\n\n  ```text\n  a\n  ```\n"
    written = staging.outside_code(f"a `a` a{code}", lambda prose: prose.replace("a", "A"))
    assert written == f"A `a` A{code}"
    assert not [place for place, page in site().items() if MADE.search(page)]
    assert "[analytic.dyads](analytic/dyads.md)" in site()["reference/theory-code.md"]


def test_every_command_stands_there_with_every_option_its_default_and_limits() -> None:
    told = dict(re.findall(r"^## (crankcheck [\w ]+)\n(.*?)(?=^## )", commands_page(), re.S | re.M))
    listed = ran([COMMAND, "--help"], ROOT).stdout
    names = re.findall(r"^│ ([a-z]+) ", listed, re.M)
    assert len(names) > 20
    assert set(names) <= {called.split()[1] for called in told}
    for called in ("crankcheck verify", "crankcheck polygon", "crankcheck engines check"):
        shown = ran([COMMAND, *called.split()[1:], "--help"], ROOT).stdout
        options = set(re.findall(r"(?<![\w-])--[a-z][\w-]+", shown)) - {"--help"}
        assert options <= set(re.findall(r"--[a-z][\w-]+", told[called])), called
    page = commands_page()
    assert "| `--at-deg DEG` | `60.0` | The driver's angle. |" in page
    jobs = "| `--jobs <int range>` | `0` | Processes; 0: one per processor. (`0<=x<=1024`) |"
    assert [part for part in (jobs, r"NAME=1\|-1", "130 interrupted") if part not in page] == []


def test_every_public_name_has_its_entry() -> None:
    entries = set(re.findall(r"^::: (\S+)$", face_page(), re.M))
    faces = {f"crankcheck.{name}" for name in crankcheck.__all__ if name != "__version__"}
    assert faces <= entries
    assert {f"crankcheck.testing.{name}" for name in testing.__all__} <= entries
    for name in engine.__all__:
        assert f"crankcheck.engine.{name}" in entries or f"`{name}`" in face_page()


def test_rooms_of_the_theory_have_pages_and_other_modules_are_shown_where_one_names_them() -> None:
    rooms = theory_rooms(ROOT)
    assert {"dyads", "kinematics", "free"} <= set(rooms)
    assert len(rooms) == len(set(rooms))
    page = others_page({"a.md": "[models.scene.Scene][] and [x][analytic.kinematics.solve]"})
    assert page.startswith("## models.scene\n\n::: models.scene\n")
    assert "analytic" not in page


def test_parameters_told_together_are_told_one_by_one() -> None:
    """So that each has the type and the default of its own."""
    page = "A.\n\nParameters\n----------\na, b\n    As of c.\nd : int\n    D.\n\nAn, end."
    told = one_by_one(page)
    assert "\na\n    As of c.\nb\n    As of c.\nd : int\n    D.\n" in told
    assert told.startswith("A.\n")
    assert told.endswith("\n\nAn, end.")
