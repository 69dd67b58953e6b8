"""What stands at the foot of a sheet, and what is said of elastic links."""

from __future__ import annotations

from models.scene import Scene
from reports.output.provenance import crankcheck_version


def sheet_note(scene: Scene) -> str:
    """Who drew it, and where the mechanism comes from."""
    return f"crankcheck {crankcheck_version()}, closed form; {scene.source}"


def of_elastic(scene: Scene, words: str) -> str:
    """What is said of a scene that has elastic links, of which sheets know none."""
    return words if scene.elastic else ""
