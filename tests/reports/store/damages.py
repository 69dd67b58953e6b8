"""Ways to damage a store, and what is to come of each."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from reports.store.manifest import MOST_BYTES
from reports.store.part import write_part
from tests.worlds.tiers import few

Change = Callable[[Path], object]
LATER = 10**20 - 10
"""A time of writing after all others [ns]."""


@dataclass(frozen=True)
class Case:
    """A damage, what the notice says of it, and how many of the four cells can still be read.

    ``cure`` is what mends it; ``gate`` the exit code of `diff` with the whole store.
    """

    change: Change
    words: str
    cells: int = 4
    cure: str = "sweep"
    gate: int = 0


def first(folder: Path, table: str) -> Path:
    """The part with MuJoCo's two cells."""
    return min((folder / table).glob(f"{table}-*"))


def cut(table: str) -> Change:
    return lambda folder: _write(first(folder, table), first(folder, table).read_bytes()[:-700])


def content(table: str, raw: bytes) -> Change:
    return lambda folder: _write(first(folder, table), raw)


def _write(path: Path, raw: bytes) -> None:
    path.write_bytes(raw)


def gone(*tables: str) -> Change:
    """Remove the first part from some tables."""
    return lambda folder: [first(folder, table).unlink() for table in tables]


def without(table: str) -> Change:
    return lambda folder: shutil.rmtree(folder / table)


def rewritten(folder: Path) -> None:
    path = first(folder, "cells")
    pq.ParquetFile(path).read().to_pandas().to_parquet(path)


def swapped(folder: Path) -> None:
    a, b = sorted((folder / "cells").iterdir())
    other = a.read_bytes()
    shutil.copy(b, a)
    b.write_bytes(other)


def twice(folder: Path) -> None:
    for table in ("cells", "timings"):
        path = first(folder, table)
        _, _time_ns, *rest = path.name.split("-")
        shutil.copy(path, path.with_name("-".join([table, str(LATER), *rest])))


def of_another_store(folder: Path) -> None:
    """Put in a part with two cells that no sweep into this store asked for."""
    rows = pq.ParquetFile(first(folder, "cells")).read()
    for name in ("key", "line"):
        other = pa.array([f"other {value}" for value in rows.column(name).to_pylist()])
        rows = rows.set_column(rows.column_names.index(name), name, other)
    write_part(folder / "cells", "cells", rows, LATER)


def in_another_folder(folder: Path) -> None:
    path = first(folder, "timings")
    shutil.copy(path, folder / "cells" / path.name)


