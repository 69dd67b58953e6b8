"""The motion of a scene in closed form, as `solve` returns it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from analytic.forces.efficiency import Efficiency, efficiency
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.describe.with_forces import cleaned_forces
from reports.output.console import say
from reports.requests.shown import Shown

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

ROWS = 13
"""Samples that are printed."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Solution(Shown, Motion):
    """The motion of a scene in closed form, with a bound of its own error at every sample.

    ``links``, ``points`` and ``sliders`` are what moves, by name (`Motion`); ``forces`` what that
    asks of joints and drive, where they were asked for (`Forces`).
    """

    scene: Scene

    @cached_property
    def efficiency(self) -> Efficiency | None:
        """What friction takes over a cycle of the scene, at its instants and as a whole, and where
        it locks; None without friction. Raises CrankcheckError for a driver that speeds up."""
        return efficiency(self.scene) if self.scene.friction else None

    def frame(self) -> pd.DataFrame:
        """One row per sample, columns with their units: ``rocker_theta_rad``, ``C_x_m``."""
        from reports.describe.frame import motion_frame

        return motion_frame(self)

    def show(self, console: Console) -> None:
        from analytic.structure.mobility import analyse
        from reports.describe.facts import speed_facts
        from reports.requests.solution_text import (
            show_friction,
            show_heading,
            show_largest,
            show_motion,
            show_notes,
            show_position,
        )

        speeds = speed_facts(self.scene)
        show_heading(console, self.scene, analyse(self.scene), speeds=speeds)
        if self.time_s.size == 1:
            show_position(console, self.scene, self)
        else:
            acting = self.forces and cleaned_forces(self.forces)
            few = thinned(replace(self, forces=acting), ROWS)
            show_motion(console, self.scene, few)
            if few.time_s.size < self.time_s.size:
                left = f"{few.time_s.size} of {self.time_s.size} samples; all of them: frame()"
                say(console, left, "dim")
            if self.forces is not None:
                show_largest(console, self.scene)
        if self.forces is not None:
            show_friction(console, self.scene)
        show_notes(console, self.scene, self)

    def _drawn(self) -> str:
        return drawn(self.scene, with_forces=self.forces is not None)


def thinned(motion: Motion, most: int) -> Motion:
    """At most so many samples of a motion, evenly spread, the first and the last among them."""
    size = motion.time_s.size
    if size <= most:
        return motion
    kept = np.linspace(0, size - 1, most).round().astype(int)
    few = motion.each_series(lambda series: series[kept])
    acting, bound = motion.forces, motion.bound
    acting = acting and acting.stretch(kept)
    if bound is not None:
        whole = replace(motion, links=bound.links, points=bound.points, sliders=bound.sliders)
        parts = whole.each_series(lambda series: series[kept])
        bound = replace(bound, links=parts.links, points=parts.points, sliders=parts.sliders)
    return replace(few, time_s=motion.time_s[kept], bound=bound, forces=acting, conditioning={})


def drawn(scene: Scene, logged: Motion | None = None, *, with_forces: bool = False) -> str:
    """The mechanism as SVG, with the paths of a run or the reference's forces; "" where it can not
    go through a turn."""
    from reports.drawing.svg import svg

    try:
        return svg(scene, logged, with_forces=with_forces)
    except CrankcheckError:
        return ""
