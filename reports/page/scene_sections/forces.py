"""Reactions and driving torque of a scene: the largest of a turn in a table, and the figures."""

from __future__ import annotations

import base64
from collections.abc import Mapping

from models.driver import driver_unit
from models.scene import Scene
from reports.describe.force_tables import friction_words, largest_of
from reports.describe.with_forces import (
    cleaned_forces,
    force_certainty,
    force_notes,
    turn_with_forces,
)
from reports.page.sections.section import Section

CAPTIONS: Mapping[str, str] = {
    "torque": "What drives, and its mean over the turn.",
    "reactions": "How large the reactions are; normal forces of guides with their sign.",
    "reactions-polar": "The tip of each reaction over a turn, drawn from the cross.",
    "efficiency": "What of the drive's power goes on to loads and masses.",
    "reduced": "The machine as one mass that moves with the driver.",
    "forces": "The mechanism where its reactions are largest.",
}
"""What stands under a figure; one that is not here has its name."""


def build(scene: Scene, figures: Mapping[str, bytes]) -> Section:
    """The section; ``figures`` are SVG files by their name."""
    turn = turn_with_forces(scene)
    assert turn.forces is not None
    return Section(
        anchor="forces",
        title="Forces",
        template="scene_forces.html",
        words={
            "driver": scene.driver.joint,
            "effort": scene.driver.effort,
            "degrees": "\N{DEGREE SIGN}" if driver_unit(scene) == "deg" else " m",
            "rows": largest_of(scene, turn, cleaned_forces(turn.forces)),
            "notes": [
                *friction_words(scene),
                *force_notes(scene, turn),
                force_certainty(scene, turn.forces),
            ],
            "figures": [
                (name, CAPTIONS.get(name, name), base64.b64encode(svg).decode("ascii"))
                for name, svg in figures.items()
            ],
        },
        styles=("forces.css",),
    )
