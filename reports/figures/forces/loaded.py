"""The mechanism where its reactions are largest, with the forces as arrows to one scale."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from models.driver_shown import driver_stands
from reports.drawing.force_arrows import force_arrows
from reports.drawing.gif import draw_arrows, draw_bodies, scale_bar
from reports.drawing.names import Sheet, names
from reports.drawing.shape import PATH_SAMPLES, turn_of
from reports.figures.forces.force_turn import ForceTurn
from reports.figures.mechanism import frame, name_size, write_name
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, SMALL
from reports.output.numbers import readable


def draw(turn: ForceTurn) -> Figure | None:
    """The drawing; None without reactions."""
    if not turn.has_forces or not (turn.acting.pins or turn.acting.sliders):
        return None
    scene = turn.scene
    path = turn_of(scene, PATH_SAMPLES, with_forces=True)
    arrows = force_arrows(scene, path)
    low, high = box = arrows.box(path)
    panels = Panels(top=0.05, right=0.1)
    wide = COLUMN_IN - panels.left - panels.right
    height = float(np.clip(wide * (high[1] - low[1]) / (high[0] - low[0]), 1.0, 4.0))
    at = arrows.largest_at(path)
    assert path.forces is not None
    drive, torque = scene.driver, readable(float(path.forces.torque[at]))
    title = f"{scene.name}, {driver_stands(scene, path, at)}"
    words = (
        f"Where the reactions are largest; driving {drive.effort} {torque} {drive.effort_unit}. An "
        "arrow is the force on the body of its colour, a black one that on a block."
    )
    figure, (axes,) = sheet(
        COLUMN_IN, replace(panels, height=height), title, [], [words, *turn.notes]
    )
    per_m = min(wide / (high[0] - low[0]), height / (high[1] - low[1]))
    frame(axes, low, high, float(per_m))
    draw_bodies(axes, scene, path, path, at, 0.5)
    draw_arrows(axes, arrows, path, at)
    scale_bar(axes, arrows, box, SMALL)
    paper = Sheet(low, tuple((high - low) * per_m), float(per_m), 0.1 * scene.longest_m)
    taken = [each.shaft for each in arrows.at(path, at)]
    for each in names(scene, path, at, paper, name_size, taken):
        write_name(axes, each)
    return figure
