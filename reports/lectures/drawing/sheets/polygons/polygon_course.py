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
from reports.drawing.free_instants import instants
from reports.drawing.shape import turn_of


@dataclass(frozen=True)
class PolygonCourse:
    """A turn of the driver's law and the polygons at each of its instants, both ends included;
    ``nearest`` is the one that stands and moves most like the placement it was asked for with."""

    scene: Scene
    motion: Motion
    drawn: tuple[DrawnPolygons, ...]
    nearest: int
    title = "Polygons over a turn"
    words = "a turn"

    @staticmethod
    def kind(scene: Scene, *, steady: bool) -> type[PolygonCourse]:
        """What a scene is drawn over: with a ``steady`` driver always a turn."""
        return FreeCourse if scene.is_free and not steady else PolygonCourse

    @classmethod
    def of(
        cls, placement: PlacedMechanism, samples: int, most: int, *, steady: bool
    ) -> PolygonCourse:
        """Over a turn of the driver's law at a number of instants, with a ``steady`` driver at the
        speed of the placement; over a free motion at as many as it needs, up to ``most``. Raises
        CrankcheckError where the driver goes through no turn.
        """
        scene = placement.scene
        course = cls.kind(scene, steady=steady)
        if steady:
            law = ConstantSpeed(placement.driver.theta, placement.driver.omega)
            scene = replace(scene, driver=replace(scene.driver, law=law))
        samples = course.instants(scene, samples, most)
        motion = turn_of(scene, samples)
        drawn = tuple(
            polygons_of(PlacedMechanism.standing(scene, motion, sample=at)) for at in range(samples)
        )
        return course(scene, motion, drawn, _nearest(motion, placement))

    @classmethod
    def instants(cls, scene: Scene, samples: int, most: int) -> int:
        """How many there are."""
        return samples

    @property
    def frames(self) -> tuple[DrawnPolygons, ...]:
        """Those that an animation shows again and again: the last comes first again."""
        return self.drawn[:-1]

    @property
    def along(self) -> str:
        """What the slider of a page says."""
        return f"Angle of the {self.scene.driver.link}"

    @property
    def until(self) -> dict[str, object]:
        """What the drawing of a page is told besides."""
        return {}


class FreeCourse(PolygonCourse):
    """A free motion and the polygons at its instants."""

    title = "Polygons over the motion"
    words = "its motion"
    along = "Time"

    @classmethod
    def instants(cls, scene: Scene, samples: int, most: int) -> int:
        return min(instants(kept_motion(scene, scene.driver.law.period_s)), most)

    @property
    def frames(self) -> tuple[DrawnPolygons, ...]:
        return self.drawn

    @property
    def until(self) -> dict[str, object]:
        """The time that it is drawn for [s]: the slider is one of times."""
        return {"until_s": float(self.motion.time_s[-1])}


def _nearest(motion: Motion, placement: PlacedMechanism) -> int:
    link, driver = placement.scene.driver.link, placement.driver
    moved = motion.links[link]
    off = np.abs((moved.theta - driver.theta + math.pi) % math.tau - math.pi)
    other_way = np.sign(moved.omega) * np.sign(driver.omega) < 0.0
    return int(np.argmin(off + math.pi * other_way))
