"""What only mechanisms of class II that a crank drives have."""

from __future__ import annotations

from analytic.structure.mobility import Structure
from models.errors import CrankcheckError
from models.scene import Scene


def refuse_other_than_cranked(scene: Scene, what: str, structure: Structure | None = None) -> None:
    """Raise CrankcheckError, for ``what`` is worked out of a crank at the ground and class II
    groups alone, where the driver of a scene is another joint or its structure has a triad."""
    if not scene.driver.is_crank:
        raise CrankcheckError(
            f"{scene.name}: {what} takes a driver that is a link pinned to the ground, and this "
            f"scene's is {scene.driver.joint}"
        )
    triads = ", ".join(triad.central for triad in structure.triads) if structure else ""
    if triads:
        raise CrankcheckError(
            f"{scene.name}: {what} takes class II groups alone, and this scene has a group of "
            f"class III about {triads}"
        )
