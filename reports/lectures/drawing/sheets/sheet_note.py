"""What stands at the foot of a sheet."""

from __future__ import annotations

from models.scene import Scene
from reports.output.provenance import crankcheck_version


def sheet_note(scene: Scene) -> str:
    """Who drew it, and where the mechanism comes from."""
    return f"crankcheck {crankcheck_version()}, closed form; {scene.source}"
