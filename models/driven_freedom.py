"""The joint coordinate of a tree that the driver moves, and its sense."""

from __future__ import annotations

from collections.abc import Sequence

from models.errors import EngineError
from models.scene import Scene
from models.tree import Limb


def driven_freedom(scene: Scene, limbs: Sequence[Limb]) -> tuple[str, float]:
    """Its name, and 1.0 where it reads as the driver's own coordinate, or -1.0 where the driven
    link carries its base.

    Raises
    ------
    EngineError
        The driven joint is none of the tree's.
    """
    driver = scene.driver
    if driver.is_crank:
        return f"{driver.link}.{scene.driver_pivot}", 1.0
    for limb in limbs:
        slides = limb.slider is not None
        if slides and limb.slider.name == driver.slider:  # type: ignore[union-attr]  # it has one
            return next(f.name for f in limb.freedoms if f.kind == "slide"), 1.0
        if (
            not slides
            and limb.point == driver.pin
            and {limb.body, limb.parent}
            == {
                driver.base,
                driver.link,
            }
        ):
            return limb.freedoms[0].name, 1.0 if limb.body == driver.link else -1.0
    raise EngineError(f"{scene.name}: the tree closes a loop at {driver.joint}, which is driven")
