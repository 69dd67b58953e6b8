"""A scene that is let go, in motion, and the figures of its free motion."""

from __future__ import annotations

import base64
from collections.abc import Mapping

import numpy as np

from analytic.free.free_motion import FreeMotion
from reports.describe.free_motion import free_notes, instants
from reports.drawing.moving import drawing
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section
from reports.plan.singular import continued_note

CAPTIONS: Mapping[str, str] = {
    "over-time": "The driver's angle and angular velocity.",
    "energy": "What the motion keeps of its energy, and what is done on it.",
    "phase": "The driver's angular velocity over its angle.",
}
"""What stands under a figure; one that is not here has its name."""
SHORTEST_MS, LONGEST_MS = 4000, 12000
"""What a round may take."""


def build(free: FreeMotion, figures: Mapping[str, bytes]) -> Section:
    """The section; ``figures`` are SVG files by their name."""
    time_s = np.linspace(0.0, free.until_s, instants(free))
    motion = free.at(time_s, bound=False)
    drawn = drawing(free.scene, time_s, motion)
    lasts_ms = float(np.clip(1000.0 * free.until_s, SHORTEST_MS, LONGEST_MS))
    return Section(
        anchor="motion",
        title="In motion",
        template="scene_free.html",
        words={
            "scene": scene_words(free.scene),
            "notes": [
                *filter(None, (*free_notes(free, free.until_s), continued_note(free.scene, motion)))
            ],
            "figures": [
                (name, CAPTIONS.get(name, name), base64.b64encode(svg).decode("ascii"))
                for name, svg in figures.items()
            ],
        },
        embedded={"drawing": drawn | {"until_s": free.until_s}, "lasts_ms": lasts_ms},
        scripts=("arrows.js", "mechanism.js", "stage.js", "scene_free.js"),
        styles=("forces.css",),
    )
