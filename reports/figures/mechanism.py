"""The mechanism of a scene in one position: links and points by name, and the paths of the points.

It is drawn with the parts of `reports.figures.gif`.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from models.array import Array
from models.motion import Motion
from models.scene import Scene, driver
from reports.describe.facts import describe_law
from reports.drawing import force_arrows
from reports.drawing.shape import PATH_SAMPLES, box_of, clearest, turn_of
from reports.figures import gif
from reports.figures.layout import LAYOUT
from reports.figures.sheet import NUMBER_IN, Panels, sheet
from reports.figures.style import COLUMN_IN, SMALL
from reports.protocol.length import SECONDS, TURNS
from reports.protocol.way import way_of
from reports.results.overview import Report, facts_of

FREE_SAMPLES = 2401
"""Samples of the paths of a free motion, which are passed many times."""
OF_CLOCK = {TURNS: ("closed form", PATH_SAMPLES), SECONDS: ("integrated", FREE_SAMPLES)}
"""Origin of a motion, and samples of its paths."""


def draw(report: Report, name: str) -> Figure | None:
    """Draw the mechanism; None for a scene whose text in the store can not be read."""
    scene = report.scenes[name]
    if scene is None:
        return None
    truth, samples = OF_CLOCK[way_of(scene).clock]
    path = turn_of(scene, samples)
    at = clearest(path)
    title = f"{name}, {driver.driver_stands(scene, path, at)}"
    own = facts_of(report).get("crankcheck", "")
    longest = f"longest link L = {scene.longest_m:g} m"
    origin = f"crankcheck {own}, {truth}; driver {describe_law(scene)}; {longest}."
    under = [f"{scene.source}. {scene.note}", origin]
    return mechanism_at(scene, path, at, box_of(scene, path), title, under)


def mechanism_at(
    scene: Scene,
    path: Motion,
    at: int,
    box: tuple[Array, Array],
    title: str,
    notes: Sequence[str],
    arrows: force_arrows.ForceArrows | None = None,
) -> Figure:
    """Draw a scene at a sample of its path, within a box, with arrows of its forces if any."""
    low, high = box
    panels = Panels(top=0.05, right=0.1)
    wide = LAYOUT.get().across(COLUMN_IN) - panels.left - panels.right
    height = float(np.clip(wide * (high[1] - low[1]) / (high[0] - low[0]), 1.0, 4.0))
    figure, (axes,) = sheet(COLUMN_IN, replace(panels, height=height), title, [], notes)
    per_m = float(min(wide / (high[0] - low[0]), height / (high[1] - low[1])))
    _frame(axes, low, high, per_m)
    gif.draw_bodies(axes, scene, path, path, at, 0.5)
    taken = []
    if arrows is not None:
        gif.draw_arrows(axes, arrows, path, at)
        gif.scale_bar(axes, arrows, box, SMALL)
        taken = [each.shaft for each in arrows.at(path, at)]
    gif.write_names(axes, scene, path, at, box, per_m, taken)
    return figure


def _frame(axes: Axes, low: Array, high: Array, per_m: float) -> None:
    """Set axes in metres from corner to corner, ``per_m`` inches each, with numbers that fit."""
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.set_aspect("equal", adjustable="box", anchor="N")
    room = per_m * float(high[0] - low[0])
    axes.xaxis.set_major_locator(
        MaxNLocator(min(max(int(room / NUMBER_IN), 1), 9), steps=[1, 2, 5, 10])
    )
