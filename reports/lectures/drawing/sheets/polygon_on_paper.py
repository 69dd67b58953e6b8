"""A vector polygon on paper: its scale, where its pole is, and a log beside it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes

from analytic.lectures.drawings.drawn_polygons import POINT
from analytic.lectures.drawings.polygon import Polygon, Vector
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import power_of_ten
from reports.lectures.drawing.sheets.graph_drawing import LOGGED
from reports.lectures.drawing.sheets.paper import Box, arrow, line

MOST_MM = 8.0
"""Greatest length of the largest error [mm], ten times its least; it may be longer to scale."""
STAR = "*"
"""Suffix of the letter of a point in the log."""


@dataclass(frozen=True)
class MagnifiedErrors:
    """The exact place [mm], and the error there [mm], (2,) each, by point; errors are drawn
    ``factor`` times as long, a power of ten that is at least 1."""

    exact: Mapping[str, Array]
    errors: Mapping[str, Array]
    factor: float

    @staticmethod
    def of(exact: Mapping[str, Array], errors: Mapping[str, Array]) -> MagnifiedErrors:
        """The errors of the points that have both."""
        both = {name: error for name, error in errors.items() if name in exact}
        return MagnifiedErrors(exact, both, magnification(both.values()))

    @property
    def tips(self) -> dict[str, Array]:
        """The places of the log's points, magnified [mm]."""
        return {
            name: np.asarray(self.exact[name] + self.factor * error)
            for name, error in self.errors.items()
        }

    @property
    def is_large(self) -> bool:
        """True if an error is longer than the room for it."""
        return any(float(np.hypot(*error)) >= MOST_MM for error in self.errors.values())

    @property
    def words(self) -> str:
        """The magnification of the errors, in words."""
        if not any(np.any(error) for error in self.errors.values()):
            return "no error"
        if self.factor == 1.0:
            return "errors to scale"
        return f"errors \N{MULTIPLICATION SIGN} {power_of_ten(self.factor)}"


def magnification(errors_mm: Iterable[Array]) -> float:
    """The power of ten, at least 1, that makes the largest error [mm] (2,) as long as permitted."""
    largest = max((float(np.hypot(*error)) for error in errors_mm), default=0.0)
    if not 0.0 < largest < MOST_MM:
        return 1.0
    return 10.0 ** max(0, math.floor(math.log10(MOST_MM / largest)))


def outline(corners: Sequence[Array]) -> list[tuple[Array, Array]]:
    """The lines from corner to corner (2,), and back to the first if there are more than two."""
    edges = [*itertools.pairwise(corners)]
    return [*edges, (corners[-1], corners[0])] if len(corners) > 2 else edges


def logged_lines(
    drawn: MagnifiedErrors, links: Iterable[Iterable[str]]
) -> Iterator[tuple[Array, Array]]:
    """The log's lines of links or of their images, each by its points [mm]."""
    tips = drawn.tips
    for points in links:
        corners = [tips.get(name, drawn.exact.get(name)) for name in points]
        yield from outline([corner for corner in corners if corner is not None])


def draw_errors(
    axes: Axes, drawn: MagnifiedErrors, links: Iterable[Iterable[str]], gid: str
) -> None:
    """Draw errors as arrows, and the log's ``links``; lines are named ``gid`` and the point."""
    for start, end in logged_lines(drawn, links):
        line(axes, start, end, color=LOGGED, linewidth=0.6, linestyle=(0, (3, 1.5)), zorder=2)
    for name, tip in drawn.tips.items():
        if np.any(drawn.errors[name]):
            arrow(axes, drawn.exact[name], tip, f"{gid}-{name}", LOGGED, width=1.1)


PADDING_MM = 9.0
"""Room for letters around a polygon [mm]."""
BEYOND_MM = 6.0
"""Length of a dashed direction beyond the crossing [mm]."""
COVERED_MM = 0.1
"""Distance below which a line of an image is covered by a vector [mm]."""


