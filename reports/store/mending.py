"""Make a damaged store ready to be filled again: what is damaged is moved out of the way."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from itertools import count
from pathlib import Path

from models.errors import CrankcheckError
from reports.output.write import write
from reports.store.damage import Damage, indented
from reports.store.examine import HANGING, STOPPED, Examined
from reports.store.manifest import MANIFEST
from reports.store.part import part_bytes
from reports.store.schema import DAMAGED, TABLES


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
        moved += _keep_what_counts(folder, found, table, name, aside)
    moved += [_set_aside(folder, path) for path in aside]
    told = [each.line for each in found.damage if _worth_telling(each)]
    if moved:
        told.append(f"moved to {folder / DAMAGED}: {', '.join(moved)}")
    if any(each.path == MANIFEST and each.cure == "sweep" for each in found.damage):
        told.append(f"{MANIFEST} is made again as far as the cells tell, with a note in it")
    return [f"{folder}: damaged", *indented(told)] if told else []


def _keep_what_counts(
    folder: Path, found: Examined, table: str, name: str, aside: Collection[str]
) -> list[str]:
    """Write the rows of a part that count as a part of their own, then move it aside; gives its
    new names. A cell is there twice in between, which readers know, and at no moment not at all:
    its cells are written last and moved first, as they are what says that a part is whole."""
    tables = (*HANGING, table) if table == "cells" else (table,)
    parts = {t: found.folders[t].parts for t in tables}
    chosen = [t for t in tables if name in parts[t] and f"{t}/{name}" not in aside]
    new = _free_name(folder, name)
    for each in chosen:
        rows = found.rows(each, name)
        if rows.num_rows:
            write(folder / each / new, part_bytes(rows))
    return [_set_aside(folder, f"{each}/{name}") for each in reversed(chosen)]


def _free_name(folder: Path, name: str) -> str:
    """A name for a part in place of another, which no table has yet: the next free count."""
    stem, _, number = name.removesuffix(".parquet").rpartition("-")
    names = (f"{stem}-{free}.parquet" for free in count(int(number) + 1))
    return next(n for n in names if not any(os.path.lexists(folder / t / n) for t in TABLES))


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
