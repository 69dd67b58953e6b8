"""The table of a polygon sheet: vectors in mm and SI, links with their images, errors of a log."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from analytic.lectures.drawings import drawn_polygons
from analytic.lectures.drawings.polygon import SYMBOLS, UNITS, Quantity
from models.errors import CrankcheckError
from models.scene import GROUND
from reports.figures.style import POINTS, QUIET, TINY, width_in
from reports.lectures.drawing.sheets.graph_drawing import LOGGED
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, Paper, text
from reports.lectures.drawing.sheets.polygon_drawing import lower_case
from reports.lectures.drawing.sheets.polygon_on_paper import STAR, DrawnPolygon
from reports.output.numbers import readable

RATES = {"velocity": "1/s", "acceleration": "1/s^2"}
REASONS = {"velocity": "as omega is 0", "acceleration": "as omega and alpha are 0"}


def image_words(drawn: drawn_polygons.DrawnPolygons, link: str, quantity: Quantity) -> str:
    """The similarity of a link's image in words: its scale and turn; or that it is one point."""
    image = drawn_polygons.similarity(drawn, link, quantity)
    if image.is_point:
        return f"one point, {REASONS[quantity]}"
    turned = f"turned by {math.degrees(image.turn_rad):.4g} deg"
    return f"similar, {readable(image.scale)} {RATES[quantity]}, {turned}"


def at_rest(quantity: Quantity) -> str:
    """The words for a polygon that is one point."""
    return f"at rest: every {quantity} is 0"


def doubts(drawn: drawn_polygons.DrawnPolygons) -> list[str]:
    """The parts that could not be drawn, and those that can hardly be drawn by hand."""
    lost = [f"not drawn: {told}" for told in drawn.undetermined]
    return lost + [f"flat: {told}" for told in drawn.flat]


def drawn_links(drawn: drawn_polygons.DrawnPolygons) -> list[str]:
    """The moving links that could be drawn."""
    return [name for name in drawn.rates if name != GROUND and name in drawn.placement.scene.links]


ROW, GAP = 1.9, 3.0
"""The height of a row, in heights of its letters; the room between columns [mm]."""
TOP_MM, SIDE_MM = 5.0, 1.5
SIZES = (TINY, 4.3, 4.0)
"""Types of the table [point]: the largest that has room is used."""


@dataclass(frozen=True)
class Row:
    """A line of the table: a name, a length on paper, a value; a heading has a name alone.

    ``kept`` is the number of following rows that must be in the same column.
    """

    name: str
    on_paper: str = ""
    value: str = ""
    logged: bool = False
    kept: int = 0
    indent_mm: float = 0.0

    @property
    def is_heading(self) -> bool:
        return not (self.on_paper or self.value)


def vector_rows(drawn: DrawnPolygon) -> Iterator[Row]:
    """The vectors of a polygon in the order of drawing, and the errors of a log."""
    quantity = drawn.polygon.quantity
    unit = UNITS[quantity].replace("^2", "²")
    yield Row("velocities" if quantity == "velocity" else "accelerations", kept=1)
    for vector in drawn.polygon.vectors:
        size = drawn.size_of(vector)
        yield Row(vector.name, f"{size / drawn.scale:.2f} mm", f"{readable(size)} {unit}")
    prime = "'" if quantity == "acceleration" else ""
    for name, size, own, error in drawn.logged_sizes():
        letter = lower_case(name) + prime
        for called, each in ((letter, size), (letter + STAR, own)):
            yield Row(called, f"{each / drawn.scale:.2f} mm", f"{each:.6g} {unit}", logged=True)
        off = float(np.hypot(*error))
        yield Row(
            f"{letter} {letter}{STAR}", f"{readable(off)} mm",
            f"{readable(off * drawn.scale)} {unit}", logged=True,
        )  # fmt: skip


def link_rows(drawn: drawn_polygons.DrawnPolygons) -> Iterator[Row]:
    """The rates of the links, and their images."""
    yield Row("links, and their images", kept=3)
    for name in drawn_links(drawn):
        omega, alpha = drawn_polygons.link_rates(drawn, name)
        yield Row(f"{name}:", "", f"{readable(omega)} rad/s, {readable(alpha)} rad/s²", kept=2)
        for quantity in drawn_polygons.QUANTITIES:
            words = image_words(drawn, name, quantity).replace("^2", "²").replace(" deg", "°")
            yield Row(f"{SYMBOLS[quantity]}:", "", words, indent_mm=2.0)


def draw_table(axes: Axes, rows: list[Row], box: Box, paper: Paper) -> None:
    """Draw the rows in columns within a box. Raises CrankcheckError for paper that is too small."""
    for size in SIZES:
        columns = _columns(rows, box, size)
        if sum(_width(column, size) + GAP for column in columns) <= box.width - 2 * SIDE_MM + GAP:
            break
    else:
        raise CrankcheckError(
            f"paper of {paper.width:g} x {paper.height:g} mm: {len(rows)} rows of the table can "
            "not be read on it; take a larger --paper, such as A3, or leave out -o"
        )
    x = box.left + SIDE_MM
    for column in columns:
        _draw_column(axes, column, x, box, size)
        x += _width(column, size) + GAP


def _columns(rows: list[Row], box: Box, size: float) -> list[list[Row]]:
    """The rows from top to bottom, column by column, with kept rows in one column."""
    most = max(int((box.height - TOP_MM - SIDE_MM) / _pitch(size)), 1)
    columns: list[list[Row]] = [[]]
    for row in rows:
        if columns[-1] and len(columns[-1]) + 1 + row.kept > most:
            columns.append([])
        columns[-1].append(row)
    return columns


def _pitch(size: float) -> float:
    """The distance from row to row [mm]."""
    return ROW * size / POINTS * MM_PER_IN


def _parts(column: list[Row], size: float) -> tuple[float, float]:
    """The widths of names and of lengths on paper [mm]."""
    sized = [row for row in column if row.on_paper]
    names = max((width_in(row.name, size) for row in sized), default=0.0)
    lengths = max((width_in(row.on_paper, size) for row in sized), default=0.0)
    return MM_PER_IN * names, MM_PER_IN * lengths


def _width(column: list[Row], size: float) -> float:
    name, on_paper = _parts(column, size)
    return max(
        name + on_paper + GAP + width_in(row.value, size) * MM_PER_IN
        if row.on_paper
        else row.indent_mm + width_in(f"{row.name} {row.value}", size) * MM_PER_IN
        for row in column
    )


def _draw_column(axes: Axes, column: list[Row], x: float, box: Box, size: float) -> None:
    name, on_paper = _parts(column, size)
    right = x + name + GAP / 2 + on_paper
    for number, row in enumerate(column):
        y = box.bottom + box.height - TOP_MM - (number + 0.8) * _pitch(size)
        look = {"color": LOGGED if row.logged else QUIET} if row.logged or row.is_heading else {}
        if not row.on_paper:
            text(axes, x + row.indent_mm, y, f"{row.name} {row.value}".strip(), size, **look)
            continue
        text(axes, x, y, row.name, size, **look)
        text(axes, right, y, row.on_paper, size, ha="right", **look)
        text(axes, right + GAP / 2, y, row.value, size, **look)
