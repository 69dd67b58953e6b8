"""What figures of regulation are drawn of: a cycle, the one without a flywheel, and their axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from models.array import Array
from reports.figures.style import SMALL
from reports.lectures.machine.cycle_frame import CycleSeries, cycle_series
from reports.output.numbers import readable
from reports.output.provenance import crankcheck_version

SIDES = (0.58, 0.1)
"""Room on the left and on the right of a panel over the angle [inch]."""
CURVE = {"color": "#1f5f9e", "linewidth": 1.3}
OTHER = {"color": "#c04a1d", "linewidth": 1.0, "linestyle": (0, (4.0, 1.5))}
RETURNING = {"color": "#2f7d4c", "linewidth": 0.8, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}


@dataclass(frozen=True)
class Regulated:
    """A steady cycle to be drawn; ``wanted`` is its flywheel, where it is one's."""

    cycle: SteadyCycle
    wanted: WantedFlywheel | None = None

    @cached_property
    def series(self) -> CycleSeries:
        return cycle_series(self.cycle)

    @property
    def bare(self) -> SteadyCycle | None:
        """The cycle without the flywheel, where there is one."""
        return None if self.wanted is None else self.wanted.bare

    @property
    def degrees(self) -> Array:
        """What curves go over: the driver's angle, as it goes on from the start [deg]."""
        return np.degrees(self.series.theta)

    def plot(self, axes: Axes, curve: Array, **look: Any) -> None:
        """Draw a series of the cycle (T,)."""
        axes.plot(self.degrees, curve, **look)

    def mark_axis(self, axes: Axes) -> None:
        """Limits and ticks of the angle; short numbers on the other axis."""
        ends = self.degrees[[0, -1]]
        axes.set_xlim(*sorted(ends))
        axes.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=False)
        axes.yaxis.get_offset_text().set_fontsize(SMALL)
        turns = round(self.cycle.machine.cycle_rad / math.tau)
        axes.xaxis.set_major_locator(MultipleLocator(60.0 if turns == 1 else 90.0 * turns / 2.0))

    @property
    def label(self) -> str:
        return f"angle of {self.cycle.machine.scene.driver.link} [deg]"

    @property
    def notes(self) -> list[str]:
        """What stands under each figure."""
        cycle, scene = self.cycle, self.cycle.machine.scene
        parts = [
            f"crankcheck {crankcheck_version()}; steady cycle at a mean speed of "
            f"{readable(cycle.mean_rad_s, 5)} rad/s",
            f"loads: {', '.join(scene.loads)}" if scene.loads else "no loads",
        ]
        if cycle.drive_n_m:
            parts.append(f"drive: a constant torque of {readable(cycle.drive_n_m, 5)} N m")
        if self.wanted is not None:
            parts.append(f"flywheel: {readable(self.wanted.inertia_kg_m2, 5)} kg m²")
        return [f"{'; '.join(parts)}."]
