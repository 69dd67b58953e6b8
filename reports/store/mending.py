"""Make a damaged store ready to be filled again: what is damaged is moved out of the way."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import count
from pathlib import Path

from models.errors import CrankcheckError
from reports.store.damage import Damage, indented
from reports.store.examine import HANGING, STOPPED, Examined
from reports.store.manifest import MANIFEST
from reports.store.part import part_bytes
from reports.store.schema import DAMAGED
from reports.writing import write


def refuse_other_format(folder: Path, found: Examined) -> None:
    """Leave a store alone that another crankcheck understands better. Raises CrankcheckError."""
    other = [each for each in found.damage if each.cure == "version"]
    if other:
        raise CrankcheckError(
            f"-o {folder}: {other[0].path}: {other[0].what}; name a new folder, or use the "
            "crankcheck that wrote it; nothing was changed"
        )


def mend(folder: Path, found: Examined) -> list[str]:
    """Move what is damaged into the folder ``damaged``, and keep of a cell that is there several
    times the one that counts; gives the lines that say so.

    Raises
    ------
    CrankcheckError
        A file that can not be moved.
    """
    aside = dict.fromkeys(path for each in found.damage for path in each.aside)
    moved = []
    for table, name in found.repeated:
        for each in (table, *HANGING) if table == "cells" else (table,):
            path = f"{each}/{name}"
            if path not in aside and name in found.folders[each].parts:
                rows = found.rows(each, name)
                moved.append(_set_aside(folder, path))
                if rows.num_rows:
                    write(folder / path, part_bytes(rows))
    moved += [_set_aside(folder, path) for path in aside]
    told = [each.line for each in found.damage if _worth_telling(each)]
    if moved:
        told.append(f"moved to {folder / DAMAGED}: {', '.join(moved)}")
    if any(each.path == MANIFEST and each.cure == "sweep" for each in found.damage):
        told.append(f"{MANIFEST} is made again as far as the cells tell, with a note in it")
    return [f"{folder}: damaged", *indented(told)] if told else []


def _worth_telling(damage: Damage) -> bool:
    """Whether a sweep says it: what was stopped goes on without a word."""
    return damage.cure == "sweep" and damage.what != STOPPED


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
    """Names for what is moved, one of which is free: with its table, and a number."""
    stem, dot, ending = path.replace("/", "-").partition(".")
    yield f"{stem}{dot}{ending}"
    for number in count(2):
        yield f"{stem}-{number}{dot}{ending}"
