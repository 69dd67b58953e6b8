"""Make a damaged store ready to be filled again: what is damaged is moved out of the way."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import count
from pathlib import Path

from models.errors import CrankcheckError
from reports.store.damage import indented
from reports.store.examine import STOPPED, Examined
from reports.store.manifest import MANIFEST
from reports.store.schema import DAMAGED


def mend(folder: Path, store: Examined) -> list[str]:
    """Move what is damaged into the folder ``damaged``, and keep of a cell that is there several
    times the row that counts; gives the lines that say so.

    Such a row is there twice in between, which readers know, and at no moment not at all. Raises
    CrankcheckError for a file that can not be moved.
    """
    for here in store.folders.values():
        for name, part in here.parts.items():
            if not all(here.last[name]):
                part.write_again(here.last[name])
    moved = [_set_aside(folder, each.path) for each in store.damage if each.aside]
    # What was stopped goes on without a word.
    bad = [each for each in store.damage if each.cure == "sweep" and each.what != STOPPED]
    lines = [each.line for each in bad]
    if moved:
        lines.append(f"moved to {folder / DAMAGED}: {', '.join(moved)}")
    if any(each.path == MANIFEST for each in bad):
        lines.append(f"{MANIFEST} is made again, and knows of this sweep alone")
    return [f"{folder}: damaged", *indented(lines)] if lines else []


def _set_aside(folder: Path, path: str) -> str:
    """Move a file or a folder of the store; gives its new name."""
    place = folder / DAMAGED
    try:
        place.mkdir(exist_ok=True)
        name = next(name for name in _names(path) if not os.path.lexists(place / name))
        (folder / path).rename(place / name)
    except OSError as error:
        raise CrankcheckError(
            f"-o {folder}: {path} is damaged, and can not be moved to {place}: "
            f"{error.strerror or error}; move it yourself, or choose another folder"
        ) from None
    return name


def _names(path: str) -> Iterator[str]:
    """Names for what is moved, one of which is free: without its folder, and with a number."""
    stem, dot, ending = path.rpartition("/")[2].partition(".")
    yield f"{stem}{dot}{ending}"
    for number in count(2):
        yield f"{stem}-{number}{dot}{ending}"
