"""Read a store: cells with their costs, every error, and traces."""

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # ships no stubs

from models.array import Array
from models.errors import CrankcheckError, few
from models.files.inputs import UnreadableError
from reports.store import folder as files
from reports.store import manifest as manifests
from reports.store.manifest import MANIFEST, TABLES, Damage, Manifest
from reports.workers.isolated import Limits

HARD = ("stability.json", "stability.csv", "stability.html")
"""Files that `crankcheck stability` may have put beside a sweep."""
OWN = {MANIFEST, *TABLES, *HARD, manifests.LOCK, manifests.DAMAGED, manifests.TRAJECTORIES}
STOPPED = "fewer cells than its sweeps requested; was one stopped?"
REPEATED = "rows that another part has too; those written last count"
UNASKED = f"cells that no sweep in {MANIFEST} requested; left out until one does"


@dataclass(frozen=True)
class ExaminedStore:
    """A store, looked through."""

    manifest: Manifest
    folders: Mapping[str, files.Folder]
    damage: tuple[Damage, ...] = ()

    def table(self, name: str, nested: str = "") -> pa.Table | None:
        """Return the rows of a table that count, in the order of writing; with ``nested``, that
        column of rows and the keys. None where there is nothing."""
        tables = []
        for part in self.folders[name].parts.values():
            rows = part.nested(nested) if nested else part.rows
            counting = self._counting(name, part)
            tables.append(rows if all(counting) else rows.filter(pa.array(counting)))
        return pa.concat_tables(tables, promote_options="permissive") if tables else None

    def _counting(self, table: str, part: files.TablePart) -> Sequence[bool]:
        """Return flags of the rows of a part that count: written last, of requested cells."""
        last, asked = self.folders[table].last[part.path.name], self.manifest.lines
        if table == "timings" or not asked:
            return last
        lines = part.rows.column("line").to_pylist()
        return [each and line in asked for each, line in zip(last, lines, strict=True)]


def examine(folder: Path) -> ExaminedStore:
    """Look through a store. Raises OSError where its folder can not be looked at, CrankcheckError
    for a store of another format."""
    # The request of a sweep is in the manifest before its first cell is in a part.
    folders = {name: files.open_folder(folder / name, name) for name in TABLES}
    damage = []
    try:
        manifest = manifests.read_manifest(folder)
    except UnreadableError as error:
        manifest = Manifest()
        damage.append(Damage(MANIFEST, str(error), aside=os.path.lexists(folder / MANIFEST)))
    whole = ExaminedStore(manifest, folders)
    damage += [*_cells(folder, whole), *_timings(folder, folders["timings"])]
    for table, place in folders.items():
        damage += [
            Damage(f"{table}/{name}", REPEATED, aside=True)
            for name in place.parts
            if not all(place.last[name])
        ]
    return replace(whole, damage=(*damage, *_harmless(folder, whole)))


def _cells(folder: Path, store: ExaminedStore) -> Iterator[Damage]:
    """Yield lost parts of cells, and further cells that the manifest knows to be missing."""
    cells, lost = store.folders["cells"], 0
    for name, error in cells.faults.items():
        lost += files.rows_in(name)
        yield Damage(f"cells/{name}", str(error), lost=files.rows_in(name), aside=True)
    rows = store.table("cells")
    readable = Counter(rows.column("line").to_pylist() if rows else ())
    asked = _asked(store.manifest)
    gone = sum(max(0, number - readable[line]) for line, number in asked.items()) - lost
    if cells.fault or gone > 0:
        aside = bool(cells.fault) and os.path.lexists(folder / "cells")
        yield Damage("cells", cells.fault or STOPPED, lost=max(0, gone), aside=aside)


def _timings(folder: Path, timings: files.Folder) -> Iterator[Damage]:
    for name, error in timings.faults.items():
        yield Damage(f"timings/{name}", f"{error}; its times are lost", aside=True)
    if timings.fault and os.path.lexists(folder / "timings"):
        yield Damage("timings", f"{timings.fault}; all times are lost", aside=True)


def _asked(manifest: Manifest) -> dict[str, int]:
    """Return the requested number of cells of each line, from the steps of studies, or its own."""
    asked: dict[str, set[float]] = {}
    for run in manifest.runs:
        usual = run.get("study", {}).get("steps_per_turn", ())
        for line in run.get("lines", {}):
            asked.setdefault(line, set()).update(run.get("own_steps", {}).get(line, usual))
    return {line: len(steps) for line, steps in asked.items()}


def _harmless(folder: Path, store: ExaminedStore) -> Iterator[Damage]:
    """Yield files that are not of the store, and cells that nobody requested."""
    asked, parts = store.manifest.lines, store.folders["cells"].parts
    unasked = {
        f"cells/{name}": number
        for name, part in parts.items()
        if (number := sum(line not in asked for line in part.rows.column("line").to_pylist()))
    }
    if asked and unasked:  # a manifest made again may know less than was run: they are missed
        yield Damage(few(list(unasked), 3), UNASKED, "nothing", lost=sum(unasked.values()))
    top = sorted(path.name for path in folder.iterdir() if path.name not in OWN)
    foreign = [name for name in top if not files.being_written(name)]
    foreign += [name for here in store.folders.values() for name in here.foreign]
    if foreign:
        yield Damage(few(foreign, 3), "not of the store; left alone", "nothing")


