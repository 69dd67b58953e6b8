"""A family of mechanisms: its curves, and the extremes of each member."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence

from models.scene import Scene
from reports.lectures.drawing.workbook.family_curves import FamilyCurves, extremes
from reports.page.sections.section import Section


def build(
    scene: Scene, curves: FamilyCurves, notes: Sequence[str], figures: Mapping[str, bytes]
) -> Section:
    """The section; ``figures`` are SVG files by the kind of what they show."""
    return Section(
        anchor="family",
        title=f"Members over {curves.name}",
        template="scene_family.html",
        words={
            "source": f"{scene.source}. {scene.note}".rstrip(),
            "name": curves.name,
            "labels": [chart.label for chart in curves.charts],
            "rows": extremes(curves),
            "notes": notes,
            "figures": [
                (kind, f"{kind.capitalize()} over the angle of the crank.", _encoded(svg))
                for kind, svg in figures.items()
            ],
        },
        styles=("forces.css",),
    )


def _encoded(svg: bytes) -> str:
    return base64.b64encode(svg).decode("ascii")
