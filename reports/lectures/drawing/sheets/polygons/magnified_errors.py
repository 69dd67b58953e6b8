"""What a log is off by on a sheet: where it has things stand, its errors magnified to be seen."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from models.array import Array
from reports.figures.style import power_of_ten
from reports.lectures.drawing.sheets.canvas import arrow, line
from reports.lectures.drawing.sheets.sheet_log import LOGGED

MOST_MM = 8.0
"""The largest error is drawn no longer than this, and longer than a tenth of it, unless it is
longer at its own scale."""
STAR = "*"
"""What is added to the letter of a point as the log has it."""


@dataclass(frozen=True)
class MagnifiedErrors:
    """By point the place [mm] that is exact, and the error there [mm], (2,) each, drawn ``factor``
    times as long, which is a power of ten and 1 at least."""

    exact: Mapping[str, Array]
    errors: Mapping[str, Array]
    factor: float

    @staticmethod
    def of(exact: Mapping[str, Array], errors: Mapping[str, Array]) -> MagnifiedErrors:
        """Those of the points that have both."""
        both = {name: error for name, error in errors.items() if name in exact}
        return MagnifiedErrors(exact, both, magnification(both.values()))

    @property
    def tips(self) -> dict[str, Array]:
        """Where the log has the points, magnified [mm]."""
        return {
            name: np.asarray(self.exact[name] + self.factor * error)
            for name, error in self.errors.items()
        }

    @property
    def is_large(self) -> bool:
        """Whether an error is longer than what room is left for it."""
        return any(float(np.hypot(*error)) >= MOST_MM for error in self.errors.values())

    @property
    def words(self) -> str:
        """By what errors are magnified."""
        if not any(np.any(error) for error in self.errors.values()):
            return "no error"
        if self.factor == 1.0:
            return "errors to scale"
        return f"errors \N{MULTIPLICATION SIGN} {power_of_ten(self.factor)}"


def magnification(errors_mm: Iterable[Array]) -> float:
    """The power of ten, 1 at least, that makes the largest error [mm] (2,) as long as it may be."""
    largest = max((float(np.hypot(*error)) for error in errors_mm), default=0.0)
    if not 0.0 < largest < MOST_MM:
        return 1.0
    return 10.0 ** max(0, math.floor(math.log10(MOST_MM / largest)))


def outline(corners: Sequence[Array]) -> list[tuple[Array, Array]]:
    """The lines from corner to corner (2,), and back to the first where there are more than two."""
    edges = [*itertools.pairwise(corners)]
    return [*edges, (corners[-1], corners[0])] if len(corners) > 2 else edges


def logged_lines(
    drawn: MagnifiedErrors, links: Iterable[Iterable[str]]
) -> Iterator[tuple[Array, Array]]:
    """The lines of links or of their images, each by its points, as the log has them [mm]."""
    tips = drawn.tips
    for points in links:
        corners = [tips.get(name, drawn.exact.get(name)) for name in points]
        yield from outline([corner for corner in corners if corner is not None])


def draw_errors(
    axes: Axes, drawn: MagnifiedErrors, links: Iterable[Iterable[str]], gid: str
) -> None:
    """The errors as arrows, and what the log makes of ``links``; lines of errors are called ``gid``
    and the point."""
    for start, end in logged_lines(drawn, links):
        line(axes, start, end, color=LOGGED, linewidth=0.6, linestyle=(0, (3, 1.5)), zorder=2)
    for name, tip in drawn.tips.items():
        if np.any(drawn.errors[name]):
            arrow(axes, drawn.exact[name], tip, f"{gid}-{name}", LOGGED, width=1.1)
