"""Figure of `sensitivity`: curves over the driver's place, a panel for lengths, one for angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes

from models.array import Array
from models.scene import Scene
from models.scene.driver import driver_axis, driver_shown
from reports.describe.facts import describe_law
from reports.figures.sheet import LinePanel, line_figure, spaced
from reports.figures.style import Look, saved, shorten, styled
from reports.lectures.machine.effects import Effects
from reports.output.write import crankcheck_version

COLOURS = ("#1f5f9e", "#c04a1d", "#2f7d4c", "#7a4fa3", "#b08900", "#4a4a4a")
DASHES = ("-", (0, (4.0, 1.5)), (0, (1.0, 1.0)))


@dataclass(frozen=True)
class _DriverPlace:
    """Horizontal axis: the driver's place, in the order of the turn."""

    effects: Effects

    @property
    def scene(self) -> Scene:
        return self.effects.gradient.scene

    def plot(self, axes: Axes, series: Array, **look: Any) -> None:
        axes.plot(driver_shown(self.scene, self.effects.gradient.motion), series, **look)

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        shown = driver_shown(self.scene, self.effects.gradient.motion)
        axes.set_xlim(float(shown.min()), float(shown.max()))
        axes.set_xlabel(driver_axis(self.scene) if labelled else "")
        axes.tick_params(labelbottom=labelled)
        shorten(axes)
        if self.scene.driver.slider is None:
            spaced(axes, 60.0)


def effects_picture(found: Effects, kind: str) -> bytes:
    """Draw the effects at their tolerances as a file of a kind (svg, pdf, png)."""
    scene = found.gradient.scene
    panels: list[LinePanel] = []
    number = {one.name: i for i, one in enumerate(found.dimensions)}
    for unit in ("mm", "deg"):
        curves = []
        own = [row for row in found.rows() if row["unit"] == unit]
        for i, row in enumerate(own, sum(len(panel.curves) for panel in panels)):
            look: Look = {"color": COLOURS[i % len(COLOURS)], "linewidth": 1.1}
            look["linestyle"] = DASHES[i // len(COLOURS) % len(DASHES)]
            name = str(row["dimension"])
            curves.append((name, found.at_tolerance[number[name]], look))
        if own:
            label = f"{found.of} [{found.unit}] by {own[0]['tolerance']:.3g} {unit}"
            panels.append(LinePanel(label, curves, marks_zero=True))
    with styled():
        by = f"crankcheck {crankcheck_version()}, closed form"
        notes = [f"{by}; {scene.driver.joint} {describe_law(scene)}; to first order."]
        title = f"Effect of dimensions on {found.of}"
        figure, _ = line_figure(_DriverPlace(found), title, panels, notes)
    return saved(figure, kind, f"{scene.name}: {title}")
