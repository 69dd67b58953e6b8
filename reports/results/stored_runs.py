"""Read a stored run of either kind: the store of a sweep, or files of `crankcheck verify -o`."""

import csv
import io
import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

from models.errors import CrankcheckError
from models.files.inputs import UnreadableError, regular_bytes
from models.files.reading import scene_texts
from reports.plan.grid import digest
from reports.results.runs import CellName, CellRow, StoredCell, StoredRun, stored_cell, text
from reports.store.folder import has_parts
from reports.store.manifest import MANIFEST
from reports.store.reader import STOPPED, read_store

CELLS, FACTS = "verify.csv", "verify.json"
MOST_BYTES = 100_000_000
"""Most bytes of a file of a verification: a thousand cells take a hundredth of it."""
WRITERS = "`crankcheck sweep -o` or `crankcheck verify -o`"


Contents = tuple[list[CellRow], StoredRun]
"""Rows of the cells in a folder, and their run, still without cells."""


def read_run(folder: Path, version: str | None = None, option: str = "") -> StoredRun:
    """Return the run in a folder.

    A store keeps every version of an engine that it was filled with. The last written of otherwise
    equal cells counts, unless ``version`` is given: then an engine that has cells of that version
    is taken with these alone. ``option`` is the option for the version, for messages.

    Raises
    ------
    CrankcheckError
        No such folder, no stored run in it, one that can not be read, a version that it has not.
    """
    rows, run = _contents(folder)
    if any(row.get("worlds") for row in rows):
        raise CrankcheckError(f"{folder}: cells of batches (--worlds) are not compared")
    try:
        cells = [stored_cell(row, run.facts) for row in rows]
    except (KeyError, ValueError, OverflowError) as error:
        why = f"no column {error}" if isinstance(error, KeyError) else str(error)
        raise CrankcheckError(
            f"{folder}: not the cells of a run ({why}); make it again with {WRITERS}"
        ) from None
    if not any(cell.errors for cell in cells):
        raise CrankcheckError(f"{folder}: no errors in its cells; make it again with {WRITERS}")
    chosen, notes = _chosen(cells, folder, version, option)
    return replace(run, cells=chosen, notes=notes)


def scene_digests(names: Iterable[str]) -> dict[str, str]:
    """Return the hash of each scene's text by the scene's name; of all shipped scenes for none."""
    return {name: digest(text) for name, text in scene_texts(names).items()}


def _contents(folder: Path) -> Contents:
    kinds: dict[str, Callable[[Path], Contents]] = {MANIFEST: _store, CELLS: _verification}
    try:
        there = [name for name in kinds if (folder / name).is_file()]
        if MANIFEST not in there and has_parts(folder):
            there = [MANIFEST, *there]
        if len(there) == 1:
            return kinds[there[0]](folder)
        raise CrankcheckError(f"{folder}: {_not_a_run(folder, there)}")
    except OSError as error:
        raise CrankcheckError(
            f"{folder}: can not be read: {error.strerror or error}; name a folder that "
            f"{WRITERS} wrote"
        ) from None


def _not_a_run(folder: Path, there: list[str]) -> str:
    """Say why a folder holds no single run: none, or two."""
    if there:
        return (
            f"holds a sweep ({MANIFEST}) and a verification ({CELLS}); move one of them to a "
            "folder of its own"
        )
    if not folder.exists():
        return f"no such folder; name one that {WRITERS} wrote"
    if not folder.is_dir():
        return f"a file; name the folder that {WRITERS} wrote"
    inside = sorted(
        path.parent.name for name in (MANIFEST, CELLS) for path in folder.glob(f"*/{name}")
    )
    if inside:
        return f"no stored run there, but in its folders: name one of {', '.join(inside[:8])}"
    return f"no stored run there (no {MANIFEST}, no {CELLS}); {WRITERS} makes one"


