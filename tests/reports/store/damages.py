"""Ways to damage a store, and what is to come of each."""

import json
import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from reports.store.folder import write_part
from reports.store.manifest import MANIFEST, MOST_BYTES
from tests.worlds.tiers import few

Change = Callable[[Path], object]
LATER = 10**20 - 10
"""A time of writing after all others [ns]."""


@dataclass(frozen=True)
class Case:
    """A damage, what the notice says of it, how many of the four cells can still be read, and to
    repair it."""

    change: Change
    words: str
    cells: int = 4
    cure: str = "sweep"

    @property
    def gate(self) -> int:
        """The exit code of `diff` with the whole store."""
        return 0 if self.cells == 4 else 2


def first(folder: Path, table: str) -> Path:
    """The part with MuJoCo's two cells."""
    return min((folder / table).glob(f"{table}-*"))


def _at(folder: Path, relative: str) -> Path:
    """A path in a store; ``*`` stands for the first part of a table."""
    table, _, name = relative.partition("/")
    return first(folder, table) if name == "*" else folder / relative


def spoiled(relative: str, change: Callable[[bytes], bytes]) -> Change:
    return lambda f: _at(f, relative).write_bytes(change(_at(f, relative).read_bytes()))


def cut(table: str) -> Change:
    return spoiled(f"{table}/*", lambda raw: raw[:-700])


def flipped(raw: bytes) -> bytes:
    at = len(raw) // 3
    return raw[:at] + bytes([raw[at] ^ 4]) + raw[at + 1 :]


def manifest(change: Callable[[dict[str, Any]], object]) -> Change:
    def changed(raw: bytes) -> bytes:
        said = json.loads(raw)
        change(said)
        return json.dumps(said).encode()

    return spoiled(MANIFEST, changed)


def renamed(said: dict[str, Any]) -> None:
    said["scenes"] = {name: f"{text}\n# changed" for name, text in said["scenes"].items()}


def gone(*tables: str) -> Change:
    return lambda folder: [first(folder, table).unlink() for table in tables]


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


def in_place(relative: str, make: Change) -> Change:

    def change(folder: Path) -> None:
        path = _at(folder, relative)
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()
        make(path)

    return change


def text(path: Path) -> None:
    path.write_text("x")


def huge(path: Path) -> None:
    """A byte more than is read, which takes no room."""
    path.touch()
    os.truncate(path, MOST_BYTES + 1)


def loop(path: Path) -> None:
    path.symlink_to(path.name)


PART = "cells/*"
CUT = "cut short; 2 cells missing"
OTHER_SUM = "its checksum differs; 2 cells missing"
CASES = {
    "cut": Case(cut("cells"), CUT, 2),
    "flipped": Case(spoiled(PART, flipped), OTHER_SUM, 2),
    "swapped": Case(swapped, OTHER_SUM, 0),
    "twice": Case(twice, "rows that another part has too"),
    "cut timings": Case(cut("timings"), "cut short; its times are lost"),
    "timings file": Case(in_place("timings", text), "in place of a folder; all times"),
    "whole part": Case(gone("cells", "timings"), "fewer cells than its sweeps requested", 2),
    "other store": Case(of_another_store, "no sweep in manifest.json requested", cure="nothing"),
    "other folder": Case(
        lambda f: shutil.copy(first(f, "timings"), f / "cells"),
        "parquet: not of the store",
        cure="nothing",
    ),
    "cut manifest": Case(spoiled(MANIFEST, lambda raw: raw[:500]), "manifest.json: not JSON", 0),
    "no manifest": Case(lambda f: (f / MANIFEST).unlink(), "json: not there", 0),
    "other manifest": Case(manifest(renamed), "manifest.json: changed since it was written", 0),
    "plain manifest": Case(manifest(lambda said: said.pop("seal")), "checksum differs", 0),
    "newer": Case(
        manifest(lambda said: said.update(format=9)), "format 9, written by crankcheck", 0, "anew"
    ),
    "notes": Case(lambda f: text(f / "notes.txt"), "notes.txt: not of", cure="nothing"),
    "pipe": Case(in_place(PART, os.mkfifo), "a pipe, not a plain file; 2 cells", 2),
    "manifest too large": Case(
        in_place(MANIFEST, huge), f"{MOST_BYTES + 1} bytes; at most {MOST_BYTES} are", 0
    ),
    "loop": Case(in_place(PART, loop), "Too many levels of symbolic links", 2),
    "cells file": Case(in_place("cells", text), "cells: a file in place of", 0),
    "cells folder": Case(
        lambda f: shutil.rmtree(f / "cells"), "cells: not there; 4 cells missing", 0
    ),
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
