"""The page of a family of mechanisms: one HTML file with its curves and numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from models.scene import Scene
from reports.lectures.drawing.workbook import family_section as family
from reports.lectures.drawing.workbook.family_curves import FamilyCurves
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.page.build import Head, assembled


def family_page(
    scene: Scene, curves: FamilyCurves, notes: Sequence[str], figures: Mapping[str, bytes]
) -> str:
    """The page; ``figures`` are SVG files by the kind of what they show."""
    head = Head(
        title=f"crankcheck: {scene.name}, family",
        facts=(count(len(curves.values), "member"), f"crankcheck {crankcheck_version()}"),
        made="",
        first="family",
    )
    return assembled(head, [family.build(scene, curves, notes, figures)])
