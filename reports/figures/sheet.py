"""The sheet of a figure: panels, legend and notes placed in inches, none over another.

::

    title
    +-------------+  +-------------+
    | panel       |  | panel       |
    +-------------+  +-------------+
    legend, in as many columns as have room
    notes: versions, processor, study, settings
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from models.array import Array
from models.scene import Scene
from reports.figures import style
from reports.figures.layout import LAYOUT
from reports.figures.style import SMALL, TINY, Look, cut, width_in

EDGE = 0.04
"""Room at the edges of the sheet [inch]."""
FITTED = 0.98
"""Share of a line that is filled: pixels make small letters up to 2 % wider than they are."""
HANDLE, GAP = 0.31, 0.08
"""Width of a sample of a curve in a legend, and between its columns [inch]."""


@dataclass(frozen=True)
class Panels:
    """Panels of one size [inch] in rows and columns, and the room on their sides for axis labels.

    ``between`` is the room between two columns and between two rows.
    """

    rows: int = 1
    columns: int = 1
    height: float = 2.3
    left: float = 0.48
    right: float = 0.06
    top: float = 0.2
    bottom: float = 0.34
    between: tuple[float, float] = (0.15, 0.25)


SIDES = (0.58, 0.1)
"""Room on the left and on the right of a panel over an axis [inch]."""
ONE = Panels(1, 1, 2.1, *SIDES, 0.15)
Entries = Sequence[tuple[Artist, str]]
"""Samples and labels of a legend."""


def sheet(
    width: float,
    panels: Panels,
    title: str,
    entries: Entries,
    notes: Sequence[str],
    columns: int = 0,
) -> tuple[Figure, list[Axes]]:
    """Return an empty figure with its panels, row by row, its legend and its notes.

    The legend has ``entries`` in ``columns`` (0: as many as have room); in one they are whole.
    """
    layout = LAYOUT.get()
    width, title = layout.across(width), "" if layout.no_title else title
    notes = () if layout.no_notes else notes
    room = width - 2 * EDGE
    widest = max((width_in(text) for _, text in entries), default=0.0) + HANDLE + GAP
    number = columns or max(1, min(int((room + GAP) / widest), len(entries) or 1))
    each = (room + GAP) / number - GAP - HANDLE
    labels = [
        (artist, "\n".join(style.wrapped(text, each)) if columns == 1 else cut(text, each))
        for artist, text in entries
    ]
    in_rows = math.ceil(sum(1 + text.count("\n") for _, text in labels) / number)
    legend = in_rows * SMALL * 1.38 / style.POINTS + (0.05 if entries else 0.0)
    lines = [line for note in notes for line in folded(note, room)]
    foot = len(lines) * TINY * 1.25 / style.POINTS
    titles = style.wrapped(title, room, style.LARGE) if title else []
    head = (0.3 * bool(titles) + 1.2 * len(titles)) * style.LARGE / style.POINTS
    across, down = panels.between
    inner = (width - panels.left - panels.right - across * (panels.columns - 1)) / panels.columns
    grid = panels.rows * panels.height + (panels.rows - 1) * down
    height = EDGE + head + panels.top + grid + panels.bottom + legend + foot + EDGE
    figure = Figure(figsize=(width, height), dpi=200)
    for row, column in itertools.product(range(panels.rows), range(panels.columns)):
        left = panels.left + column * (inner + across)
        top = EDGE + head + panels.top + row * (panels.height + down)
        bottom = height - top - panels.height
        figure.add_axes((left / width, bottom / height, inner / width, panels.height / height))
    edge = EDGE / width
    look: dict[str, Any] = {"size": style.LARGE, "va": "top", "linespacing": 1.2}
    figure.text(edge, 1 - EDGE / height, "\n".join(titles), **look)
    if entries:
        _legend(figure, labels, number, (edge, (EDGE + foot + legend) / height))
    if lines:
        look = {"size": TINY, "color": style.QUIET, "va": "bottom", "linespacing": 1.25}
        figure.text(edge, EDGE / height, "\n".join(lines), **look)
    return figure, figure.axes


def _legend(figure: Figure, entries: Entries, columns: int, corner: tuple[float, float]) -> None:
    """Draw the legend with its upper left corner at ``corner`` (shares of the figure)."""
    figure.legend(
        handles=[artist for artist, _ in entries],
        labels=[text for _, text in entries],
        loc="upper left",
        bbox_to_anchor=corner,
        ncols=columns,
        frameon=False,
        borderaxespad=0.0,
        borderpad=0.0,
        handlelength=(HANDLE - 0.05) * style.POINTS / SMALL,
        handletextpad=0.05 * style.POINTS / SMALL,
        columnspacing=GAP * style.POINTS / SMALL,
        labelspacing=0.35,
        numpoints=1,
    )


def folded(text: str, room: float, size: float = TINY) -> list[str]:
    """Return a text in lines that have room; a word that has none alone is cut."""
    room *= FITTED
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and width_in(longer, size) <= room:
            lines[-1] = longer
        else:
            lines.append(cut(word, room, size))
    return lines


MOST_COLUMNS, LEAST_COLUMN_IN, NUMBER_IN = 4, 1.6, 0.38
"""Columns of panels, the least width of one, and that of a number under it [inch]."""


def grid(
    names: Sequence[str],
    title: str,
    labels: tuple[str, str],
    entries: Entries,
    notes: Sequence[str],
    height: float = 1.35,
) -> tuple[Figure, list[Axes]]:
    """Return a page with a panel per name; ``labels`` are for the two axes of all panels."""
    width = LAYOUT.get().across(style.PAGE_IN)
    columns = columns_of(len(names), MOST_COLUMNS)
    rows = math.ceil(len(names) / columns)
    height *= 1.0 if columns > 2 else 1.5
    across = down = 0.2
    upright = folded(labels[1], rows * height + (rows - 1) * down, style.SIZE)
    left = 0.35 + 0.115 * len(upright)
    panels = Panels(rows, columns, height, left, 0.1, 0.16, 0.31, (across, down))
    figure, axes = sheet(width, panels, title, entries, notes)
    box = axes[0].get_position()
    for at, (name, one) in enumerate(zip(names, axes, strict=False)):
        one.set_title(cut(name, box.width * width, SMALL))
        one.tick_params(labelbottom=at + columns >= len(names), labelleft=at % columns == 0)
    low, right = axes[-1].get_position().y0, axes[columns - 1].get_position().x1
    under = low - 0.15 / figure.get_figheight()
    figure.text((box.x0 + right) / 2, under, labels[0], ha="center", va="top")
    middle = (low + box.y1) / 2
    words: Look = {"rotation": 90, "va": "center", "multialignment": "center"}
    figure.text(EDGE / width, middle, "\n".join(upright), **words)
    for one in axes[len(names) :]:
        one.remove()
    return figure, axes[: len(names)]


class Abscissa(Protocol):
    """The horizontal axis of the figures of a scene."""

    @property
    def scene(self) -> Scene: ...

    def plot(self, axes: Axes, series: Array, **look: Any) -> None:
        """Draw a series (T,)."""

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        """Set limits, ticks and label of the axis, and short numbers on the other."""


Curve = tuple[str, Array, Look]
"""Name in the legend ("" for none), series and look."""


@dataclass(frozen=True)
class LinePanel:
    """A panel of curves, over a line at 0 if it is marked and near, and under one at a level."""

    label: str
    curves: Sequence[Curve]
    marks_zero: bool = False
    level: float | None = None


def line_figure(
    axis: Abscissa,
    title: str,
    panels: Sequence[LinePanel],
    notes: Sequence[str],
    entries: Entries | None = None,
    *,
    height: float = 2.1,
    top: float = 0.15,
    down: float = 0.2,
) -> tuple[Figure, list[Axes]]:
    """Draw panels below each other over one axis.

    The legend has the named curves, where no ``entries`` are given; ``height`` is that of a panel,
    ``top`` and ``down`` the room above the first and between two [inch].
    """
    shape = Panels(len(panels), 1, height, *SIDES, top, between=(0.0, down))
    every = [curve for panel in panels for curve in panel.curves]
    if entries is None:
        entries = [(Line2D([], [], **look), name) for name, _, look in every if name]
    title = f"{title}: {axis.scene.name}"
    figure, axes = sheet(style.COLUMN_IN, shape, title, entries, notes)
    for one, panel in zip(axes, panels, strict=True):
        if panel.marks_zero:
            style.mark_zero(one, *(series for _, series, _ in panel.curves))
        for _, series, look in panel.curves:
            axis.plot(one, series, **look)
        if panel.level is not None:
            one.axhline(panel.level, color=style.QUIET, linewidth=0.5)
        one.set_ylabel(panel.label)
        axis.mark(one, labelled=one is axes[-1])
    return figure, axes


def columns_of(number: int, most: int) -> int:
    """Return the columns of panels for which a page has room."""
    return min(most, number, int(LAYOUT.get().across(style.PAGE_IN) / LEAST_COLUMN_IN))


def one_scale(every: Sequence[Axes]) -> None:
    """Set the vertical axes of panels to the limits that all of them need."""
    low, high = zip(*(axes.get_ylim() for axes in every), strict=True)
    for axes in every:
        axes.set_ylim(min(low), max(high))
        axes.yaxis.set_major_locator(MaxNLocator(5))


def spaced(axes: Axes, step: float) -> None:
    """Set ticks of the horizontal axis at multiples of a step, or of a multiple that has room."""
    low, high = axes.get_xlim()
    figure = axes.get_figure(root=True)
    assert figure is not None
    room = axes.get_position().width * figure.get_figwidth() / NUMBER_IN
    axes.xaxis.set_major_locator(MultipleLocator(step * math.ceil((high - low) / step / room)))


def tenfold(largest: float) -> float:
    """Return the power of ten of a panel with series up to ``largest``."""
    return 10.0 ** math.floor(math.log10(largest)) if largest > 0.0 else 1.0


def corner_words(axes: Axes, room: float, left: str, right: str) -> None:
    """Write words in the upper corners of a panel, which is made higher by that part of itself."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + room * (high - low))
    paper = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}  # over a tick behind
    words: Look = {"va": "top", "size": TINY, "transform": axes.transAxes, "bbox": paper}
    axes.text(0.03, 0.96, left, ha="left", **words)
    axes.text(0.97, 0.96, right, ha="right", **words)
