"""The page of a solved scene, put together: its sections, and the figures of its forces."""

from __future__ import annotations

from models.scene import Scene
from reports.figures.forces.writing import drawn_figures
from reports.figures.saving import saved
from reports.page.scene_page import scene_page


def page_of(scene: Scene, *, with_forces: bool) -> str:
    """The page as HTML. Raises CrankcheckError as `scene_page`."""
    if not with_forces:
        return scene_page(scene)
    figures = {
        name: saved(figure, "svg", f"{scene.name}: {name}") for name, figure in drawn_figures(scene)
    }
    return scene_page(scene, figures)
