"""The examples of pages, run; and the figures that they draw, put where the pages show them.

Each page has a folder of its own, so that two may draw a `polygon.svg`.
"""

from __future__ import annotations

import os
import posixpath
import re
import shutil
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from docs.site.staging import outside_code
from tests.worlds.pages import faults_of

PICTURE = re.compile(r"(!\[[^\]]*\]\()([^)\s:]+)(\))")
NOT_DRAWN = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 297 40" width="297">'
    '<text x="8" y="24" font-size="12">drawn by the command above</text></svg>'
)


def run_examples(pages: Mapping[str, str], folder: Path) -> dict[str, str]:
    """What pages show otherwise than it is, by page; their files are left in folders of their own
    in ``folder``. Two pages at a time, as most of it waits for the start of commands."""
    with_examples = {place: page for place, page in pages.items() if "```" in page}
    folders = [_folder(folder, place) for place in with_examples]
    with ProcessPoolExecutor(min(2, os.cpu_count() or 1)) as processes:
        found = processes.map(faults_of, with_examples.values(), folders)
        return {place: each for place, each in zip(with_examples, found, strict=True) if each}


def _folder(folder: Path, place: str) -> Path:
    there = folder / place.removesuffix(".md")
    there.mkdir(parents=True, exist_ok=True)
    return there


def with_figures(place: str, page: str, made: Path | None, site: Path) -> tuple[str, list[str]]:
    """The page with its figures copied from the folder ``made`` of its examples to a folder beside
    it in ``site``, each a link to itself, as sheets are larger than a page; and the figures that no
    example has drawn. None: all are stood in for."""
    stem = place.removesuffix(".md")
    missing: list[str] = []

    def shown(found: re.Match[str]) -> str:
        name = found[2]
        to = site / stem / name
        to.parent.mkdir(parents=True, exist_ok=True)
        if made is None:
            to.write_text(NOT_DRAWN, encoding="utf-8")
        elif (made / stem / name).is_file():
            shutil.copyfile(made / stem / name, to)
        else:
            missing.append(name)
        there = f"{posixpath.basename(stem)}/{name}"
        return f"[{found[1]}{there}{found[3]}]({there})"

    return outside_code(page, lambda prose: PICTURE.sub(shown, prose)), missing
