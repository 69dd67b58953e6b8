"""The page of a solved scene, put together: its sections, and the figures of what it is asked
for."""

from __future__ import annotations

from analytic.elastic.elastic_motion import ElasticHistory
from analytic.free.free_motion import FreeMotion
from models.scene import Scene
from reports.describe.elastic_course import closely_sampled, drawn_course
from reports.figures.elastic_figures import ELASTIC_FIGURES
from reports.figures.force_figures import FORCE_FIGURES
from reports.figures.force_turn import force_turn
from reports.figures.free_figures import FREE_FIGURES, free_course
from reports.page.scene_page import elastic_page, free_page, scene_page


def page_of(scene: Scene, *, with_forces: bool) -> str:
    """The page as HTML. Raises CrankcheckError as `scene_page`."""
    return scene_page(scene, FORCE_FIGURES.pictures(force_turn(scene)) if with_forces else None)


def elastic_page_of(motion: ElasticHistory) -> str:
    """The page of a motion with elastic links as HTML. Raises CrankcheckError as `elastic_page`."""
    course = drawn_course(motion, closely_sampled(motion.scene, motion.until_s))
    return elastic_page(motion, course, ELASTIC_FIGURES.pictures(course))


def free_page_of(free: FreeMotion) -> str:
    """The page of a free motion as HTML."""
    return free_page(free, FREE_FIGURES.pictures(free_course(free)))
