"""Read a store: cells with their costs, every error, and traces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # as above

from models.errors import CrankcheckError
from reports.series import Array
from reports.store.manifest import MANIFEST, Manifest, read_manifest


@dataclass(frozen=True)
class Stored:
    """A store in memory.

    ``cells`` has one row per cell, and the columns of its timing beside its own (NaN where it was
    not timed); ``timings`` and ``errors`` are the tables as they stand.
    """

    folder: Path
    manifest: Manifest
    cells: pd.DataFrame
    timings: pd.DataFrame

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Every error of every cell, in long form."""
        return _frame(self.folder, "errors")

    @cached_property
    def _traces(self) -> Mapping[str, Mapping[str, Array]]:
        frame = _frame(self.folder, "traces")
        found: dict[str, dict[str, Array]] = {}
        for key, series, values in frame.itertuples(index=False):
            found.setdefault(key, {})[series] = np.asarray(values, dtype=np.float64)
        return found

    def trace(self, key: str) -> Mapping[str, Array]:
        """The last turn of a cell (see `reports.store.trace`); empty where there is none."""
        return self._traces.get(key, {})


def read_store(folder: Path) -> Stored:
    """The store in a folder.

    Raises
    ------
    CrankcheckError
        No store, or one without cells.
    """
    if not (folder / MANIFEST).is_file():
        raise CrankcheckError(
            f"{folder}: no store of a sweep there (no {MANIFEST}); `crankcheck sweep -o {folder}` "
            "makes one"
        )
    manifest = read_manifest(folder)
    cells = _frame(folder, "cells")
    if cells.empty:
        raise CrankcheckError(f"{folder}: a store without cells; run its sweep again")
    timings = _frame(folder, "timings")
    if timings.empty:
        timings = pd.DataFrame({"key": pd.Series(dtype="str"), "us_per_step": []})
    joined = _named(cells, manifest).merge(timings, on="key", how="left", validate="one_to_one")
    return Stored(folder, manifest, joined, timings)


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


def _frame(folder: Path, name: str) -> pd.DataFrame:
    found = _parts(folder, name)
    return pd.DataFrame() if found is None else found.to_pandas()


def _parts(folder: Path, name: str, columns: list[str] | None = None) -> pa.Table | None:
    """All parts of a table, in the order of writing; None where there are none."""
    found = []
    for path in sorted((folder / name).glob("part-*.parquet")):
        try:
            found.append(pq.read_table(path, columns=columns))
        except (OSError, pa.ArrowInvalid) as error:
            raise CrankcheckError(
                f"{path}: can not be read ({error}); delete all files of this name "
                f"({folder}/*/{path.name}) and run the sweep again: only their cells are then "
                "missing"
            ) from None
    return pa.concat_tables(found, promote_options="default") if found else None
