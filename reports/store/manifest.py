"""The manifest of a store, and its damage, in words."""

from __future__ import annotations

import hashlib
import json
import shlex
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped]  # ships no stubs
import pyarrow.compute as pc  # type: ignore[import-untyped]  # as above

from models.errors import CrankcheckError, harmless
from models.files.inputs import UnreadableError, regular_bytes
from reports.output.numbers import count
from reports.output.write import crankcheck_version
from reports.plan.grid import digest

FORMAT = 2
"""Version of the layout, raised where another reader would misread a store."""
TABLES = ("cells", "timings")
"""A row of ``cells`` is a whole cell; ``timings`` are taken later, and belong to it by key."""
TRAJECTORIES, DAMAGED, LOCK = "trajectories", "damaged", ".lock"
TEXT = {
    *("key", "line", "scene", "scene_digest", "engine", "version", "crankcheck", "profile"),
    *("variant", "drive", "verdict", "status", "reason", "failed_rules", "trend"),
    *("force_trend", "convergence_of", "settings", "asked", "warnings", "run_on"),
    *("quantity", "body_kind", "body", "source", "kind", "unit", "series", "processor"),
    *("made", "precision", "springs"),
}
FLAGS = {"gated"}
NESTED: Mapping[str, tuple[str, ...]] = {
    "errors": (
        *("quantity", "body_kind", "body", "source", "kind", "unit"),
        *("maximum", "rms", "final", "maximum_pure", "limit_pure"),
        *("time_of_maximum_s", "driver_at_maximum_rad", "reference_bound", "samples"),
    ),
    "trace": ("series", "values"),
}
"""Columns of a cell that hold rows of their own, and the names in these."""


def table(rows: Sequence[Mapping[str, object]]) -> pa.Table:
    """Return rows as a table whose types do not depend on missing values; columns that a row lacks,
    as one of rigid links beside one of elastic ones, are null.

    Columns are text, flags, lists of numbers (``values``), lists of rows, or numbers; missing
    values are null.
    """
    names = dict.fromkeys(name for row in rows for name in row)
    return pa.table(
        {
            name: pa.array([_plain(row.get(name)) for row in rows], type=_type(name))
            for name in names
        }
    )


def unnested(cells: pa.Table, name: str) -> pa.Table:
    """Return the rows that a column of some cells holds, each with the key of its cell."""
    nested = cells.column(name).combine_chunks()
    keys = cells.column("key").take(pc.list_parent_indices(nested))
    return pa.Table.from_struct_array(pc.list_flatten(nested)).add_column(0, "key", keys)


def _type(name: str) -> pa.DataType:
    if name in NESTED:
        return pa.list_(pa.struct([(field, _type(field)) for field in NESTED[name]]))
    if name in TEXT:
        return pa.string()
    if name in FLAGS:
        return pa.bool_()
    return pa.list_(pa.float64()) if name == "values" else pa.float64()


def _plain(value: object) -> object:
    """Return a value as Arrow takes it: settings become JSON."""
    if isinstance(value, Mapping):
        return json.dumps(value)
    if isinstance(value, list):
        return [{name: _plain(each) for name, each in row.items()} for row in value]
    if isinstance(value, bool | str | np.ndarray) or value is None:
        return value
    return float(value)  # type: ignore[arg-type]  # all that is left are numbers


Cure = Literal["sweep", "wait", "nothing"]
BUSY = "a sweep is writing here: its finished cells are shown"
MOST_LINES = 20
"""Lines of a notice; more of them are counted."""
COMMANDS = 3


@dataclass(frozen=True)
class Damage:
    """One fault of a store.

    ``path`` is the path of the file or folder in the store. ``lost`` is how many cells can not be
    read for it. ``cure`` repairs it: the same sweep again, waiting for the sweep that writes it
    now, or nothing, since nothing is lost. ``aside`` says that it must be moved before the cure.
    """

    path: str
    what: str
    cure: Cure = "sweep"
    lost: int = 0
    aside: bool = False

    @property
    def line(self) -> str:
        """Fault in a line: path, fault, and the number of cells that it costs."""
        said = in_line(f"{self.path}: {self.what}")
        return f"{said}; {count(self.lost, 'cell')} missing" if self.lost else said


def in_line(text: str) -> str:
    """Return a text without characters that a terminal would obey, in one line."""
    return harmless(text).replace("\n", "\\n").replace("\t", "\\t")


def notice(
    folder: object, damage: Sequence[Damage], safe: int, runs: Sequence[object]
) -> list[str]:
    """Return the lines that name every damage of a store once; none where there is none. ``safe``
    is how many cells can be read, the commands of ``runs`` repair it (see `command`)."""
    if not damage:
        return []
    bad = [each.line for each in damage if each.cure == "sweep"]
    other = [each.line for each in damage if each.cure == "nothing"]
    busy = f"{BUSY}; " * any(each.cure == "wait" for each in damage)
    lost = sum(each.lost for each in damage) or "none"
    whole = "not whole; " * bool(bad)
    head = f"{folder}: {busy}{whole}{count(safe, 'cell')} can be read, {lost} missing"
    if not bad:
        return [f"{head}; there is also", *indented(other)] if other else [head]
    cure = (
        f"to repair it: {command(folder, runs)}",
        f"(moves damaged files to {folder}/damaged, and runs missing cells)",
    )
    return [head, *indented([*bad, *other]), *indented(cure)]


