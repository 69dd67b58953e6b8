"""The pages of the site: those of docs/, the list of changes, and what is made from the code; each
with its links as the site has its places.

A page says by a comment, `<!-- made: commands -->`, what is made there.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

from docs.site.commands_page import commands_page
from docs.site.python_pages import face_page, others_page, theory_index, theory_page, theory_rooms

ROOT = Path(__file__).parents[2]
BUILDING = "site"
"""The folder in docs/ that has no pages."""
PLACES = {"CHANGELOG.md": "changes.md"}
"""Where the site has what stands beside docs/."""
MADE = re.compile(r"<!-- made: (\w+) -->")
CODE = re.compile(r"(^ *```.*?^ *```$|`[^`\n]+`)", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)")


def place_of(path: str) -> str:
    """Where the site has a page of the checkout."""
    return PLACES.get(path) or path.removeprefix("docs/")


def sources() -> dict[str, str]:
    """The pages that are written by hand: Markdown by its path in the checkout."""
    files = [
        path
        for path in sorted((ROOT / "docs").rglob("*.md"))
        if path.relative_to(ROOT / "docs").parts[0] != BUILDING
    ]
    return {
        path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
        for path in [*files, *(ROOT / name for name in PLACES)]
    }


def pages() -> dict[str, str]:
    """All pages of the site as Markdown, by their places in it."""
    written = sources()
    rooms = theory_rooms(ROOT)
    makers: Mapping[str, Callable[[], str]] = {
        "commands": commands_page,
        "face": face_page,
        "theory": lambda: theory_index(rooms),
        "others": lambda: others_page(written),
    }
    by_hand = {
        place_of(path): MADE.sub(lambda mark: makers[mark[1]](), relinked(page, path, written))
        for path, page in written.items()
    }
    return by_hand | {f"reference/analytic/{room}.md": theory_page(room) for room in rooms}


def relinked(page: str, path: str, written: Collection[str]) -> str:
    """The page at ``path`` with the links that it needs in the site: to the ``written`` pages where
    the site has them; what else is in the checkout is named, and no link."""
    here = posixpath.dirname(place_of(path)) or "."

    def link(found: re.Match[str]) -> str:
        text, target = found.groups()
        file, mark, anchor = target.partition("#")
        if ":" in target or not file:
            return found[0]
        there = posixpath.normpath(posixpath.join(posixpath.dirname(path), file))
        if there in written:
            return f"[{text}]({posixpath.relpath(place_of(there), here)}{mark}{anchor})"
        outside = not there.startswith("docs/") and (ROOT / there).exists()
        return text if outside else found[0]

    return outside_code(page, lambda prose: LINK.sub(link, prose))


def outside_code(page: str, change: Callable[[str], str]) -> str:
    """The page with a change made to all that is neither a block nor a span of code."""
    parts = CODE.split(page)
    return "".join(part if at % 2 else change(part) for at, part in enumerate(parts))
