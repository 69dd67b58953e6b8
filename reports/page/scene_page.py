"""The page of a solved scene: one HTML file with its motion, and its forces where asked for."""

from __future__ import annotations

from collections.abc import Mapping

from models.scene import Scene
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.scene_sections import forces, motion


def scene_page(scene: Scene, figures: Mapping[str, bytes] | None = None) -> str:
    """The page of a scene; ``figures`` are those of its forces (SVG files by name), None for a page
    without forces.

    Raises CrankcheckError where the driver goes through no turn, or there are no forces.
    """
    sections = [motion.build(scene, with_forces=figures is not None)]
    if figures is not None:
        sections.append(forces.build(scene, figures))
    head = Head(
        title=f"crankcheck: {scene.name}",
        facts=(
            "the closed form",
            count(len(scene.links), "link"),
            *((count(len(scene.loads), "load"),) if scene.loads else ()),
            f"crankcheck {crankcheck_version()}",
        ),
        made="",
        first="motion",
    )
    return assembled(head, sections)
