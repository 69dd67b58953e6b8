"""The axis that motions with elastic links are drawn over: the driver's angle in a turn, or time;
and what stands under each figure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

from models.array import Array
from models.laws import ConstantSpeed
from reports.describe.elastic_course import ElasticCourse
from reports.describe.facts import describe_law
from reports.figures.style import QUIET, SMALL
from reports.output.provenance import crankcheck_version

SIDES = (0.58, 0.1)
"""Room on the left and on the right of a panel [inch]."""
ELASTIC = {"color": "#1f5f9e", "linewidth": 1.1}
RIGID = {"color": "#c04a1d", "linewidth": 0.9, "linestyle": (0, (4.0, 2.0))}
COLOURS = ("#1f5f9e", "#c04a1d", "#2f7d4c", "#7a3e9d", "#b97f1f", "#15889a")
"""Of elastic links, in the order of the scene."""
DASHES = ("-", (0, (5.0, 1.5)), (0, (1.2, 1.2)), (0, (6.0, 1.5, 1.0, 1.5)))
TURN = 1.0001
"""Periods of a constant speed up to which an axis is that of the driver's angle."""


@dataclass(frozen=True)
class CourseAxis:
    """Values (T,) with their label; ``step`` is between its numbers, 0 for any."""

    values: Array
    label: str
    step: float = 0.0

    @staticmethod
    def of(course: ElasticCourse) -> CourseAxis:
        scene, time_s = course.scene, course.time_s
        law = scene.driver.law
        if isinstance(law, ConstantSpeed) and time_s[-1] <= TURN * law.period_s:
            degrees = np.degrees(course.motion.links[scene.driver.link].theta)
            return CourseAxis(degrees, f"angle of {scene.driver.link} [deg]", 60.0)
        if isinstance(law, ConstantSpeed):
            return CourseAxis(time_s / law.period_s, f"turns of {scene.driver.link}")
        return CourseAxis(time_s, "time [s]")

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        """Limits and label of the axis, short numbers on the other, and a line at 0."""
        axes.set_xlim(float(self.values.min()), float(self.values.max()))
        if self.step:
            axes.xaxis.set_major_locator(MultipleLocator(self.step))
        low, high = axes.get_ylim()
        if low <= 0.0 <= high:
            axes.axhline(0.0, color=QUIET, linewidth=0.5)
        axes.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=False)
        axes.yaxis.get_offset_text().set_fontsize(SMALL)
        if labelled:
            axes.set_xlabel(self.label)
        else:
            axes.tick_params(labelbottom=False)


def notes(course: ElasticCourse, *more: str) -> list[str]:
    """What stands under each figure."""
    scene = course.scene
    gravity = float(np.hypot(*scene.gravity_m_s2))
    parts = [
        f"crankcheck {crankcheck_version()}, {course.words}",
        f"{scene.driver.link} {describe_law(scene)}",
        f"gravity {gravity:g} m/s²" if gravity else "no gravity",
    ]
    return [*more, f"{'; '.join(parts)}."]