@dataclass(frozen=True)
class DrawnPolygon:
    """A polygon, its unit to the millimetre, and the place of its pole [mm]; with a log, the log's
    errors [mm], and the way that gave them."""

    polygon: Polygon
    scale: float
    pole: Array
    logged: MagnifiedErrors | None = None
    logged_by: str = ""

    def at(self, vector: Array) -> Array:
        """The place of the end of a vector from the pole [mm]."""
        return np.asarray(self.pole + vector / self.scale)

    def size_of(self, vector: Vector) -> float:
        """The length of a vector [its unit], 0 where that is the rounding of a crossing."""
        return vector.size if vector.size > POINT * self.polygon.largest else 0.0

    def logged_sizes(self) -> Iterator[tuple[str, float, float, Array]]:
        """The name of each end of a vector that a log has, the lengths of the exact and the logged
        vector [its unit], and the error (2,) [mm]."""
        if self.logged is None:
            return
        ends = self.polygon.ends
        for name, error in self.logged.errors.items():
            own = ends[name] + error * self.scale
            yield name, float(np.hypot(*ends[name])), float(np.hypot(*own)), error

    def beside(
        self, errors: Mapping[str, Array], way: str, box: Box, scale: float | None = None
    ) -> DrawnPolygon:
        """The polygon with the errors of a log's ends of vectors [its unit], (2,) each, in the same
        box: large errors, not magnified, change the scale to have room."""
        exact = {name: self.at(end) for name, end in self.polygon.ends.items()}
        on_paper = {name: error / self.scale for name, error in errors.items()}
        logged = MagnifiedErrors.of(exact, on_paper)
        if logged.is_large:
            ends = self.polygon.ends
            own = [ends[name] + error for name, error in errors.items() if name in ends]
            roomy = fitted(self.polygon, box, scale, own)
            logged = replace(
                logged,
                exact={name: roomy.at(end) for name, end in ends.items()},
                errors={name: errors[name] / roomy.scale for name in logged.errors},
            )
            return replace(roomy, logged=logged, logged_by=way)
        return replace(self, logged=logged, logged_by=way)


def extent(polygon: Polygon) -> tuple[Array, Array]:
    """The corners of the box around the polygon [its unit]."""
    ends = [np.zeros(2), *polygon.ends.values()]
    ends += [end for vector in polygon.vectors for end in (vector.start, vector.end)]
    places = np.array(ends)
    return places.min(axis=0), places.max(axis=0)


def fitted(
    polygon: Polygon, box: Box, scale: float | None = None, beside: Sequence[Array] = ()
) -> DrawnPolygon:
    """Fit the polygon into the middle of a box, at a scale, or at the finest round one that fits,
    with the ends ``beside`` it (2,).

    Raises CrankcheckError where a wanted scale makes it larger than the box.
    """
    return DrawnPolygon(polygon, *frame_of([polygon], box, scale, beside))


def frame_of(
    polygons: Sequence[Polygon], box: Box, scale: float | None = None, beside: Sequence[Array] = ()
) -> tuple[float, Array]:
    """The scale, and the place of the pole [mm], of polygons in a box; as `fitted`."""
    corners = np.array([*(corner for each in polygons for corner in extent(each)), *beside])
    finest, middle = box.fitted(corners, PADDING_MM)
    wide, tall = np.ptp(corners, axis=0) / (scale or finest) + 2 * PADDING_MM
    if scale is not None and (wide > box.width or tall > box.height):
        raise CrankcheckError(
            f"the {polygons[0].quantity} polygon needs {wide:.0f} x {tall:.0f} mm at this scale, "
            f"and has {box.width:.0f} x {box.height:.0f} mm; take larger paper, or a smaller --k"
        )
    scale = scale or finest
    return scale, np.array(box.middle) - middle / scale


def crossing_line(drawn: DrawnPolygon, vector: Vector) -> tuple[Array, Array] | None:
    """The ends of the dashed line along a direction that crosses another; None if known [mm]."""
    start, end = drawn.at(vector.start), drawn.at(vector.end)
    length = float(np.hypot(*(end - start)))
    if not vector.direction or length < 1e-9:
        return None
    spare = BEYOND_MM * (end - start) / length
    return start - spare, end + spare


def image_lines(drawn: DrawnPolygon) -> Iterator[tuple[Array, Array]]:
    """The edges of the images of links [mm], except those covered by a vector."""
    vectors = [(drawn.at(vector.start), drawn.at(vector.end)) for vector in drawn.polygon.vectors]
    for image in drawn.polygon.images.values():
        for a, b in outline([drawn.at(end) for end in image.values()]):
            ways = [(s - a, e - b) for s, e in vectors] + [(s - b, e - a) for s, e in vectors]
            apart = [float(np.hypot(*s) + np.hypot(*e)) for s, e in ways]
            if min(apart, default=COVERED_MM) >= COVERED_MM:
                yield a, b
