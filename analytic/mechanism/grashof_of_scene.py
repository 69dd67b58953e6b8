"""The Grashof type of a scene that is a four-bar, a slider-crank or an inverted slider-crank."""

from __future__ import annotations

import math

from analytic.mechanism.fourbar import FourBar
from analytic.mechanism.grashof import (
    GrashofType,
    four_bar_type,
    inverted_slider_crank_type,
    slider_crank_type,
)
from analytic.structure.groups import Group
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.scene import GROUND, Point, Scene, Slider


def grashof_of(scene: Scene) -> GrashofType | None:
    """What a scene is called; None of one that is no such chain. Raises StructureError."""
    structure = analyse(scene)
    if len(structure.order) != 1 or len(structure.groups) != 1 or not scene.driver.is_crank:
        return None
    group = structure.groups[0]
    try:
        if group.kind == "RRR":
            return four_bar_type(FourBar.of(scene))
        if group.kind == "RRP":
            return _slider_crank(scene, group, scene.sliders[group.outer2])
        if group.kind == "RPR":
            return _inverted(scene, group, scene.sliders[group.inner])
    except (ValueError, StructureError):
        return None  # one body holds both ends, or it closes nowhere
    return None


def _slider_crank(scene: Scene, group: Group, slider: Slider) -> GrashofType | None:
    """Of a crank, a rod and a block on the ground."""
    crank, rod = scene.links[scene.driver.link].points, scene.links[group.first].points
    if slider.link is not None or slider.on != GROUND or group.outer1 not in crank:
        return None
    pivot = scene.driver_pivot
    offset = _beside(scene.ground[pivot], slider)
    crank_m = math.dist(crank[pivot], crank[group.outer1])
    return slider_crank_type(crank_m, math.dist(rod[group.outer1], rod[group.inner]), offset)


def _inverted(scene: Scene, group: Group, slider: Slider) -> GrashofType | None:
    """Of a crank, a block pinned to it, and a guide pinned to the ground."""
    crank, pivot = scene.links[scene.driver.link].points, scene.driver_pivot
    pins = (group.outer1, group.outer2)
    held = next((pin for pin in pins if pin in scene.ground), None)
    if slider.link is not None or slider.on not in scene.links or held is None:
        return None
    guide = scene.links[slider.on].points
    if held not in guide or slider.point not in crank:
        return None
    crank_m = math.dist(crank[pivot], crank[slider.point])
    ground_m = math.dist(scene.ground[pivot], scene.ground[held])
    return inverted_slider_crank_type(crank_m, ground_m, _beside(guide[held], slider))


def _beside(point: Point, slider: Slider) -> float:
    """How far a point of the slider's guide is from its line [m]."""
    x, y = point[0] - slider.through_m[0], point[1] - slider.through_m[1]
    return abs(y * math.cos(slider.direction_rad) - x * math.sin(slider.direction_rad))
