"""The files of stored runs that a command reads, and so does not write over."""

from __future__ import annotations

from pathlib import Path

from reports.results.changes.reading import CELLS, FACTS
from reports.store.folder import paths_of
from reports.store.manifest import MANIFEST
from reports.store.schema import TABLES


def stored_files(*folders: Path | None) -> list[Path]:
    """What is read of the folders of sweeps and verifications; some of it may not be there."""
    return [
        path
        for folder in filter(None, folders)
        for path in (
            *(folder / name for name in (MANIFEST, CELLS, FACTS)),
            *(part for table in TABLES for part in paths_of(folder, table)),
        )
    ]
