"""The page of a solved scene, put together: its sections, and the figures of what it is asked
for."""

from __future__ import annotations

from analytic.elastic.elastic_motion import ElasticHistory
from analytic.free.free_motion import FreeMotion
from models.scene import Scene
from reports.describe.elastic_course import closely_sampled, drawn_course
from reports.figures.elastic.writing import drawn_elastic_figures
from reports.figures.forces.writing import drawn_figures
from reports.figures.free.writing import drawn_free_figures
from reports.figures.saving import saved
from reports.page.scene_page import elastic_page, free_page, scene_page


def page_of(scene: Scene, *, with_forces: bool) -> str:
    """The page as HTML. Raises CrankcheckError as `scene_page`."""
    if not with_forces:
        return scene_page(scene)
    figures = {
        name: saved(figure, "svg", f"{scene.name}: {name}") for name, figure in drawn_figures(scene)
    }
    return scene_page(scene, figures)


def elastic_page_of(motion: ElasticHistory) -> str:
    """The page of a motion with elastic links as HTML. Raises CrankcheckError as `elastic_page`."""
    course = drawn_course(motion, closely_sampled(motion.scene, motion.until_s))
    return elastic_page(
        motion,
        course,
        {
            name: saved(figure, "svg", f"{motion.scene.name}: {name}")
            for name, figure in drawn_elastic_figures(course)
        },
    )


def free_page_of(free: FreeMotion) -> str:
    """The page of a free motion as HTML."""
    return free_page(
        free,
        {
            name: saved(figure, "svg", f"{free.scene.name}: {name}")
            for name, figure in drawn_free_figures(free)
        },
    )
