"""What the figures of a free motion are drawn of: its driver and its energy, closely sampled."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from analytic.free.free_motion import FreeMotion
from models.array import Array
from models.motion import LinkMotion
from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.style import QUIET, SMALL
from reports.output.numbers import error_text
from reports.output.provenance import crankcheck_version

SIDES = (0.58, 0.1)
"""Room on the left and on the right of a panel over time [inch]."""
LEAST, MOST, IN_A_TURN = 2401, 7201, 180
"""Samples: of a motion that hardly turns, of one that turns very often, and in a turn at its
largest speed, whose peaks are narrow."""


@dataclass(frozen=True)
class FreeCourse:
    """A free motion at instants, with the energies [J]: kinetic, potential, and the work that is
    done on it from outside of both."""

    free: FreeMotion
    time_s: Array
    driver: LinkMotion
    kinetic: Array
    potential: Array
    work: Array

    @property
    def scene(self) -> Scene:
        return self.free.scene

    def mark_time(self, axes: Axes) -> None:
        """Limits of a time axis, short numbers on the other, and the limit positions."""
        axes.set_xlim(float(self.time_s[0]), float(self.time_s[-1]))
        shorten(axes)
        for one in self.free.passages:
            axes.axvline(one.time_s, color=QUIET, linewidth=0.5, linestyle=(0, (1.0, 2.0)))

    @property
    def notes(self) -> list[str]:
        """What stands under each figure."""
        scene, end = self.scene, self.time_s[-1:]
        gravity = np.hypot(*scene.gravity_m_s2)
        parts = [
            f"crankcheck {crankcheck_version()}, integrated to "
            f"{error_text(float(self.free.error_rad(end)[0]))} rad",
            f"{scene.driver.link} {describe_law(scene)}",
            f"gravity {gravity:g} m/s²" if gravity else "no gravity",
            f"loads: {', '.join(scene.loads)}" if scene.loads else "no loads",
            *([f"springs: {', '.join(scene.springs)}"] if scene.springs else []),
        ]
        return [f"{'; '.join(parts)}."]

    @property
    def notes_over_time(self) -> list[str]:
        """What stands under a figure over time."""
        dotted = "Dotted: limit positions, in which the driver turns back."
        return [*self.notes, *([dotted] if self.free.passages else [])]


def mark_zero(axes: Axes, *series: Array) -> None:
    """A line at 0 where the series come near to it; else they have the axis for themselves."""
    low, high = min(map(np.min, series)), max(map(np.max, series))
    if low <= 0.2 * high and high >= 0.2 * low:
        axes.axhline(0.0, color=QUIET, linewidth=0.5)


def shorten(axes: Axes, which: str = "y") -> None:
    """Short numbers on an axis, with one power of ten for all of them."""
    axes.ticklabel_format(axis=which, scilimits=(-3, 4), useMathText=False)  # type: ignore[arg-type]
    for axis in (axes.xaxis, axes.yaxis):
        axis.get_offset_text().set_fontsize(SMALL)


def free_course(free: FreeMotion) -> FreeCourse:
    """The motion from its start to its end. Raises CrankcheckError as `FreeMotion.at`."""
    turns = free.peak_speed_rad_s * free.until_s / math.tau
    count = int(np.clip(IN_A_TURN * turns, LEAST, MOST))
    time_s = np.linspace(0.0, free.until_s, count)
    driver = free.at(time_s, bound=False).links[free.scene.driver.link]
    energy = free.energy(time_s)
    return FreeCourse(free, time_s, driver, energy.kinetic, energy.potential, energy.work)