def _store(folder: Path) -> Contents:
    stored = read_store(folder)
    runs = stored.manifest.runs
    facts = runs[-1].get("provenance") if runs else None
    rows = cast("list[CellRow]", stored.cells.to_dict("records"))
    gone = [each for each in stored.damage if each.lost]
    return rows, StoredRun(
        str(folder),
        {},
        _texts(facts),
        notice=tuple(stored.notice),
        gone=tuple(each.line for each in gone),
        lost=any(each.cure != "wait" and each.what != STOPPED for each in gone),
    )


def _verification(folder: Path) -> Contents:
    path = folder / CELLS
    try:
        lines = io.StringIO(regular_bytes(path, MOST_BYTES).decode(), newline="")
        rows: list[CellRow] = [
            {key: value for key, value in row.items() if isinstance(key, str)}
            for row in csv.DictReader(lines)
        ]
    except UnreadableError as error:
        raise CrankcheckError(f"{path}: {error}; verify again") from None
    except (ValueError, csv.Error) as error:
        raise CrankcheckError(f"{path}: not a CSV file ({error}); verify again") from None
    if not rows:
        raise CrankcheckError(f"{path}: no cells in it; verify again")
    notice: tuple[str, ...] = ()
    try:
        facts = json.loads(regular_bytes(folder / FACTS, MOST_BYTES))
    except UnreadableError as error:
        if os.path.lexists(folder / FACTS):
            raise CrankcheckError(f"{folder / FACTS}: {error}; verify again") from None
        # The cells are enough to compare.
        facts, notice = {}, (f"{folder}: no {FACTS}, so {CELLS} can not be checked",)
    except (ValueError, RecursionError) as error:
        raise CrankcheckError(f"{folder / FACTS}: not JSON ({error}); verify again") from None
    if not isinstance(facts, dict):
        raise CrankcheckError(f"{folder / FACTS}: no facts of a verification; verify again")
    if cut := _cut(rows, facts.get("cells")):
        raise CrankcheckError(f"{path}: cut short ({cut}); verify again")
    digests = _texts(facts.get("scenes"))
    rows = [{"scene_digest": digests.get(text(row.get("scene")), ""), **row} for row in rows]
    return rows, StoredRun(str(folder), {}, _texts(facts.get("provenance")), notice=notice)


def _cut(rows: Sequence[CellRow], cells: object) -> str:
    """Say how the file of the cells was cut short, by the number in the other file; "" if whole."""
    number = len(cells) if isinstance(cells, list) and cells else len(rows)
    if number != len(rows):
        return f"{len(rows)} of the {number} cells that {FACTS} knows"
    return "its last row is not whole" if None in rows[-1].values() else ""


def _texts(value: object) -> dict[str, str]:
    if not isinstance(value, Mapping):
        return {}
    return {str(key): text(item) for key, item in value.items()}


def _chosen(
    cells: list[StoredCell], folder: Path, version: str | None, option: str
) -> tuple[dict[CellName, StoredCell], tuple[str, ...]]:
    """Return one cell of each name, and notes on cells that were passed over."""
    versions: dict[str, dict[str, None]] = {}
    for cell in cells:
        versions.setdefault(cell.name.engine, {})[cell.version] = None
    if version is not None:
        if not any(version in each for each in versions.values()):
            has = "; ".join(f"{engine} {', '.join(each)}" for engine, each in versions.items())
            raise CrankcheckError(f"{option} {version}: {folder} has {has}")
        cells = [
            cell for cell in cells
            if version not in versions[cell.name.engine] or cell.version == version
        ]  # fmt: skip
        versions = {e: {version: None} if version in v else v for e, v in versions.items()}
    choice = f"; {option} chooses" if option else ""
    notes = tuple(
        f"{folder} holds {engine} {', '.join(each)}: the last written of each cell counts{choice}"
        for engine, each in versions.items()
        if len(each) > 1
    )
    return {cell.name: cell for cell in cells}, notes
