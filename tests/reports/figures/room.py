"""Whether the words of a figure have room: none over the edge of the sheet, none over another."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from reports.figures.style import styled


def boxes(figure: Figure) -> list[tuple[str, Bbox]]:
    """Every text that is drawn, with where it stands [pixel]."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    outside = {text for axes in figure.axes for text in _undrawn(axes)}
    texts = (text for text in figure.findobj(Text) if text.get_visible() and text not in outside)
    return [(t.get_text(), t.get_window_extent(renderer)) for t in texts if t.get_text().strip()]


def _undrawn(axes: Axes) -> Iterator[Text]:
    """The labels of ticks beyond the ends of their axis."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        for tick in axis.get_major_ticks():
            if not low <= tick.get_loc() <= high:
                yield from (tick.label1, tick.label2)


def has_room(draw: Callable[..., Figure | None], *arguments: object) -> None:
    """Every word on the sheet, and none on another."""
    with styled():
        figure = draw(*arguments)
        assert figure is not None
        found, page = boxes(figure), figure.bbox
    assert len(found) > 5
    for text, box in found:
        inside = box.x0 >= -1 and box.y0 >= -1 and box.x1 <= page.x1 + 1 and box.y1 <= page.y1 + 1
        assert inside, f"{text!r} leaves the sheet"
    for (a, first), (b, second) in itertools.combinations(found, 2):
        shared = Bbox.intersection(first, second)
        assert shared is None or min(shared.width, shared.height) < 2.0, f"{a!r} on {b!r}"
