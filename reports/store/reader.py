"""Read a store: cells with their costs, every error, and traces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # as above

from models.array import Array
from models.errors import CrankcheckError
from reports.store.damage import BUSY, Damage, notice
from reports.store.examine import LACKING, STOPPED, Examined, examine
from reports.store.folder import has_parts, paths_of
from reports.store.lock import is_written
from reports.store.manifest import MANIFEST, Manifest, read_manifest
from reports.store.part import UnreadableError


@dataclass(frozen=True)
class Stored:
    """A store in memory: what of it can be read, and what is wrong with the rest.

    ``cells`` has one row per cell, and the columns of its timing beside its own (NaN where it was
    not timed); ``timings`` and ``errors`` are the tables as they stand.
    """

    folder: Path
    manifest: Manifest
    cells: pd.DataFrame
    timings: pd.DataFrame
    examined: Examined | None = field(default=None, repr=False, compare=False)

    @property
    def damage(self) -> tuple[Damage, ...]:
        """What is wrong with the store."""
        return self.examined.damage if self.examined else ()

    @property
    def notice(self) -> list[str]:
        """The lines that name every damage; none where there is none."""
        return notice(self.folder, self.damage, len(self.cells), self.manifest)

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Every error of every cell, in long form."""
        return _frame(self.examined, "errors")

    @cached_property
    def _traces(self) -> Mapping[str, Mapping[str, Array]]:
        frame = _frame(self.examined, "traces")
        found: dict[str, dict[str, Array]] = {}
        for row in frame[["key", "series", "values"]].itertuples(index=False) if len(frame) else ():
            key, series, values = row
            found.setdefault(key, {})[series] = np.asarray(values, dtype=np.float64)
        return found

    def trace(self, key: str) -> Mapping[str, Array]:
        """The last turn of a cell (see `reports.compare.last_turn`); empty where there is none."""
        return self._traces.get(key, {})


def read_store(folder: Path) -> Stored:
    """The store in a folder, as far as it can be read.

    Raises
    ------
    CrankcheckError
        No store, or one without a cell that can be read.
    """
    try:
        _refuse_none(folder)
        found = _examined(folder)
    except OSError as error:
        raise CrankcheckError(
            f"{folder}: can not be read: {error.strerror or error}; name the folder of a sweep"
        ) from None
    cells = _frame(found, "cells")
    if cells.empty:
        lines = notice(folder, found.damage, 0, found.manifest)
        usual = f"{folder}: a store without cells; run its sweep again"
        raise CrankcheckError("\n".join(lines) or usual)
    timings = _frame(found, "timings")
    if timings.empty:
        timings = pd.DataFrame({"key": pd.Series(dtype="str"), "us_per_step": []})
    named = _named(cells, found.manifest)
    joined = named.merge(timings, on="key", how="left", validate="one_to_one")
    return Stored(folder, found.manifest, joined, timings, found)


def _examined(folder: Path) -> Examined:
    """A store, looked through, of which a sweep may write more meanwhile; one that came to its end
    since then is seen by its lock before, and one that began by its lock after."""
    busy = is_written(folder)
    found = examine(folder)
    return _while_written(found) if found.damage and (busy or is_written(folder)) else found


def _while_written(found: Examined) -> Examined:
    """A store that a sweep writes to: cells that it is still to write are no damage of it.

    They stay in the way of whoever must know all cells, as a comparison.
    """
    later = [each for each in found.damage if each.what in (LACKING, STOPPED)]
    if not later:
        return found
    lost = sum(each.lost or 0 for each in later)
    waiting = Damage("cells", BUSY, "wait", lost, lost > 0)
    return replace(found, damage=(waiting, *(each for each in found.damage if each not in later)))


def _refuse_none(folder: Path) -> None:
    """Raise CrankcheckError for a folder that is no store, whole or not."""
    if has_parts(folder):
        return
    try:
        read_manifest(folder)
    except UnreadableError as error:
        raise CrankcheckError(
            f"{folder}: no store of a sweep there ({MANIFEST}: {error}); `crankcheck sweep -o` "
            "with a new folder makes one"
        ) from None


def _named(cells: pd.DataFrame, manifest: Manifest) -> pd.DataFrame:
    """The cells under the names of the last run that asked for them, those of later runs later."""
    names: dict[str, tuple[int, str, str, bool]] = {}
    for index, run in enumerate(manifest.runs):
        lines = run.get("lines")
        for line, name in lines.items() if isinstance(lines, Mapping) else ():
            names[line] = (index, *name)
    known = cells["line"].isin(list(names))
    for at, column in enumerate(("variant", "profile", "gated"), 1):
        found = [names[line][at] for line in cells.loc[known, "line"]]
        cells.loc[known, column] = pd.Series(
            found, index=cells.index[known], dtype=cells[column].dtype
        )
    asked = [names[line][0] if line in names else -1 for line in cells["line"]]
    return cells.iloc[np.argsort(asked, kind="stable")].reset_index(drop=True)


def stored_keys(folder: Path, name: str) -> set[str]:
    """The keys that a table holds already."""
    found = _parts(folder, name, ["key"])
    return set() if found is None else set(found.column("key").to_pylist())


@dataclass(frozen=True)
class Ending:
    """A cell that was ended: the limits of time [s] and memory [GB] that it had."""

    limit_s: float
    memory_gb: float


def stored_endings(folder: Path) -> dict[str, Ending]:
    """The cells that timed out or crashed, by key."""
    found = _parts(folder, "cells", ["key", "status", "limit_s", "memory_gb"])
    if found is None:
        return {}
    rows = zip(*(found.column(name).to_pylist() for name in found.column_names), strict=True)
    return {k: Ending(t, m) for k, status, t, m in rows if status in ("timeout", "crashed")}


def stored_costs(folder: Path) -> dict[str, float]:
    """The rough cost of a step [microseconds] of each cell that ran well, by key."""
    found = _parts(folder, "cells", ["key", "status", "logged_us_per_step"])
    if found is None:
        return {}
    rows = zip(*(found.column(name).to_pylist() for name in found.column_names), strict=True)
    return {key: cost for key, status, cost in rows if status == "ok" and cost is not None}


def _frame(found: Examined | None, name: str) -> pd.DataFrame:
    """What can be read of a table."""
    table = found.table(name) if found else None
    return pd.DataFrame() if table is None else table.to_pandas()


def _parts(folder: Path, name: str, columns: list[str]) -> pa.Table | None:
    """Some columns of all parts of a table that was mended; None where there are none."""
    found = [
        pq.ParquetFile(path).read(columns, use_threads=False) for path in paths_of(folder, name)
    ]
    return pa.concat_tables(found, promote_options="permissive") if found else None