def flipped(folder: Path) -> None:
    path = first(folder, "cells")
    raw = bytearray(path.read_bytes())
    raw[len(raw) // 3] ^= 4
    path.write_bytes(raw)


def in_place(relative: str, make: Change) -> Change:
    """Put something else where a file is; ``*`` stands for the first part."""

    def change(folder: Path) -> None:
        table, _, name = relative.partition("/")
        path = first(folder, table) if name == "*" else folder / relative
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()
        make(path)

    return change


def huge(path: Path) -> None:
    """A byte more than is read, which takes no room."""
    with path.open("wb") as file:
        file.truncate(MOST_BYTES + 1)


def loop(path: Path) -> None:
    path.symlink_to(path.name)


def manifest(change: Callable[[dict[str, object]], object]) -> Change:
    """Change what the manifest says, with what it says of itself as it was."""

    def apply(folder: Path) -> None:
        path = folder / "manifest.json"
        said = json.loads(path.read_text())
        change(said)
        path.write_text(json.dumps(said))

    return apply


def cut_manifest(folder: Path) -> None:
    path = folder / "manifest.json"
    path.write_text(path.read_text()[:500])


def reformat(number: int) -> Callable[[dict[str, object]], object]:
    """As another version of crankcheck would lay it out."""
    return lambda said: said.update(format=number)


def renamed(said: dict[str, object]) -> None:
    said["scenes"] = {name: str(text) + "\n# changed" for name, text in said["scenes"].items()}


def all_cells(folder: Path) -> None:
    for path in (folder / "cells").iterdir():
        path.write_bytes(b"")


CASES = {
    "cut": Case(cut("cells"), "cut short; 2 cells missing", 2, gate=2),
    "empty": Case(content("cells", b""), "cut short; 2 cells missing", 2, gate=2),
    "text": Case(content("cells", b"dear diary"), "cut short; 2 cells missing", 2, gate=2),
    "flipped": Case(flipped, "its checksum differs; 2 cells missing", 2, gate=2),
    "rewritten": Case(rewritten, "its checksum differs; 2 cells missing", 2, gate=2),
    "swapped": Case(swapped, "its checksum differs; 2 cells missing", 0, gate=2),
    "twice": Case(twice, "rows that another part has too"),
    "cut timings": Case(cut("timings"), "cut short; its times are lost"),
    "timings file": Case(
        in_place("timings", lambda path: path.write_text("x")), "in place of a folder; all times"
    ),
    "whole part": Case(gone("cells", "timings"), "not all that its sweeps asked for", 2, gate=2),
    "other store": Case(of_another_store, "no sweep in manifest.json asked for", cure="nothing"),
    "other folder": Case(in_another_folder, "parquet: not of the store", cure="nothing"),
    "cut manifest": Case(cut_manifest, "manifest.json: not JSON", 0, gate=2),
    "no manifest": Case(in_place("manifest.json", lambda _: None), "json: not there", 0, gate=2),
    "other manifest": Case(manifest(renamed), "manifest.json: not as it was written", 0, gate=2),
    "plain manifest": Case(manifest(lambda said: said.pop("seal")), "checksum differs", 0, gate=2),
    "listed": Case(in_place("manifest.json", lambda p: p.write_text("[]")), "a list", 0, gate=2),
    "newer": Case(manifest(reformat(9)), "format 9, written by crankcheck", 0, "anew", gate=2),
    "older": Case(manifest(reformat(1)), "format 1, written by crankcheck", 0, "anew", gate=2),
    "notes": Case(lambda f: (f / "notes.txt").write_text("x"), "notes.txt: not of", cure="nothing"),
    "finder": Case(
        lambda f: (f / "cells" / ".DS_Store").write_text("x"), "cells/.DS_Store: n", cure="nothing"
    ),
    "folder": Case(in_place("cells/*", Path.mkdir), "parquet: a folder; 2 cells", 2, gate=2),
    "manifest folder": Case(
        in_place("manifest.json", Path.mkdir), "manifest.json: a folder", 0, gate=2
    ),
    "pipe": Case(in_place("cells/*", os.mkfifo), "a pipe, no plain file; 2 cells", 2, gate=2),
    "manifest pipe": Case(in_place("manifest.json", os.mkfifo), "json: a pipe", 0, gate=2),
    "manifest too large": Case(
        in_place("manifest.json", huge),
        f"{MOST_BYTES + 1} bytes; at most {MOST_BYTES} are",
        0,
        gate=2,
    ),
    "loop": Case(in_place("cells/*", loop), "Too many levels of symbolic links", 2, gate=2),
    "manifest loop": Case(in_place("manifest.json", loop), "Too many levels", 0, gate=2),
    "timings loop": Case(in_place("timings", loop), "timings: can not be read: Too many levels"),
    "all cells": Case(all_cells, "cut short; 2 cells missing", 0, gate=2),
    "cells file": Case(
        in_place("cells", lambda path: path.write_text("x")), "cells: a file in place of", 0, gate=2
    ),
    "cells folder": Case(without("cells"), "cells: not there; 4 cells missing", 0, gate=2),
}
QUICK = {
    *("cut", "swapped", "twice", "cut timings", "whole part", "other store"),
    *("cut manifest", "newer", "notes", "cells folder"),
}
"""A few that differ in kind."""
SAME = "what is damaged in another way is found by the same sums and names"


def cases(quick: set[str] = QUICK, *cures: str) -> list[object]:
    """The names of all cases with one of these cures, or of all."""
    names = [name for name, case in CASES.items() if not cures or case.cure in cures]
    return few(names, quick.intersection(names), SAME)
