"""Look through the files of a store once: what can be read, and what is wrong with the rest."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs

from models.errors import few
from models.files.inputs import UnreadableError
from reports.store.folder import Folder, Part, being_written, open_folder, rows_in
from reports.store.manifest import MANIFEST, Damage, Manifest, read_manifest
from reports.store.schema import DAMAGED, LOCK, TABLES, TRAJECTORIES

HARD = ("stability.json", "stability.csv", "stability.html")
"""What `crankcheck stability` may have put beside a sweep."""
OWN = {MANIFEST, LOCK, DAMAGED, TRAJECTORIES, *TABLES, *HARD}
STOPPED = "not all that its sweeps asked for; was one stopped?"
REPEATED = "rows that another part has too; those written last count"
UNASKED = f"cells that no sweep in {MANIFEST} asked for; left out, until one asks for them"


@dataclass(frozen=True)
class Examined:
    """A store, looked through."""

    manifest: Manifest
    folders: Mapping[str, Folder]
    damage: tuple[Damage, ...] = ()

    def table(self, name: str, nested: str = "") -> pa.Table | None:
        """The rows of a table that count, in the order of writing; of a column that holds rows of
        their own it and the keys. None where there is nothing."""
        tables = []
        for part in self.folders[name].parts.values():
            rows = part.nested(nested) if nested else part.rows
            counting = self._counting(name, part)
            tables.append(rows if all(counting) else rows.filter(pa.array(counting)))
        return pa.concat_tables(tables, promote_options="permissive") if tables else None

    def _counting(self, table: str, part: Part) -> Sequence[bool]:
        """Which rows of a part count: those written last, of cells that were asked for."""
        last, asked = self.folders[table].last[part.path.name], self.manifest.lines
        if table == "timings" or not asked:
            return last
        lines = part.rows.column("line").to_pylist()
        return [each and line in asked for each, line in zip(last, lines, strict=True)]


def examine(folder: Path) -> Examined:
    """Look through a store.

    Raises
    ------
    OSError
        Its folder can not be looked at.
    CrankcheckError
        A store of another format.
    """
    # What a sweep asks for is in the manifest before the first cell of it is in a part.
    folders = {name: open_folder(folder / name, name) for name in TABLES}
    damage = []
    try:
        manifest = read_manifest(folder)
    except UnreadableError as error:
        manifest = Manifest()
        damage.append(Damage(MANIFEST, str(error), aside=os.path.lexists(folder / MANIFEST)))
    whole = Examined(manifest, folders)
    damage += [*_cells(folder, whole), *_timings(folder, folders["timings"])]
    for table, place in folders.items():
        damage += [
            Damage(f"{table}/{name}", REPEATED, aside=True)
            for name in place.parts
            if not all(place.last[name])
        ]
    return replace(whole, damage=(*damage, *_harmless(folder, whole)))


def _cells(folder: Path, store: Examined) -> Iterator[Damage]:
    """Parts of cells that are lost, and what the manifest knows to be missing besides."""
    cells, lost = store.folders["cells"], 0
    for name, error in cells.faults.items():
        lost += rows_in(name)
        yield Damage(f"cells/{name}", str(error), lost=rows_in(name), aside=True)
    rows = store.table("cells")
    readable = Counter(rows.column("line").to_pylist() if rows else ())
    asked = _asked(store.manifest)
    gone = sum(max(0, number - readable[line]) for line, number in asked.items()) - lost
    if cells.fault or gone > 0:
        aside = bool(cells.fault) and os.path.lexists(folder / "cells")
        yield Damage("cells", cells.fault or STOPPED, lost=max(0, gone), aside=aside)


def _timings(folder: Path, timings: Folder) -> Iterator[Damage]:
    """What of the timings is lost."""
    for name, error in timings.faults.items():
        yield Damage(f"timings/{name}", f"{error}; its times are lost", aside=True)
    if timings.fault and os.path.lexists(folder / "timings"):
        yield Damage("timings", f"{timings.fault}; all times are lost", aside=True)


def _asked(manifest: Manifest) -> dict[str, int]:
    """How many cells of each line were asked for, from the numbers of steps of the studies,
    or of their own."""
    asked: dict[str, set[float]] = {}
    for run in manifest.runs:
        usual = run.get("study", {}).get("steps_per_turn", ())
        for line in run.get("lines", {}):
            asked.setdefault(line, set()).update(run.get("own_steps", {}).get(line, usual))
    return {line: len(steps) for line, steps in asked.items()}


def _harmless(folder: Path, store: Examined) -> Iterator[Damage]:
    """What is not of the store, or of cells that nobody asked for."""
    asked, parts = store.manifest.lines, store.folders["cells"].parts
    unasked = {
        f"cells/{name}": number
        for name, part in parts.items()
        if (number := sum(line not in asked for line in part.rows.column("line").to_pylist()))
    }
    if asked and unasked:  # a manifest made anew may know of less than was run: they are missed
        yield Damage(few(list(unasked), 3), UNASKED, "nothing", lost=sum(unasked.values()))
    top = sorted(path.name for path in folder.iterdir() if path.name not in OWN)
    foreign = [name for name in top if not being_written(name)]
    foreign += [name for here in store.folders.values() for name in here.foreign]
    if foreign:
        yield Damage(few(foreign, 3), "not of the store; left alone", "nothing")
