"""One file of a table: written with its format and a seal, so that no byte of it changes unseen.

Checksums of pages, which Parquet has, leave out its headers: of 8000 bits turned over in a part of
cells, 348 gave other columns or other numbers without a word. So the whole file is sealed: its
hash stands in it, and is taken with zeros in its place. They are written all the same, for others.
"""

from __future__ import annotations

import hashlib
import io
import stat
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # as above

from reports.output.provenance import crankcheck_version
from reports.store.schema import FORMAT, typed

MAGIC = b"PAR1"
SEAL = b"crankcheck-seal:"
EMPTY = b"0" * 64
VERSION, FORMAT_KEY, SEAL_KEY = "crankcheck.version", "crankcheck.format", "crankcheck.seal"
EAGER = ("cells", "timings")
"""Tables that every reader needs whole."""


class UnreadableError(Exception):
    """A file of a store that can not be read; its text says what is wrong with it."""


class OtherFormatError(UnreadableError):
    """A file that is whole, and of a format that is not read here."""

    def __init__(self, found: object, writer: object) -> None:
        super().__init__(
            f"format {found}, written by crankcheck {writer}; this is crankcheck "
            f"{crankcheck_version()}, which reads format {FORMAT}"
        )


@dataclass(frozen=True)
class Part:
    """A part of a table that can be read; one that is not ``sealed`` may have changed unseen."""

    table: str
    name: str
    sealed: bool
    file: pq.ParquetFile

    @cached_property
    def content(self) -> pa.Table:
        """All of it."""
        return typed(self.file.read(use_threads=False), self.table)

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """The key of the cell that each row is of."""
        found = "content" in vars(self)
        table = self.content if found else self.file.read(["key"], use_threads=False)
        return tuple(table.column("key").to_pylist())


def part_bytes(content: pa.Table) -> bytes:
    """A table as the bytes of a sealed file."""
    buffer = io.BytesIO()
    with pq.ParquetWriter(
        buffer, content.schema, compression="zstd", write_page_checksum=True
    ) as writer:
        writer.write_table(content)
        writer.add_key_value_metadata(
            {
                FORMAT_KEY: str(FORMAT),
                VERSION: crankcheck_version(),
                SEAL_KEY: (SEAL + EMPTY).decode(),
            }
        )
    raw = buffer.getvalue()
    return _with_seal(raw, _hash(raw))


def open_part(path: Path, table: str) -> Part:
    """A part of a table, as far as it must be read to be trusted.

    Raises
    ------
    UnreadableError
        Not to be read, not Parquet, not as it was written, another table or another format.
    """
    raw = regular_bytes(path)
    if not raw:
        raise UnreadableError("empty")
    if not raw.startswith(MAGIC):
        raise UnreadableError("no Parquet file")
    if not raw.endswith(MAGIC):
        raise UnreadableError("cut short")
    seal = _seal(raw)
    if seal is not None and seal != _hash(_with_seal(raw, EMPTY)):
        raise UnreadableError("not as it was written: its checksum differs")
    try:
        file = pq.ParquetFile(pa.BufferReader(raw), page_checksum_verification=seal is None)
        known = file.metadata.metadata or {}
        found = known.get(FORMAT_KEY.encode(), str(FORMAT).encode())
        if found != str(FORMAT).encode():
            writer = known.get(VERSION.encode(), b"(unknown)")
            raise OtherFormatError(_shown(found), _shown(writer))
        part = Part(table, path.name, seal is not None, file)
        if table in EAGER or seal is None:
            _ = part.content
        _ = part.keys
    except (pa.ArrowException, OSError, ValueError, MemoryError, KeyError) as error:
        first = " ".join(str(error).split())[:120]
        raise UnreadableError(f"no part of the table {table} ({first})") from None
    return part


def regular_bytes(path: Path) -> bytes:
    """What stands in a file. Raises UnreadableError for what is no file, or may not be read."""
    try:
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):  # opening a pipe would wait for ever
            raise UnreadableError("a folder" if stat.S_ISDIR(mode) else "no plain file")
        return path.read_bytes()
    except FileNotFoundError:
        raise UnreadableError("not there") from None
    except OSError as error:
        raise UnreadableError(f"can not be read: {error.strerror or error}") from None


def _shown(value: bytes) -> str:
    return value.decode(errors="replace")[:40]


def _seal(raw: bytes) -> bytes | None:
    """The seal of a file, None where it has none."""
    at = raw.rfind(SEAL)
    return None if at < 0 else raw[at + len(SEAL) :][: len(EMPTY)]


def _with_seal(raw: bytes, seal: bytes) -> bytes:
    """A file that has a seal, with another one in its place."""
    at = raw.rfind(SEAL) + len(SEAL)
    return raw[:at] + seal + raw[at + len(seal) :]


def _hash(raw: bytes) -> bytes:
    return hashlib.sha256(raw).hexdigest().encode()
