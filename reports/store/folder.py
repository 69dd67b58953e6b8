"""The files of a store: parts of its tables, their rows that count, and its lock.

One sweep at a time writes to a store, and a reader can see whether one does. A reader sees it by
taking the lock for a moment, so each side has patience: a sweep waits longer for it than any reader
holds it, and a reader longer than another reader does.
"""

import hashlib
import io
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # as above
from filelock import FileLock, Timeout

from models.errors import CrankcheckError
from models.files.inputs import UnreadableError, regular_bytes
from reports.output.write import write
from reports.store.manifest import LOCK, NESTED, TABLES

NAME = re.compile(r"(cells|timings)-(\d{20})-(\d+)-([0-9a-f]{16})\.parquet")
"""Table, time [ns], number of rows, and seal."""
MAGIC = b"PAR1"
MOST_BYTES = 1_000_000_000
"""Most bytes of a part: a sweep writes the cells of a second or so, a hundredth of it."""


@dataclass(frozen=True)
class TablePart:
    """A file of a table that is as it was written. Its name holds the table, the time of writing,
    the number of rows, and the hash of its bytes, so that no byte of it changes unseen, and the
    rows lost with it are known."""

    path: Path
    file: pq.ParquetFile

    @cached_property
    def rows(self) -> pa.Table:
        """All columns but those that hold rows of their own."""
        names = [name for name in self.file.schema_arrow.names if name not in NESTED]
        return self.file.read(names, use_threads=False)

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """Key of the cell of each row."""
        return tuple(self.rows.column("key").to_pylist())

    def nested(self, column: str) -> pa.Table:
        """Return the rows of their own that a column holds, beside the keys of the cells."""
        return self.file.read(["key", column], use_threads=False)

    def write_again(self, staying: Sequence[bool]) -> None:
        """Write the rows that stay as a part that is to replace this one; a nanosecond later, so
        that its rows count as soon as they are there."""
        if any(staying):
            rows = self.file.read(use_threads=False).filter(pa.array(staying))
            table, time_ns, *_ = self.path.name.split("-")
            write_part(self.path.parent, table, rows, int(time_ns) + 1)


def rows_in(name: str) -> int:
    """Return the number of rows that the part of that name was written with."""
    return int(name.split("-")[2])


def write_part(place: Path, table: str, rows: pa.Table, time_ns: int) -> None:
    """Write rows of a table into its folder."""
    buffer = io.BytesIO()
    pq.write_table(rows, buffer, compression="zstd")
    raw = buffer.getvalue()
    write(place / f"{table}-{time_ns:020d}-{rows.num_rows}-{_seal(raw)}.parquet", raw)


def open_part(path: Path) -> TablePart:
    """Return the part in a file. Raises UnreadableError for one that is not as it was written."""
    raw = regular_bytes(path, MOST_BYTES)
    if not path.stem.endswith(_seal(raw)):
        whole = raw.endswith(MAGIC)
        raise UnreadableError(
            "changed since it was written: its checksum differs" * whole or "cut short"
        )
    return TablePart(path, pq.ParquetFile(pa.BufferReader(raw)))


def _seal(raw: bytes) -> str:
    """Return the hash of the bytes of a file: 64 bits are enough against chance."""
    return hashlib.sha256(raw).hexdigest()[:16]


@dataclass(frozen=True)
class Folder:
    """A table in its folder: readable parts, unreadable ones, and files that are not of the store.

    ``fault`` is the fault of the folder itself, empty where it can be looked through.
    """

    parts: Mapping[str, TablePart]
    faults: Mapping[str, UnreadableError]
    foreign: tuple[str, ...] = ()
    fault: str = ""

    @cached_property
    def last(self) -> Mapping[str, list[bool]]:
        """Flags of the rows of each part that count: of several of a cell the last one written."""
        last = {
            key: (name, at) for name, part in self.parts.items() for at, key in enumerate(part.keys)
        }
        return {
            name: [last[key] == (name, at) for at, key in enumerate(part.keys)]
            for name, part in self.parts.items()
        }


def has_parts(folder: Path) -> bool:
    """True if there is any part of a store, whole or not."""
    return any(paths_of(folder, name) for name in TABLES)


def paths_of(folder: Path, table: str) -> list[Path]:
    """Return the parts of a table, in the order of writing; none where there is no folder."""
    try:
        return sorted(path for path in (folder / table).iterdir() if is_part(path.name, table))
    except OSError:
        return []


def is_part(name: str, table: str) -> bool:
    """True if the name of a file is one of a part of a table."""
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
    """True if a file is being written, or was when its sweep was killed."""
    return name.startswith(".") and name.endswith(".tmp")


SWEEP_S, READER_S = 0.5, 0.05
"""Time that each side tries; a reader holds the lock for less than a millisecond."""
POLL_S = 0.01


def locked(folder: Path) -> FileLock:
    """Return the lock of a store, taken for a sweep into a folder that is there. Raises
    CrankcheckError where another sweep has it, or it is no file that can be locked."""
    lock = FileLock(folder / LOCK, timeout=SWEEP_S)
    try:
        lock.acquire(poll_interval=POLL_S)
    except Timeout:
        raise CrankcheckError(
            f"-o {folder}: another sweep writes there now; wait for it, or choose another"
        ) from None
    except OSError as error:
        raise CrankcheckError(
            f"-o {folder}: {LOCK} can not be locked: {error.strerror or error}; remove it, or "
            "choose another place"
        ) from None
    return lock


def is_written(folder: Path) -> bool:
    """True if a sweep writes to a store now; False where its lock can not be tried, as without the
    right to write there. Makes no file."""
    if not os.path.lexists(folder / LOCK):
        return False
    lock = FileLock(folder / LOCK, timeout=READER_S)
    try:
        lock.acquire(poll_interval=POLL_S)
    except Timeout:
        return True
    except OSError:
        return False
    lock.release()
    return False
