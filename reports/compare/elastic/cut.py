"""What elastic links are given to an engine as: segments with springs, or beams of its own."""

from __future__ import annotations

from models.cut_links import CutScene
from models.cut_scenes import BeamedScene, SegmentedScene
from models.scene import Scene


def cut(scene: Scene, count: int, springs: str) -> CutScene:
    """The links of a scene in so many segments, with springs "plain" or "corrected"; or in so many
    elements of a "beam". Raises CrankcheckError as these do."""
    if springs == "beam":
        return BeamedScene(scene, count)
    return SegmentedScene(scene, count, springs == "corrected")