@dataclass(frozen=True)
class Stored:
    """A store in memory: its readable part, and the damage of the rest.

    ``cells`` has one row per cell, and the columns of its timing beside its own (NaN where it was
    not timed); ``timings`` is the table of the file.
    """

    folder: Path
    manifest: Manifest
    cells: pd.DataFrame
    timings: pd.DataFrame
    examined: ExaminedStore | None = field(default=None, repr=False, compare=False)

    @property
    def damage(self) -> tuple[Damage, ...]:
        """Damage of the store."""
        return self.examined.damage if self.examined else ()

    @property
    def notice(self) -> list[str]:
        """Lines that name every damage; none where there is none."""
        return manifests.notice(self.folder, self.damage, len(self.cells), self.manifest.runs)

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Every error of every cell, in long form, with the key of the cell."""
        return _frame(self.examined, "cells", "errors")

    @cached_property
    def _traces(self) -> Mapping[str, Mapping[str, Array]]:
        frame = _frame(self.examined, "cells", "trace")
        traces: dict[str, dict[str, Array]] = {}
        for row in frame[["key", "series", "values"]].itertuples(index=False) if len(frame) else ():
            key, series, values = row
            traces.setdefault(key, {})[series] = np.asarray(values, dtype=np.float64)
        return traces

    def trace(self, key: str) -> Mapping[str, Array]:
        """Return the last turn of a cell (see `reports.compare.last_turn`); empty without one."""
        return self._traces.get(key, {})


def read_store(folder: Path) -> Stored:
    """Return the store in a folder, as far as it can be read. Raises CrankcheckError for no store,
    one of another format, or without a manifest or a cell that can be read."""
    try:
        _refuse_unknown(folder)
        store = _examined(folder)
    except OSError as error:
        raise CrankcheckError(
            f"{folder}: can not be read: {error.strerror or error}; name the folder of a sweep"
        ) from None
    cells = _frame(store, "cells")
    if cells.empty:
        lines = manifests.notice(folder, store.damage, 0, store.manifest.runs)
        usual = f"{folder}: a store without cells; run its sweep again"
        raise CrankcheckError("\n".join(lines) or usual)
    timings = _frame(store, "timings")
    if timings.empty:
        timings = pd.DataFrame({"key": pd.Series(dtype="str"), "us_per_step": []})
    named = _named(cells, store.manifest)
    joined = named.merge(timings, on="key", how="left", validate="one_to_one")
    return Stored(folder, store.manifest, joined, timings, store)


def _examined(folder: Path) -> ExaminedStore:
    """Return a store, looked through, of which a sweep may write more meanwhile; a sweep that ended
    since then is seen by its lock before, and one that began by its lock after.

    Cells that it is still to write are no damage, and still hinder a reader that must know all
    cells, as a comparison.
    """
    busy = files.is_written(folder)
    store = examine(folder)
    later = [each for each in store.damage if each.what == STOPPED]
    if not later or not (busy or files.is_written(folder)):
        return store
    waiting = Damage("cells", manifests.BUSY, "wait", sum(each.lost for each in later))
    return replace(store, damage=(waiting, *(each for each in store.damage if each not in later)))


def _refuse_unknown(folder: Path) -> None:
    """Raise CrankcheckError for a folder without a manifest that can be read."""
    try:
        manifests.read_manifest(folder)
    except UnreadableError as error:
        if files.has_parts(folder):
            mends = manifests.command(folder, ())
            raise CrankcheckError(
                f"{folder}: {MANIFEST}: {error}; to repair it: {mends} (keeps every cell that is "
                "whole)"
            ) from None
        raise CrankcheckError(
            f"{folder}: no store of a sweep there ({MANIFEST}: {error}); `crankcheck sweep -o` "
            "with a new folder makes one"
        ) from None


def _named(cells: pd.DataFrame, manifest: Manifest) -> pd.DataFrame:
    """Return the cells under the names of the last run that requested them, later runs last."""
    names = {
        line: (index, *name)
        for index, run in enumerate(manifest.runs)
        for line, name in run.get("lines", {}).items()
    }
    asked_for = cells["line"].isin(list(names))
    for at, column in enumerate(("variant", "profile", "gated"), 1):
        values = [names[line][at] for line in cells.loc[asked_for, "line"]]
        cells.loc[asked_for, column] = pd.Series(
            values, index=cells.index[asked_for], dtype=cells[column].dtype
        )
    asked = [names[line][0] if line in names else -1 for line in cells["line"]]
    return cells.iloc[np.argsort(asked, kind="stable")].reset_index(drop=True)


def stored_keys(folder: Path, name: str) -> set[str]:
    """Return the keys that a table holds already."""
    return {str(key) for (key,) in _rows(folder, name, "key")}


def stored_endings(folder: Path) -> dict[str, Limits]:
    """Return the limits of the cells that timed out or crashed, by key."""
    rows = _rows(folder, "cells", "key", "status", "limit_s", "memory_gb")
    return {k: Limits(t, m) for k, status, t, m in rows if status in ("timeout", "crashed")}


def stored_costs(folder: Path) -> dict[str, float]:
    """Return the rough cost of a step [microseconds] of each cell that ran well, by key."""
    rows = _rows(folder, "cells", "key", "status", "logged_us_per_step")
    return {key: cost for key, status, cost in rows if status == "ok" and cost is not None}


def _rows(folder: Path, name: str, *columns: str) -> Iterator[tuple[Any, ...]]:
    """Yield some columns of a repaired table, row by row."""
    for path in files.paths_of(folder, name):
        part = pq.ParquetFile(path).read(columns, use_threads=False)
        yield from zip(*(part.column(column).to_pylist() for column in columns), strict=True)


def _frame(store: ExaminedStore | None, name: str, nested: str = "") -> pd.DataFrame:
    """Return the readable part of a table, or of the rows that one of its columns holds."""
    rows = store.table(name, nested) if store else None
    if rows is not None and nested:
        rows = manifests.unnested(rows, nested)
    return pd.DataFrame() if rows is None else rows.to_pandas()
