"""The parts of one table as they lie in its folder, and which of their rows count."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from models.files.inputs import UnreadableError
from reports.store.part import NAME, Part, open_part
from reports.store.schema import TABLES


@dataclass(frozen=True)
class Folder:
    """A table as it lies there: what can be read, what can not, and what is not of the store.

    ``fault`` is what is wrong with the folder itself, empty where it can be looked through.
    """

    parts: Mapping[str, Part]
    faults: Mapping[str, UnreadableError]
    foreign: tuple[str, ...] = ()
    fault: str = ""

    @cached_property
    def last(self) -> Mapping[str, list[bool]]:
        """Which rows of each part count: of several of one cell the one written last."""
        last = {
            key: (name, at) for name, part in self.parts.items() for at, key in enumerate(part.keys)
        }
        return {
            name: [last[key] == (name, at) for at, key in enumerate(part.keys)]
            for name, part in self.parts.items()
        }


def has_parts(folder: Path) -> bool:
    """Whether there is any part of a store, whole or not."""
    return any(paths_of(folder, name) for name in TABLES)


def paths_of(folder: Path, table: str) -> list[Path]:
    """The parts of a table, in the order of writing; none where there is no folder to look at."""
    try:
        return sorted(path for path in (folder / table).iterdir() if is_part(path.name, table))
    except OSError:
        return []


def is_part(name: str, table: str) -> bool:
    """Whether a file is called as a part of a table is, and not as what others put there."""
    named = NAME.fullmatch(name)
    return named is not None and named[1] == table


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
        if not is_part(path.name, table):
            foreign += [] if being_written(path.name) else [f"{table}/{path.name}"]
            continue
        try:
            parts[path.name] = open_part(path)
        except UnreadableError as error:
            if not os.path.lexists(path):  # a sweep has put another part in its place
                return open_folder(place, table)
            faults[path.name] = error
    return Folder(parts, faults, tuple(foreign))


def being_written(name: str) -> bool:
    """Whether a file is one that is being written, or was when its sweep was killed."""
    return name.startswith(".") and name.endswith(".tmp")
