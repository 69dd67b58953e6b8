"""What a store says of itself: its format, the texts of its scenes, and the runs that filled it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from models.errors import CrankcheckError
from reports.store.key import digest

MANIFEST = "manifest.json"
FORMAT = 1


@dataclass(frozen=True)
class Manifest:
    """Texts of the scenes by name; per run its command, study, versions, processor and time."""

    scenes: Mapping[str, str] = field(default_factory=dict)
    runs: tuple[Mapping[str, object], ...] = ()

    def joined(self, later: Manifest, folder: Path) -> Manifest:
        """This one and a later run. Raises CrankcheckError where a scene has changed since."""
        for name, text in later.scenes.items():
            if name in self.scenes and digest(self.scenes[name]) != digest(text):
                raise CrankcheckError(
                    f"{folder}: holds results of another scene called {name}; rename the scene, or "
                    "choose another folder"
                )
        return Manifest({**self.scenes, **later.scenes}, (*self.runs, *later.runs))

    def text(self) -> str:
        """As it stands in the file."""
        content = {"format": FORMAT, "scenes": dict(self.scenes), "runs": list(self.runs)}
        return json.dumps(content, indent=1) + "\n"


def read_manifest(folder: Path) -> Manifest:
    """The manifest of a store, an empty one where there is none yet.

    Raises
    ------
    CrankcheckError
        Not to be read, not JSON, or of another format.
    """
    path = folder / MANIFEST
    try:
        raw = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return Manifest()
    except (OSError, ValueError) as error:
        raise CrankcheckError(f"{path}: can not be read ({error}); is it cut short?") from None
    if not isinstance(raw, dict) or raw.get("format") != FORMAT:
        found = raw.get("format") if isinstance(raw, dict) else type(raw).__name__
        raise CrankcheckError(
            f"{path}: format {found}; this version of crankcheck reads format {FORMAT}"
        )
    if not (isinstance(raw.get("scenes"), dict) and isinstance(raw.get("runs"), list)):
        raise CrankcheckError(f"{path}: has no scenes or no runs; is it cut short?")
    return Manifest(raw["scenes"], tuple(raw["runs"]))
