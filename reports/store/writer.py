"""Add to a store: parts written aside and renamed, a lock against two sweeps at once."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from reports.describe.frame import motion_frame
from reports.judge.frames import parquet
from reports.output.write import check_folder, write
from reports.store.examine import examine
from reports.store.folder import has_parts, paths_of
from reports.store.lock import locked
from reports.store.manifest import MANIFEST, Manifest, read_manifest
from reports.store.mending import mend, refuse_other_format
from reports.store.part import UnreadableError, open_part, part_bytes
from reports.store.rebuilding import digests
from reports.store.schema import LOCK, TABLES, table

EVERY_S = 1.0
"""What is lost when the process is killed is the work of so many seconds, at most."""
Row = Mapping[str, object]


class Writer:
    """A store that is open for adding; to be used as a context, which writes the rest at its end.

    What was damaged in it is mended at once, as ``mended`` says; ``bare`` are the keys of cells
    that are whole, and have lost their errors or their trace.

    Raises
    ------
    CrankcheckError
        A folder that is no store, is not to be written, or that another sweep writes to.
    """

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        check_folder(folder, "-o")
        self.folder = folder
        self.bare: frozenset[str] = frozenset()
        self.mended: list[str] = []
        self._waiting: dict[str, list[Row]] = {name: [] for name in TABLES}
        self._written = time.monotonic()
        self._count = 0
        self._manifest = ""
        _refuse_other(folder)
        _create(folder, ("",))
        self._lock = locked(folder)
        try:
            self._open(manifest)
        except BaseException:
            self._lock.release()
            raise

    def _open(self, later: Manifest) -> None:
        """Mend what is there, and write in the manifest what is to come, unless that is nothing
        new: then as soon as there is something to write."""
        known, cells, lost = Manifest(), None, False
        if not _is_new(self.folder):
            found = examine(self.folder)
            refuse_other_format(self.folder, found)
            self.mended, self.bare = mend(self.folder, found), found.bare
            known, cells = found.manifest, found.table("cells")
            lost = any(each.path == MANIFEST and each.hides for each in found.damage)
        joined = known.joined(later, self.folder, digests(cells)).text()
        _create(self.folder, TABLES)
        self._drop_unfinished()
        if known.covers(later) and not lost:
            self._manifest = joined
        else:
            write(self.folder / MANIFEST, joined)

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
            for path in paths_of(self.folder, each):
                content = open_part(path, each).content
                kept = content.filter([k not in keys for k in content.column("key").to_pylist()])
                if kept.num_rows == 0:
                    path.unlink()
                elif kept.num_rows < content.num_rows:
                    write(path, part_bytes(kept))

    def flush(self) -> None:
        """Write what waits, the cells last: they are what says that a part is whole."""
        self._written = time.monotonic()
        name = f"part-{time.time_ns():020d}-{os.getpid()}-{self._count}.parquet"
        self._count += 1
        for each in ("errors", "traces", "cells", "timings"):
            rows = self._waiting[each]
            if rows:
                self._write_manifest()
                write(self.folder / each / name, part_bytes(table(rows)))
                rows.clear()

    def _write_manifest(self) -> None:
        """Write the manifest that waited for the first thing to be kept."""
        if self._manifest:
            write(self.folder / MANIFEST, self._manifest)
            self._manifest = ""

    def _flush_in_time(self) -> None:
        if time.monotonic() - self._written >= EVERY_S:
            self.flush()

    def _drop_unfinished(self) -> None:
        """Remove the files aside that a killed sweep left."""
        for aside in (*self.folder.glob(".*.tmp"), *self.folder.glob("*/.*.tmp")):
            aside.unlink(missing_ok=True)


def _is_new(folder: Path) -> bool:
    """Whether there is nothing of a store yet."""
    return not (os.path.lexists(folder / MANIFEST) or has_parts(folder))


def _refuse_other(folder: Path) -> None:
    """Refuse a folder that holds something else than a store, or a file of that name."""
    if not folder.is_dir() or has_parts(folder):
        return
    try:
        read_manifest(folder)
        return
    except UnreadableError as error:
        why = f"no {MANIFEST}" if _is_new(folder) else f"a {MANIFEST} that is no store's ({error})"
    found = sorted(path.name for path in folder.iterdir() if not _begun(path))
    if found:
        raise CrankcheckError(
            f"-o {folder}: holds {found[0]} and {why}, so it is no store of a sweep; "
            "name a new or an empty folder"
        )


def _begun(path: Path) -> bool:
    """Whether it is what a sweep makes first: a lock, and folders with nothing in them."""
    return path.name == LOCK or (path.name in TABLES and path.is_dir() and not any(path.iterdir()))


def _create(folder: Path, names: Iterable[str]) -> None:
    try:
        for name in names:
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CrankcheckError(
            f"-o {folder}: {error.strerror or error}; choose another place"
        ) from None
