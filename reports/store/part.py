"""One file of a table: a part. Its name tells the table, the time of writing, how many rows it has,
and the hash of its bytes, so that no byte of it changes unseen, and what is lost with it is known.
"""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # as above

from models.files.inputs import UnreadableError, regular_bytes
from reports.output.write import write
from reports.store.schema import NESTED

NAME = re.compile(r"(cells|timings)-(\d{20})-(\d+)-([0-9a-f]{16})\.parquet")
"""Table, time [ns], number of rows, and seal."""
MAGIC = b"PAR1"
MOST_BYTES = 1_000_000_000
"""A sweep writes what has come in a second or so, a hundredth of it."""


@dataclass(frozen=True)
class Part:
    """A part that is as it was written."""

    path: Path
    file: pq.ParquetFile

    @cached_property
    def rows(self) -> pa.Table:
        """All of it but the columns that hold rows of their own."""
        names = [name for name in self.file.schema_arrow.names if name not in NESTED]
        return self.file.read(names, use_threads=False)

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """The key of the cell that each row is of."""
        return tuple(self.rows.column("key").to_pylist())

    def nested(self, column: str) -> pa.Table:
        """The rows of their own that a column holds, beside the keys of the cells."""
        return self.file.read(["key", column], use_threads=False)

    def write_again(self, staying: Sequence[bool]) -> None:
        """Write the rows that stay as a part that is to take the place of this one; a nanosecond
        later than it, so that its rows count as soon as they are there."""
        if any(staying):
            rows = self.file.read(use_threads=False).filter(pa.array(staying))
            table, time_ns, *_ = self.path.name.split("-")
            write_part(self.path.parent, table, rows, int(time_ns) + 1)


def rows_in(name: str) -> int:
    """How many rows the part of that name was written with."""
    return int(name.split("-")[2])


def write_part(place: Path, table: str, rows: pa.Table, time_ns: int) -> None:
    """Write rows of a table into its folder."""
    buffer = io.BytesIO()
    pq.write_table(rows, buffer, compression="zstd")
    raw = buffer.getvalue()
    write(place / f"{table}-{time_ns:020d}-{rows.num_rows}-{_seal(raw)}.parquet", raw)


def open_part(path: Path) -> Part:
    """The part in a file. Raises UnreadableError for one that is not as it was written."""
    raw = regular_bytes(path, MOST_BYTES)
    if not path.stem.endswith(_seal(raw)):
        whole = raw.endswith(MAGIC)
        raise UnreadableError("not as it was written: its checksum differs" * whole or "cut short")
    return Part(path, pq.ParquetFile(pa.BufferReader(raw)))


def _seal(raw: bytes) -> str:
    """The hash of the bytes of a file: 64 bits are enough against chance."""
    return hashlib.sha256(raw).hexdigest()[:16]
