"""Driven mechanisms with elastic links that tests share (synthetic)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from models.files import load_scene
from models.laws import ConstantSpeed
from models.scene import Scene

SHIPPED = ("fourbar-elastic", "slider-crank-elastic", "sixbar-elastic")


def at_speed(scene: Scene, speed_rad_s: float) -> Scene:
    law = ConstantSpeed(scene.driver.law.offset_rad, speed_rad_s)
    return replace(scene, driver=replace(scene.driver, law=law))


def with_elastic(scene: Scene, **changes: float) -> Scene:
    """The scene with every elastic link changed."""
    return replace(
        scene, elastic={name: replace(own, **changes) for name, own in scene.elastic.items()}
    )


@cache
def fourbar(*, axial_n: float = float("inf"), damping_s: float = 0.0) -> Scene:
    return with_elastic(load_scene("fourbar-elastic"), axial_n=axial_n, damping_s=damping_s)
