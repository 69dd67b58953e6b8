"""Look through the files of a store once: what can be read, and what is wrong with the rest."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import compress
from pathlib import Path

import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs

from reports.store.damage import Cure, Damage, counted
from reports.store.folder import Folder, Parts, being_written, joined, kept, open_folder, owners_of
from reports.store.manifest import MANIFEST, Manifest, read_manifest
from reports.store.part import OtherFormatError, Part, UnreadableError
from reports.store.rebuilding import rebuilt
from reports.store.schema import DAMAGED, LOCK, TABLES, TRAJECTORIES

HARD = ("stability.json", "stability.csv", "stability.html")
"""What `crankcheck stability` may have put beside a sweep."""
OWN = {MANIFEST, LOCK, DAMAGED, TRAJECTORIES, *TABLES, *HARD}
HANGING = ("errors", "traces")
"""Tables whose rows are of the cells in the part of the same name."""
LACKING = "not there, though its errors are"
STOPPED = "not all that its sweeps asked for; was one stopped?"
UNSEALED = "without a checksum (an older crankcheck, or another program): read as they are"


@dataclass(frozen=True)
class Examined:
    """A store, looked through.

    ``owners`` says for each table of ``cells`` and ``timings`` which part a row of each key is
    taken from; ``bare`` are the keys of cells that lack their errors or their trace.
    """

    manifest: Manifest
    folders: Mapping[str, Folder]
    owners: Mapping[str, Mapping[str, str]]
    damage: tuple[Damage, ...]
    bare: frozenset[str]

    def table(self, name: str) -> pa.Table | None:
        """All that can be read of a table, in the order of writing; None where there is nothing."""
        return joined(
            self.folders[name].parts, self.owners["timings" if name == "timings" else "cells"]
        )

    def rows(self, table: str, name: str) -> pa.Table:
        """The rows of a part that count."""
        part = self.folders[table].parts[name]
        counting, _ = kept(part, self.owners["timings" if table == "timings" else "cells"])
        return part.content.filter(pa.array(counting, pa.bool_()))

    @property
    def repeated(self) -> Iterator[tuple[str, str]]:
        """Parts of cells and of timings, by table and name, with rows that another has too."""
        for table in ("cells", "timings"):
            for name, part in self.folders[table].parts.items():
                if not kept(part, self.owners[table])[1]:
                    yield table, name


def examine(folder: Path) -> Examined:
    """Look through a store. Raises OSError where even its folder can not be looked at."""
    folders = {name: open_folder(folder / name, name) for name in TABLES}
    beside = folders["errors"].parts
    owners = {
        "cells": owners_of(folders["cells"].parts, beside),
        "timings": owners_of(folders["timings"].parts, {}),
    }
    found = [*_cells(folder, folders, owners["cells"])]
    bare: set[str] = set()
    for name in HANGING:
        found += _hanging(folder, folders, owners["cells"], name, bare)
    found += _timings(folder, folders["timings"])
    manifest, wrong = _manifest(folder, folders, owners)
    found = [*wrong, *_completed(found, manifest, folders["cells"].parts, owners["cells"])]
    whole = Examined(manifest, folders, owners, (), frozenset(bare))
    found += [
        Damage(f"{table}/{name}", "rows that another part has too; those written last count")
        for table, name in whole.repeated
    ]
    return replace(whole, damage=(*found, *_harmless(folder, folders, manifest)))


def _cells(
    folder: Path, folders: Mapping[str, Folder], owners: Mapping[str, str]
) -> Iterator[Damage]:
    """Parts of cells that are lost, or not there though their errors are."""
    here = folders["cells"]
    hanging: dict[str, set[str]] = {}
    for table in HANGING:
        for name, part in folders[table].parts.items():
            hanging.setdefault(name, set()).update(part.keys)
    alone = [name for name in sorted(hanging) if name not in here.parts]
    if here.fault:
        lost = {key for name in alone for key in hanging[name]}
        files = [file for name in alone for file in _siblings(folder, name)]
        aside = (*(["cells"] if os.path.lexists(folder / "cells") else []), *files)
        yield Damage("cells", here.fault, "sweep", len(lost) or None, True, aside)
        return
    for name in sorted({*here.faults, *alone}):
        error = here.faults.get(name) or UnreadableError(LACKING)
        gone = [key for key in hanging.get(name, ()) if key not in owners]
        known = len(gone) if name in hanging else None
        aside = _siblings(folder, name)
        yield Damage(f"cells/{name}", str(error), _cure(error), known, known != 0, aside)


def _siblings(folder: Path, name: str) -> tuple[str, ...]:
    """The files of a part in all tables that make up its cells."""
    files = [f"{table}/{name}" for table in ("cells", *HANGING)]
    return tuple(file for file in files if os.path.lexists(folder / file))


def _cure(error: UnreadableError) -> Cure:
    return "version" if isinstance(error, OtherFormatError) else "sweep"


def _hanging(
    folder: Path,
    folders: Mapping[str, Folder],
    owners: Mapping[str, str],
    table: str,
    bare: set[str],
) -> Iterator[Damage]:
    """Cells whose errors or traces are lost; adds their keys to ``bare``."""
    here = folders[table]
    needed = {name: _expected(part, owners, table) for name, part in folders["cells"].parts.items()}
    if here.fault:
        lacking = {key for keys in needed.values() for key in keys}
        bare |= lacking
        there = os.path.lexists(folder / table)
        if lacking or there:
            yield Damage(table, _without(here.fault, lacking, table), aside=(table,) * there)
        return
    for name in sorted({*needed, *here.faults}):
        keys: set[str] = set()
        lacking, path = needed.get(name, set()), f"{table}/{name}"
        what, aside = "", tuple[str, ...]()
        error = here.faults.get(name)
        if error is not None:
            what, aside = str(error), (path,)
        elif name not in here.parts:
            what = "not there"
        else:
            keys = set(here.parts[name].keys)
            if keys <= set(folders["cells"].parts[name].keys):
                lacking, what = lacking - keys, "not of all its cells"
            else:
                what, aside = f"holds rows that are of no cell in cells/{name}", (path,)
        if lacking or error is not None or aside:
            bare |= lacking
            cure: Cure = "sweep" if error is None else _cure(error)
            yield Damage(path, _without(what, lacking - keys, table), cure, aside=aside)


def _without(what: str, keys: set[str], table: str) -> str:
    return f"{what}; {counted(len(keys))} without {table}" if keys else what


def _expected(part: Part, owners: Mapping[str, str], table: str) -> set[str]:
    """The cells of a part that have errors, or a trace: those of runs that logged something, and
    of runs that came further than their start."""
    content = part.content
    logged = content.column("drive_pure").is_valid().to_pylist()
    stopped = content.column("stopped_at_s").to_pylist()
    return {
        key
        for key, some, end_s in zip(part.keys, logged, stopped, strict=True)
        if some and (table == "errors" or (end_s or 0.0) > 0.0) and owners[key] == part.name
    }


def _timings(folder: Path, here: Folder) -> Iterator[Damage]:
    """What of the timings is lost."""
    for name, error in here.faults.items():
        path = f"timings/{name}"
        yield Damage(path, f"{error}; its times are lost", _cure(error), aside=(path,))
    if here.fault and os.path.lexists(folder / "timings"):
        yield Damage("timings", f"{here.fault}; all times are lost", aside=("timings",))


def _manifest(
    folder: Path, folders: Mapping[str, Folder], owners: Mapping[str, Mapping[str, str]]
) -> tuple[Manifest, list[Damage]]:
    """The manifest, or what the cells know of it."""
    try:
        return read_manifest(folder), []
    except UnreadableError as error:
        tables = (joined(folders[name].parts, owners[name]) for name in ("cells", "timings"))
        aside = (MANIFEST,) * os.path.lexists(folder / MANIFEST)
        what = f"{error}; names and versions are those that the cells know"
        return rebuilt(*tables), [Damage(MANIFEST, what, _cure(error), 0, True, aside)]


def _completed(
    found: list[Damage], manifest: Manifest, cells: Parts, owners: Mapping[str, str]
) -> list[Damage]:
    """With what the manifest knows to be missing, from the numbers of steps of its studies."""
    there: Counter[str] = Counter()
    for part in cells.values():
        lines = part.content.column("line").to_pylist()
        there.update(compress(lines, kept(part, owners)[0]))
    gone = sum(max(0, number - there[line]) for line, number in _asked(manifest).items())
    gone -= sum(each.lost or 0 for each in found)
    unknown = sum(each.lost is None for each in found)
    if gone <= 0 or unknown > 1:
        return found
    if unknown:
        return [replace(each, lost=gone) if each.lost is None else each for each in found]
    return [*found, Damage("cells", STOPPED, "sweep", gone, True)]


def _asked(manifest: Manifest) -> dict[str, int]:
    """How many cells of each line were asked for."""
    asked: dict[str, set[float]] = {}
    for run in manifest.runs:
        study, lines = run.get("study"), run.get("lines")
        steps = study.get("steps_per_turn") if isinstance(study, dict) else None
        if isinstance(lines, dict) and isinstance(steps, list):
            for line in lines:
                asked.setdefault(line, set()).update(steps)
    return {line: len(steps) for line, steps in asked.items()}


def _harmless(folder: Path, folders: Mapping[str, Folder], manifest: Manifest) -> Iterator[Damage]:
    """What can not be checked, and what is not of the store."""
    open_to_change = [] if manifest.sealed else [MANIFEST]
    for table, here in folders.items():
        open_to_change += [f"{table}/{n}" for n, part in here.parts.items() if not part.sealed]
    if open_to_change:
        yield Damage(_few(open_to_change), UNSEALED, "nothing")
    top = sorted(path.name for path in folder.iterdir() if path.name not in OWN)
    foreign = [name for name in top if not being_written(name)]
    foreign += [name for here in folders.values() for name in here.foreign]
    if foreign:
        yield Damage(_few(foreign), "not of the store; left alone", "nothing")


def _few(names: list[str]) -> str:
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return ", ".join(names[:3]) + more
