"""A scene in motion as the closed form has it, with its forces where they were asked for."""

from __future__ import annotations

import numpy as np

from models.motion import Motion
from models.scene import Scene
from reports.drawing.force_arrows import force_arrows
from reports.drawing.moving import INSTANTS, drawing
from reports.drawing.packed import packed
from reports.drawing.shape import turn_of
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section


def build(scene: Scene, *, with_forces: bool) -> Section:
    """The section. Raises CrankcheckError where the driver goes through no turn."""
    turn = turn_of(scene, INSTANTS, with_forces=with_forces)
    drawn = drawing(scene, turn.time_s, turn)
    if turn.forces is not None:
        arrows = force_arrows(scene, turn)
        low, high = arrows.box(turn)
        drawn |= {"forces": arrows.embedded(turn), "box": [*low, *high]}
    return Section(
        anchor="motion",
        title="In motion",
        template="scene_motion.html",
        words={
            "scene": scene_words(scene),
            "has_arrows": "forces" in drawn and bool(drawn["forces"]["arrows"]),  # type: ignore[index]  # as embedded
            "with_forces": with_forces,
        },
        embedded={"drawing": drawn, "effort": _effort(scene, turn)},
        scripts=("arrows.js", "mechanism.js", "stage.js", "scene_motion.js"),
        styles=("forces.css",),
    )


def _effort(scene: Scene, turn: Motion) -> dict[str, object] | None:
    """What drives at the instants of the drawing: a torque, or a force."""
    if turn.forces is None:
        return None
    series = packed(np.atleast_2d(turn.forces.torque))
    return {"name": scene.driver.effort, "unit": scene.driver.effort_unit, "series": series}
