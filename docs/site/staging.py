"""The pages of the site: those of docs/, the README, the list of changes, and what is made from the
code; each with its links as the site has its places.

A page says by a comment, `<!-- made: commands -->`, what is made there, and by
`<!-- README: Scenes -->` which section of the README stands there and not on the README's page.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from docs.site.commands_page import commands_page
from docs.site.python_pages import face_page, others_page, theory_index, theory_page, theory_rooms

ROOT = Path(__file__).parents[2]
BUILDING = "site"
"""The folder in docs/ that has no pages."""
README = "README.md"
PLACES = {README: "tour.md", "CHANGELOG.md": "changes.md"}
"""Where the site has what stands beside docs/."""
MADE = re.compile(r"<!-- made: (\w+) -->")
TAKEN = re.compile(r"<!-- README: (.+?) -->")
CODE = re.compile(r"(^ *```.*?^ *```$|`[^`\n]+`)", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)")


@dataclass(frozen=True)
class Sources:
    """What is written by hand: Markdown by its path in the checkout, and the page that takes a
    section of the README, by the section's anchor."""

    text: Mapping[str, str]
    takers: Mapping[str, str]

    def place_of(self, path: str, anchor: str = "") -> str:
        """Where the site has a file, with the anchor if that is in it."""
        if path == README and anchor in self.takers:
            return self.takers[anchor]
        place = PLACES.get(path) or path.removeprefix("docs/")
        return f"{place}#{anchor}" if anchor else place


def sources() -> Sources:
    """All pages that are in the checkout."""
    files = [
        path
        for path in sorted((ROOT / "docs").rglob("*.md"))
        if path.relative_to(ROOT / "docs").parts[0] != BUILDING
    ]
    text = {
        path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
        for path in [*files, *(ROOT / name for name in PLACES)]
    }
    takers = {
        anchor_of(title): path.removeprefix("docs/")
        for path, page in text.items()
        for title in TAKEN.findall(page)
    }
    return Sources(text, takers)


def pages() -> dict[str, str]:
    """All pages of the site as Markdown, by their places in it."""
    written = sources()
    rooms = theory_rooms(ROOT)
    makers: Mapping[str, Callable[[], str]] = {
        "commands": commands_page,
        "face": face_page,
        "theory": lambda: theory_index(rooms),
        "others": lambda: others_page(written.text),
    }
    by_hand = {
        written.place_of(path): MADE.sub(lambda mark: makers[mark[1]](), _sited(path, written))
        for path in written.text
    }
    return by_hand | {f"reference/analytic/{room}.md": theory_page(room) for room in rooms}


def _sited(path: str, written: Sources) -> str:
    """A page as the site has it: with its links, and with sections of the README or without."""
    readme, page, place = written.text[README], written.text[path], written.place_of(path)
    if path == README:
        for title in (each for other in written.text.values() for each in TAKEN.findall(other)):
            page = page.replace(f"## {title}\n{section(readme, title)}", "")
    page = relinked(page, path, place, written)
    return TAKEN.sub(
        lambda mark: relinked(section(readme, mark[1]), README, place, written).strip(), page
    )


def section(page: str, title: str) -> str:
    """What stands in a section, without its heading. Raises ValueError where there is none."""
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", page, re.DOTALL | re.MULTILINE)
    if found is None:
        raise ValueError(f"README.md has no section {title!r}")
    return found[1]


def anchor_of(title: str) -> str:
    """The anchor of a heading, as GitHub and the site make it."""
    kept = re.sub(r"[^\w\- ]", "", title.strip().lower())
    return kept.replace(" ", "-")


def relinked(page: str, path: str, place: str, written: Sources) -> str:
    """The page at ``path`` with the links that it needs at ``place``: to pages where the site has
    them; what else is in the checkout is named, and no link."""

    def link(found: re.Match[str]) -> str:
        text, target = found.groups()
        if ":" in target:
            return found[0]
        file, _, anchor = target.partition("#")
        there = posixpath.normpath(posixpath.join(posixpath.dirname(path), file)) if file else path
        if there in written.text:
            to, _, anchor = written.place_of(there, anchor).partition("#")
            near = "" if to == place else posixpath.relpath(to, posixpath.dirname(place) or ".")
            to = f"{near}#{anchor}" if anchor else near
            return f"[{text}]({to})" if to else text
        outside = not there.startswith("docs/") and (ROOT / there).exists()
        return text if outside else found[0]

    return outside_code(page, lambda prose: LINK.sub(link, prose))


def outside_code(page: str, change: Callable[[str], str]) -> str:
    """The page with a change made to all that is neither a block nor a span of code."""
    parts = CODE.split(page)
    return "".join(part if at % 2 else change(part) for at, part in enumerate(parts))
