"""What a store says of itself: its format, the texts of its scenes, and the runs that filled it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from models.errors import CrankcheckError
from reports.plan.key import digest
from reports.store.part import OtherFormatError, UnreadableError, regular_bytes
from reports.store.schema import FORMAT

MANIFEST = "manifest.json"


@dataclass(frozen=True)
class Manifest:
    """Texts of the scenes by name; per run its command, study, versions, processor and time.

    ``sealed`` is false for one that was read without a checksum, and may have changed unseen.
    """

    scenes: Mapping[str, str] = field(default_factory=dict)
    runs: tuple[Mapping[str, object], ...] = ()
    sealed: bool = True

    def joined(
        self, later: Manifest, folder: Path, digests: Mapping[str, Collection[str]]
    ) -> Manifest:
        """This one and a later run; ``digests`` are those of the scenes that there are cells of.

        Raises CrankcheckError where a scene has changed since.
        """
        for name, text in later.scenes.items():
            known = {digest(self.scenes[name])} if name in self.scenes else digests.get(name)
            if known and digest(text) not in known:
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
        Not to be read, not JSON, not as it was written, or of another format.
    """
    try:
        raw = json.loads(regular_bytes(folder / MANIFEST).decode())
    except (ValueError, RecursionError) as error:
        raise UnreadableError(f"not JSON ({' '.join(str(error).split())[:120]})") from None
    if not isinstance(raw, dict):
        raise UnreadableError(f"no manifest: a {type(raw).__name__}")
    if raw.get("format", FORMAT) != FORMAT:
        runs = raw.get("runs")
        raise OtherFormatError(str(raw["format"])[:40], _writer(runs))
    scenes, runs = raw.get("scenes"), raw.get("runs")
    if not (isinstance(scenes, dict) and isinstance(runs, list) and _sound(scenes, runs)):
        raise UnreadableError("no manifest: without scenes or runs, or with others than a sweep's")
    if "seal" in raw and raw["seal"] != _seal({"scenes": scenes, "runs": runs}):
        raise UnreadableError("not as it was written: its checksum differs")
    return Manifest(scenes, tuple(runs), sealed="seal" in raw)


def _seal(said: Mapping[str, object]) -> str:
    """A hash of what a manifest says, however it is laid out."""
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


def _writer(runs: object) -> str:
    """The version of crankcheck that made the last run, as far as a strange manifest tells."""
    last = runs[-1] if isinstance(runs, list) and runs else None
    facts = last.get("provenance") if isinstance(last, dict) else None
    return str(facts.get("crankcheck", "?"))[:40] if isinstance(facts, dict) else "?"


def _sound(scenes: dict[object, object], runs: list[object]) -> bool:
    """Whether scenes and runs are what readers take them for."""
    return all(isinstance(text, str) for text in scenes.values()) and all(
        isinstance(run, dict) and _named(run.get("lines", {})) for run in runs
    )


def _named(lines: object) -> bool:
    """Whether lines have a variant, a profile, and whether they are gated."""
    return isinstance(lines, dict) and all(
        isinstance(name, list) and [type(part) for part in name] == [str, str, bool]
        for name in lines.values()
    )
