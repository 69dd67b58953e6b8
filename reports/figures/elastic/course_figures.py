"""The figures of a motion with elastic links by name, which is that of their file. To add one, add
a file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from matplotlib.figure import Figure

from reports.describe.elastic_course import ElasticCourse
from reports.figures.elastic import angles, control, deflection, extension, positions, torque
from reports.figures.saving import FORMATS

COURSE_FIGURES: Mapping[str, Callable[[ElasticCourse], Figure | None]] = {
    "deflection": deflection.draw,
    "extension": extension.draw,
    "torque": torque.draw,
    "angles": angles.draw,
    "positions": positions.draw,
    "control": control.draw,
}
"""Each gives None where there is nothing to draw: what is let go has no drive, few are
controlled."""


def elastic_figure_files() -> list[str]:
    """The names of all files that may be written."""
    return [f"{name}.{kind}" for name in COURSE_FIGURES for kind in FORMATS]
