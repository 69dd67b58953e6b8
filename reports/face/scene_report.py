"""The page of a solved scene, put together: its sections, and the figures of what it is asked
for."""

from __future__ import annotations

from analytic.free.free_motion import FreeMotion
from models.scene import Scene
from reports.figures.forces.writing import drawn_figures
from reports.figures.free.writing import drawn_free_figures
from reports.figures.saving import saved
from reports.page.scene_page import free_page, scene_page


def page_of(scene: Scene, *, with_forces: bool) -> str:
    """The page as HTML. Raises CrankcheckError as `scene_page`."""
    if not with_forces:
        return scene_page(scene)
    figures = {
        name: saved(figure, "svg", f"{scene.name}: {name}") for name, figure in drawn_figures(scene)
    }
    return scene_page(scene, figures)


def free_page_of(free: FreeMotion) -> str:
    """The page of a free motion as HTML."""
    return free_page(
        free,
        {
            name: saved(figure, "svg", f"{free.scene.name}: {name}")
            for name, figure in drawn_free_figures(free)
        },
    )
