"""What a store says of itself: its format, the texts of its scenes, and the runs that filled it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from models.errors import CrankcheckError
from models.files.inputs import UnreadableError, regular_bytes
from reports.output.provenance import crankcheck_version
from reports.plan.grid import digest
from reports.store.damage import command, in_line
from reports.store.schema import FORMAT

MANIFEST = "manifest.json"
MOST_BYTES = 100_000_000
"""A sweep of 100,000 cells adds a tenth of it."""


@dataclass(frozen=True)
class Manifest:
    """Texts of the scenes by name; per run its command, study, versions, processor and time."""

    scenes: Mapping[str, str] = field(default_factory=dict)
    runs: tuple[Mapping[str, Any], ...] = ()

    @cached_property
    def lines(self) -> frozenset[str]:
        """The lines of cells that its runs asked for."""
        return frozenset(line for run in self.runs for line in run.get("lines", {}))

    def joined(
        self, later: Manifest, folder: Path, digests: Collection[tuple[str, str]]
    ) -> Manifest:
        """This one and a later run; ``digests`` are the names and hashes of the scenes that there
        are cells of.

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
        """Whether a later run, where it finds everything there, would tell nothing new: it calls
        the cells what the last one called them, and asks for no others."""
        if not self.runs or not set(later.scenes.items()) <= set(self.scenes.items()):
            return False
        return all(run.get("lines") == self.runs[-1].get("lines") for run in later.runs)

    def text(self) -> str:
        """As it stands in the file."""
        said = {"scenes": dict(self.scenes), "runs": list(self.runs)}
        content = {"format": FORMAT, "seal": _seal(said), **said}
        return json.dumps(content, indent=1) + "\n"


def read_manifest(folder: Path) -> Manifest:
    """The manifest of a store.

    Raises
    ------
    UnreadableError
        Not to be read, not JSON, or not as it was written.
    CrankcheckError
        One of another format, which is left alone.
    """
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
        raise UnreadableError("not as it was written: its checksum differs")
    return Manifest(scenes, tuple(runs))


def _seal(said: Mapping[str, object]) -> str:
    """A hash of what a manifest says, however it is laid out."""
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


def _of_another_format(folder: Path, found: object, runs: object) -> str:
    """What is said of a store that is laid out in another way, as far as its manifest tells."""
    listed = runs if isinstance(runs, list) else []
    facts = listed[-1].get("provenance") if listed and isinstance(listed[-1], dict) else None
    writer = facts.get("crankcheck", "?") if isinstance(facts, dict) else "?"
    return in_line(
        f"{folder}: format {found!s:.40}, written by crankcheck {writer!s:.40}; this is crankcheck "
        f"{crankcheck_version()}, which reads format {FORMAT}; move it away, and make it anew: "
    ) + command(folder, listed)
