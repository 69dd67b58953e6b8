"""Add to a store: parts written aside and renamed, a lock against two sweeps at once."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import count
from pathlib import Path
from types import TracebackType

from models.errors import CrankcheckError
from models.files.inputs import UnreadableError
from reports.describe.free_motion import run_frame
from reports.output.formats import parquet
from reports.output.write import check_folder, refuse_link, write
from reports.store import manifest as manifests
from reports.store.folder import has_parts, locked, open_part, paths_of, write_part
from reports.store.manifest import MANIFEST, TABLES, Manifest
from reports.store.reader import STOPPED, ExaminedStore, examine
from sim.engine import Run

EVERY_S = 1.0
"""Seconds of work that are lost at most when the process is killed."""
Row = Mapping[str, object]


class Writer:
    """A store that is open for adding; to be used as a context, which writes the rest at its end.

    Damage in it is repaired at once, as ``mended`` reports.

    Raises CrankcheckError for a folder that is no store, is not to be written, has links for
    folders, or that another sweep writes to.
    """

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        check_folder(folder, "-o")
        for name in (*TABLES, manifests.TRAJECTORIES, manifests.DAMAGED):
            if (folder / name).exists():  # a link to nothing is damaged, and moved away
                refuse_link(folder / name, "-o")
        self.folder = folder
        self.mended: list[str] = []
        self._waiting: dict[str, list[Row]] = {name: [] for name in TABLES}
        self._written = time.monotonic()
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
        """Repair the store, and add the coming run to the manifest, at once if it adds anything
        new, else with the first write."""
        store = None if _is_new(self.folder) else examine(self.folder)
        cells = store.table("cells") if store else None
        scenes = cells.select(["scene", "scene_digest"]).to_pydict().values() if cells else ()
        digests = set(zip(*scenes, strict=True))
        manifest = store.manifest if store else Manifest()
        joined = manifest.joined(later, self.folder, digests).text()
        if store:
            self.mended = mend(self.folder, store)
        _create(self.folder, TABLES)
        for aside in (*self.folder.glob(".*.tmp"), *self.folder.glob("*/.*.tmp")):
            aside.unlink(missing_ok=True)  # a killed sweep left it
        if manifest.covers(later):
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
        # The names of the cell are in its errors too.
        rows = [{name: each[name] for name in each.keys() - row.keys()} for each in errors]
        trace = [{"series": name, "values": values} for name, values in series.items()]
        self._add("cells", {**row, "errors": rows, "trace": trace})

    def timing(self, row: Row) -> None:
        """Add the cost of the steps of a cell."""
        self._add("timings", row)

    def trajectory(self, key: str, run: Run) -> None:
        """Keep a whole run, one file per cell."""
        write(self.folder / "trajectories" / f"{key}.parquet", parquet(run_frame(run)))

    def forget(self, keys: Collection[str]) -> None:
        """Take cells out of the store; the others are in it at every moment."""
        for path in paths_of(self.folder, "cells") if keys else ():
            part = open_part(path)
            staying = [key not in keys for key in part.keys]
            if not all(staying):
                part.write_again(staying)
                path.unlink()

    def flush(self) -> None:
        """Write the waiting rows."""
        self._written = time.monotonic()
        for name, rows in self._waiting.items():
            if rows:
                if self._manifest:  # it waited for the first thing to be kept
                    write(self.folder / MANIFEST, self._manifest)
                    self._manifest = ""
                write_part(self.folder / name, name, manifests.table(rows), time.time_ns())
                rows.clear()

    def _add(self, table: str, row: Row) -> None:
        self._waiting[table].append(row)
        if time.monotonic() - self._written >= EVERY_S:
            self.flush()


def _is_new(folder: Path) -> bool:
    return not (os.path.lexists(folder / MANIFEST) or has_parts(folder))


def _refuse_other(folder: Path) -> None:
    """Refuse a folder that holds something else than a store, or a file of that name."""
    if not folder.is_dir() or has_parts(folder):
        return
    try:
        manifests.read_manifest(folder)
        return
    except UnreadableError as error:
        why = f"no {MANIFEST}" if _is_new(folder) else f"a {MANIFEST} that is no store's ({error})"
    others = sorted(path.name for path in folder.iterdir() if not _begun(path))
    if others:
        raise CrankcheckError(
            f"-o {folder}: holds {others[0]} and {why}, so it is not the store of a sweep; name "
            "a new or an empty folder"
        )


def _begun(path: Path) -> bool:
    """True for the first files of a sweep: a lock, and empty folders."""
    return path.name == manifests.LOCK or (
        path.name in TABLES and path.is_dir() and not any(path.iterdir())
    )


def _create(folder: Path, names: Iterable[str]) -> None:
    try:
        for name in names:
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CrankcheckError(
            f"-o {folder}: {error.strerror or error}; choose another place"
        ) from None


def mend(folder: Path, store: ExaminedStore) -> list[str]:
    """Move damaged files into the folder ``damaged``, and keep of repeated cells the row that
    counts; return the lines that say so.

    Such a row is there twice in between, which readers know, and at no moment not at all. Raises
    CrankcheckError for a file that can not be moved.
    """
    for here in store.folders.values():
        for name, part in here.parts.items():
            if not all(here.last[name]):
                part.write_again(here.last[name])
    moved = [_set_aside(folder, each.path) for each in store.damage if each.aside]
    # A stopped sweep goes on without a word.
    bad = [each for each in store.damage if each.cure == "sweep" and each.what != STOPPED]
    lines = [each.line for each in bad]
    if moved:
        lines.append(f"moved to {folder / manifests.DAMAGED}: {', '.join(moved)}")
    if any(each.path == MANIFEST for each in bad):
        lines.append(f"{MANIFEST} is made again, and knows only this sweep")
    return [f"{folder}: damaged", *manifests.indented(lines)] if lines else []


def _set_aside(folder: Path, path: str) -> str:
    """Move a file or a folder of the store; return its new name."""
    place = folder / manifests.DAMAGED
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
    """Yield names for a moved file, one of which is free: without its folder, and with a number."""
    stem, dot, ending = path.rpartition("/")[2].partition(".")
    yield f"{stem}{dot}{ending}"
    for number in count(2):
        yield f"{stem}-{number}{dot}{ending}"
