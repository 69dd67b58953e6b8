"""The parts of one table as they lie in its folder, and which of their rows count."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs

from reports.store.part import Part, UnreadableError, open_part
from reports.store.schema import PART, TABLES

Parts = Mapping[str, Part]


@dataclass(frozen=True)
class Folder:
    """A table as it lies there: what can be read, what can not, and what is not of the store.

    ``fault`` is what is wrong with the folder itself, empty where it can be looked through.
    """

    parts: Parts
    faults: Mapping[str, UnreadableError]
    foreign: tuple[str, ...] = ()
    fault: str = ""


def has_parts(folder: Path) -> bool:
    """Whether there is any part of a store, whole or not."""
    return any(paths_of(folder, name) for name in TABLES)


def paths_of(folder: Path, table: str) -> list[Path]:
    """The parts of a table, in the order of writing; none where there is no folder to look at."""
    try:
        return sorted(path for path in (folder / table).iterdir() if PART.fullmatch(path.name))
    except OSError:
        return []


def open_folder(place: Path, table: str) -> Folder:
    """Open every part in the folder of a table."""
    try:
        entries = sorted(place.iterdir())
    except FileNotFoundError:
        return Folder({}, {}, fault="a link to nothing" if place.is_symlink() else "not there")
    except NotADirectoryError:
        return Folder({}, {}, fault="a file in place of a folder")
    except OSError as error:
        return Folder({}, {}, fault=f"can not be read: {error.strerror or error}")
    parts, faults, foreign = {}, {}, []
    for path in entries:
        if not PART.fullmatch(path.name):
            foreign += [] if being_written(path.name) else [f"{table}/{path.name}"]
            continue
        try:
            parts[path.name] = open_part(path, table)
        except UnreadableError as error:
            faults[path.name] = error
    return Folder(parts, faults, tuple(foreign))


def being_written(name: str) -> bool:
    """Whether a file is one that is being written, or was when its sweep was killed."""
    return name.startswith(".") and name.endswith(".tmp")


def owners_of(parts: Parts, beside: Parts) -> dict[str, str]:
    """The part that the row of each key is taken from: the last written one, but rather one that
    has its errors beside it."""
    order = sorted(parts, key=lambda name: (name in beside, name))
    return {key: name for name in order for key in parts[name].keys}


def kept(part: Part, owners: Mapping[str, str]) -> tuple[list[bool], bool]:
    """Which rows of a part count, and whether all do. Of several of one cell the last counts."""
    counting = [owners.get(key) == part.name for key in part.keys]
    if part.table in ("cells", "timings"):
        last = {key: at for at, key in enumerate(part.keys)}
        counting = [fine and last[part.keys[at]] == at for at, fine in enumerate(counting)]
    return counting, all(counting)


def joined(parts: Parts, owners: Mapping[str, str]) -> pa.Table | None:
    found = []
    for part in parts.values():
        counting, whole = kept(part, owners)
        found.append(part.content if whole else part.content.filter(pa.array(counting, pa.bool_())))
    return pa.concat_tables(found, promote_options="permissive") if found else None
