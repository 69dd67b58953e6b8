"""A scene without its elastic links: the machine that the textbooks have."""

from __future__ import annotations

from dataclasses import replace

from models.scene import Scene


def with_rigid_links(scene: Scene) -> Scene:
    """The scene with all its links rigid."""
    return replace(scene, elastic={}, start=replace(scene.start, shape=None))
