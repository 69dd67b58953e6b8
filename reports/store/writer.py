"""Add to a store: parts written aside and renamed, a lock against two sweeps at once."""

from __future__ import annotations

import io
import os
import time
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from types import TracebackType

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # as above
from filelock import FileLock, Timeout

from models.errors import CrankcheckError
from models.motion import Motion
from reports.frames import parquet
from reports.motion_frame import motion_frame
from reports.series import Array
from reports.store.manifest import MANIFEST, Manifest, read_manifest
from reports.store.schema import TABLES, table
from reports.writing import check_folder, write

LOCK = ".lock"
EVERY_S = 1.0
"""What is lost when the process is killed is the work of so many seconds, at most."""
Row = Mapping[str, object]


class Writer:
    """A store that is open for adding; to be used as a context, which writes the rest at its end.

    Raises
    ------
    CrankcheckError
        A folder that is no store, is not to be written, or that another sweep writes to.
    """

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        check_folder(folder, "-o", (MANIFEST,))
        self.folder = folder
        self._waiting: dict[str, list[Row]] = {name: [] for name in TABLES}
        self._written = time.monotonic()
        self._count = 0
        _refuse_other(folder)
        _create(folder)
        self._lock = FileLock(folder / LOCK, timeout=0)
        try:
            self._lock.acquire()
        except Timeout:
            raise CrankcheckError(
                f"-o {folder}: another sweep writes there now; wait for it, or choose another"
            ) from None
        try:
            write(folder / MANIFEST, read_manifest(folder).joined(manifest, folder).text())
            self._drop_unfinished()
        except BaseException:
            self._lock.release()
            raise

    def __enter__(self) -> Writer:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self.flush()
        finally:
            self._lock.release()

    def cell(self, row: Row, errors: Sequence[Row], series: Mapping[str, object]) -> None:
        """Add a cell with its errors and its trace; on disk within a second or so."""
        key = row["key"]
        self._waiting["cells"].append(row)
        self._waiting["errors"] += [{"key": key} | dict(error) for error in errors]
        self._waiting["traces"] += [
            {"key": key, "series": name, "values": values} for name, values in series.items()
        ]
        self._flush_in_time()

    def timing(self, row: Row) -> None:
        """Add what the steps of a cell cost."""
        self._waiting["timings"].append(row)
        self._flush_in_time()

    def trajectory(self, key: str, motion: Motion, gaps: Mapping[str, Array]) -> None:
        """Keep a whole motion, one file per cell."""
        frame = motion_frame(motion)
        for name, gap in gaps.items():
            frame[f"{name}_gap_m"] = gap
        write(self.folder / "trajectories" / f"{key}.parquet", parquet(frame))

    def forget(self, keys: Collection[str]) -> None:
        """Take cells out of the store with all that hangs on them, part by part, each of which is
        whole at every moment; the cells last, so that one that is there again is there once."""
        if not keys:
            return
        for each in ("errors", "traces", "cells"):
            for path in sorted((self.folder / each).glob("part-*.parquet")):
                content = pq.read_table(path)
                kept = content.filter([k not in keys for k in content.column("key").to_pylist()])
                if kept.num_rows == 0:
                    path.unlink()
                elif kept.num_rows < content.num_rows:
                    write(path, _table_bytes(kept))

    def flush(self) -> None:
        """Write what waits, the cells last: they are what says that a part is whole."""
        self._written = time.monotonic()
        name = f"part-{time.time_ns():020d}-{os.getpid()}-{self._count}.parquet"
        self._count += 1
        for each in ("errors", "traces", "cells", "timings"):
            rows = self._waiting[each]
            if rows:
                write(self.folder / each / name, _table_bytes(table(rows)))
                rows.clear()

    def _flush_in_time(self) -> None:
        if time.monotonic() - self._written >= EVERY_S:
            self.flush()

    def _drop_unfinished(self) -> None:
        """Remove what a killed sweep left: files aside, and parts whose cells were not written."""
        for aside in (*self.folder.glob(".*.tmp"), *self.folder.glob("*/.*.tmp")):
            aside.unlink(missing_ok=True)
        whole = {path.name for path in (self.folder / "cells").glob("part-*.parquet")}
        for each in ("errors", "traces"):
            for path in (self.folder / each).glob("part-*.parquet"):
                if path.name not in whole:
                    path.unlink(missing_ok=True)


def _refuse_other(folder: Path) -> None:
    """Refuse a folder that holds something else than a store."""
    if not folder.is_dir() or (folder / MANIFEST).exists():
        return
    found = sorted(path.name for path in folder.iterdir() if path.name != LOCK)
    if found:
        raise CrankcheckError(
            f"-o {folder}: holds {found[0]} and no {MANIFEST}, so it is no store of a sweep; "
            "name a new or an empty folder"
        )


def _create(folder: Path) -> None:
    try:
        for name in TABLES:
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CrankcheckError(
            f"-o {folder}: {error.strerror or error}; choose another place"
        ) from None


def _table_bytes(content: pa.Table) -> bytes:
    buffer = io.BytesIO()
    pq.write_table(content, buffer, compression="zstd")
    return buffer.getvalue()