def command(folder: object, runs: Sequence[object]) -> str:
    """Return the commands that filled a store, the last first, as far as its runs know them."""
    typed = [run.get("command") for run in reversed(runs) if isinstance(run, Mapping)]
    sweeps = dict.fromkeys(
        shlex.join(map(str, words))
        for words in typed
        if isinstance(words, list) and words[1:2] == ["sweep"]
    )
    usual = f"crankcheck sweep -o {shlex.quote(str(folder))}, with the options it was made with"
    return in_line("; ".join(list(sweeps)[:COMMANDS])) or usual


def indented(lines: Sequence[str]) -> list[str]:
    """Return lines below a head, no more than anyone reads."""
    more = [f"  and {len(lines) - MOST_LINES} more"] if len(lines) > MOST_LINES else []
    return [*(f"  {line}" for line in lines[:MOST_LINES]), *more]


MANIFEST = "manifest.json"
MOST_BYTES = 100_000_000
"""Most bytes of a manifest: a sweep of 100,000 cells adds a tenth of it."""


@dataclass(frozen=True)
class Manifest:
    """Texts of the scenes by name; per run its command, study, versions, processor and time."""

    scenes: Mapping[str, str] = field(default_factory=dict)
    runs: tuple[Mapping[str, Any], ...] = ()

    @cached_property
    def lines(self) -> frozenset[str]:
        """Lines of cells that its runs requested."""
        return frozenset(line for run in self.runs for line in run.get("lines", {}))

    def joined(
        self, later: Manifest, folder: Path, digests: Collection[tuple[str, str]]
    ) -> Manifest:
        """Return this one and a later run; ``digests`` are names and hashes of scenes with cells.

        Raises CrankcheckError where a scene has changed since.
        """
        for name, text in later.scenes.items():
            if name in dict(digests) and (name, digest(text)) not in digests:
                raise CrankcheckError(
                    f"{folder}: holds results of another scene called {name}; rename the scene, or "
                    "choose another folder"
                )
        return Manifest({**self.scenes, **later.scenes}, (*self.runs, *later.runs))

    def covers(self, later: Manifest) -> bool:
        """True if a later run that finds all its cells adds nothing: it has the same names for the
        cells as the last one, and requests no others."""
        if not self.runs or not set(later.scenes.items()) <= set(self.scenes.items()):
            return False
        return all(run.get("lines") == self.runs[-1].get("lines") for run in later.runs)

    def text(self) -> str:
        """Return the text of the file."""
        said = {"scenes": dict(self.scenes), "runs": list(self.runs)}
        content = {"format": FORMAT, "seal": _seal(said), **said}
        return json.dumps(content, indent=1) + "\n"


def read_manifest(folder: Path) -> Manifest:
    """Return the manifest of a store. Raises UnreadableError for one that can not be read, is not
    JSON, or not as it was written; CrankcheckError for another format, which is left alone."""
    try:
        raw = json.loads(regular_bytes(folder / MANIFEST, MOST_BYTES).decode())
    except (ValueError, RecursionError) as error:
        raise UnreadableError(f"not JSON ({' '.join(str(error).split())[:120]})") from None
    if not isinstance(raw, dict):
        raise UnreadableError(f"no manifest: a {type(raw).__name__}")
    scenes, runs = raw.get("scenes"), raw.get("runs")
    if raw.get("format", FORMAT) != FORMAT:
        raise CrankcheckError(_of_another_format(folder, raw["format"], runs))
    if not (isinstance(scenes, dict) and isinstance(runs, list)):
        raise UnreadableError("no manifest: without scenes or runs, or with others than a sweep's")
    if raw.get("seal") != _seal({"scenes": scenes, "runs": runs}):
        raise UnreadableError("changed since it was written: its checksum differs")
    return Manifest(scenes, tuple(runs))


def _seal(said: Mapping[str, object]) -> str:
    """Return a hash of the content of a manifest, independent of its layout."""
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


def _of_another_format(folder: Path, found: object, runs: object) -> str:
    """Return the message on a store of another layout, as far as its manifest is known."""
    listed = runs if isinstance(runs, list) else []
    facts = listed[-1].get("provenance") if listed and isinstance(listed[-1], dict) else None
    writer = facts.get("crankcheck", "?") if isinstance(facts, dict) else "?"
    return in_line(
        f"{folder}: format {found!s:.40}, written by crankcheck {writer!s:.40}; this is "
        f"crankcheck {crankcheck_version()}, which reads format {FORMAT}; move it away, and "
        "make it again: "
    ) + command(folder, listed)
