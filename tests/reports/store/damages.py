"""Ways to damage a store, and what is to come of each."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
import pyarrow.parquet as pq

Change = Callable[[Path], object]
LATER = "part-99999999999999999999-1-0.parquet"


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
    return min((folder / table).glob("part-*"))


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


def foreign(folder: Path) -> None:
    pd.DataFrame({"wing": [1.0]}).to_parquet(first(folder, "cells"))


def words_for_numbers(folder: Path) -> None:
    frame = pq.ParquetFile(first(folder, "cells")).read().to_pandas()
    frame["place_pure"] = "large"
    frame.to_parquet(first(folder, "cells"))


def rewritten(folder: Path) -> None:
    path = first(folder, "cells")
    pq.ParquetFile(path).read().to_pandas().to_parquet(path)


def reformat(number: int) -> Change:
    """Write the first part of cells as another version of crankcheck would."""

    def change(folder: Path) -> None:
        import pytest

        from reports.store import part

        path = first(folder, "cells")
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(part, "FORMAT", number)
            path.write_bytes(part.part_bytes(pq.ParquetFile(path).read()))

    return change


def twice(folder: Path) -> None:
    for table in ("cells", "errors", "traces", "timings"):
        shutil.copy(first(folder, table), folder / table / LATER)


def cells_twice(folder: Path) -> None:
    shutil.copy(first(folder, "cells"), folder / "cells" / LATER)


def strange_errors(folder: Path) -> None:
    a, b = sorted((folder / "errors").glob("part-*"))
    shutil.copy(b, a)


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


def renamed(said: dict[str, object]) -> None:
    said["scenes"] = {name: str(text) + "\n# changed" for name, text in said["scenes"].items()}


def all_cells(folder: Path) -> None:
    for path in (folder / "cells").iterdir():
        path.write_bytes(b"")


CASES = {
    "cut": Case(cut("cells"), "cut short; 2 cells missing", 2, gate=2),
    "empty": Case(content("cells", b""), "empty; 2 cells missing", 2, gate=2),
    "text": Case(content("cells", b"dear diary"), "no Parquet file; 2 cells missing", 2, gate=2),
    "foreign": Case(foreign, "table cells (no column key); 2 cells missing", 2, gate=2),
    "words": Case(words_for_numbers, "no part of the table cells", 2, gate=2),
    "flipped": Case(flipped, "its checksum differs; 2 cells missing", 2, gate=2),
    "newer": Case(reformat(2), "format 2, written by crankcheck", 2, "version", gate=2),
    "older": Case(reformat(0), "format 0, written by crankcheck", 2, "version", gate=2),
    "rewritten": Case(rewritten, "without a checksum", cure="nothing"),
    "twice": Case(twice, "rows that another part has too"),
    "cells twice": Case(cells_twice, "rows that another part has too"),
    "no cells": Case(gone("cells"), "not there, though its errors are; 2 cells", 2, gate=2),
    "no errors": Case(gone("errors"), "not there; 2 cells without errors"),
    "no traces": Case(gone("traces"), "not there; 2 cells without traces"),
    "neither": Case(gone("errors", "traces"), "not there; 2 cells without errors"),
    "errors folder": Case(without("errors"), "errors: not there; 4 cells without errors"),
    "traces folder": Case(without("traces"), "traces: not there; 4 cells without traces"),
    "cut errors": Case(cut("errors"), "cut short; 2 cells without errors"),
    "cut traces": Case(cut("traces"), "cut short; 2 cells without traces"),
    "cut timings": Case(cut("timings"), "cut short; its times are lost"),
    "strange errors": Case(strange_errors, "holds rows that are of no cell"),
    "whole part": Case(
        gone("cells", "errors", "traces", "timings"), "not all that its sweeps asked for", 2, gate=2
    ),
    "cut manifest": Case(cut_manifest, "manifest.json: not JSON"),
    "no manifest": Case(lambda folder: (folder / "manifest.json").unlink(), "json: not there"),
    "other manifest": Case(manifest(renamed), "manifest.json: not as it was written"),
    "listed": Case(in_place("manifest.json", lambda p: p.write_text("[]")), "a list"),
    "newer manifest": Case(
        manifest(lambda said: said.update(format=9)), "format 9, written by", cure="version"
    ),
    "plain manifest": Case(manifest(lambda s: s.pop("seal")), "without a checksum", cure="nothing"),
    "notes": Case(lambda f: (f / "notes.txt").write_text("x"), "notes.txt: not of", cure="nothing"),
    "finder": Case(
        lambda f: (f / "cells" / ".DS_Store").write_text("x"), "cells/.DS_Store: n", cure="nothing"
    ),
    "folder": Case(in_place("cells/*", Path.mkdir), "parquet: a folder; 2 cells", 2, gate=2),
    "manifest folder": Case(in_place("manifest.json", Path.mkdir), "manifest.json: a folder"),
    "loop": Case(in_place("cells/*", loop), "Too many levels of symbolic links", 2, gate=2),
    "manifest loop": Case(in_place("manifest.json", loop), "Too many levels of symbolic links"),
    "errors loop": Case(in_place("errors", loop), "errors: can not be read: Too many levels"),
    "errors file": Case(
        in_place("errors", lambda path: path.write_text("x")), "errors: a file in place of a folder"
    ),
    "all cells": Case(all_cells, "empty; 2 cells missing", 0, gate=2),
    "cells file": Case(
        in_place("cells", lambda path: path.write_text("x")), "cells: a file in place of", 0, gate=2
    ),
    "cells folder": Case(without("cells"), "cells: not there; 4 cells missing", 0, gate=2),
}
