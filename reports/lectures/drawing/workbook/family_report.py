"""A family of mechanisms as a drawing or a page, put together: its figures, and what stands with
them."""

from __future__ import annotations

from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.saving import saved
from reports.lectures.drawing.workbook.family_curves import KINDS, FamilyCurves
from reports.lectures.drawing.workbook.family_figure import draw_family
from reports.lectures.drawing.workbook.family_page import family_page
from reports.output.provenance import crankcheck_version


def family_drawing(scene: Scene, curves: FamilyCurves, kind: str) -> bytes:
    """Three panels in one file of a kind of figures: svg or pdf."""
    title = _title(scene, curves)
    notes = [f"{scene.source}. {scene.note}".rstrip(), *_notes(scene, curves)]
    return saved(draw_family(curves, title, notes), kind, title)


def family_page_of(scene: Scene, curves: FamilyCurves) -> str:
    """The page as HTML: a figure each of position, velocity and acceleration."""
    title = _title(scene, curves)
    figures = {
        kind: saved(draw_family(curves, "", [], [kind]), "svg", f"{title}: {kind}")
        for kind in KINDS
    }
    return family_page(scene, curves, _notes(scene, curves), figures)


def _title(scene: Scene, curves: FamilyCurves) -> str:
    return f"{scene.name}, family of {curves.name}"


def _notes(scene: Scene, curves: FamilyCurves) -> list[str]:
    """Where the curves come from."""
    speed = "" if curves.name == "omega" else f"; {scene.driver.joint} {describe_law(scene)}"
    return [f"crankcheck {crankcheck_version()}, closed form{speed}."]
