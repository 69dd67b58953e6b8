"""Polygons one after the other: over a turn of the driver's law, or over a free motion."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.drawings.drawn_polygons import DrawnPolygons, polygons_of
from analytic.lectures.drawings.placed_mechanism import PlacedMechanism
from models.laws import ConstantSpeed
from models.motion import Motion
from models.scene import Scene
from reports.compare.free.kept_motion import kept_motion
from reports.describe.free_motion import instants
from reports.drawing.shape import turn_of


@dataclass(frozen=True)
class PolygonCourse:
    """A motion of a scene and the polygons at each of its instants; ``nearest`` is the one that
    stands and moves most like the placement it was asked for with."""

    scene: Scene
    motion: Motion
    drawn: tuple[DrawnPolygons, ...]
    nearest: int

    @staticmethod
    def of(placement: PlacedMechanism, samples: int, most: int, *, steady: bool) -> PolygonCourse:
        """Over a turn of the driver's law at a number of instants, both ends included, with a
        ``steady`` driver at the speed of the placement; over a free motion at as many as it needs,
        up to ``most``. Raises CrankcheckError where the driver goes through no turn.
        """
        scene = placement.scene
        if steady:
            law = ConstantSpeed(placement.driver.theta, placement.driver.omega)
            scene = replace(scene, driver=replace(scene.driver, law=law))
        if scene.is_free:
            samples = min(instants(kept_motion(scene, scene.driver.law.period_s)), most)
        motion = turn_of(scene, samples)
        drawn = tuple(
            polygons_of(PlacedMechanism.standing(scene, motion, sample=at)) for at in range(samples)
        )
        return PolygonCourse(scene, motion, drawn, _nearest(motion, placement))


def _nearest(motion: Motion, placement: PlacedMechanism) -> int:
    link, driver = placement.scene.driver.link, placement.driver
    moved = motion.links[link]
    off = np.abs((moved.theta - driver.theta + math.pi) % math.tau - math.pi)
    other_way = np.sign(moved.omega) * np.sign(driver.omega) < 0.0
    return int(np.argmin(off + math.pi * other_way))
