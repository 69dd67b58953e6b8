"""Curves that lie on each other: their number, beside them."""

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from models.array import Array
from reports.figures.style import INK, POINTS, TINY, Look

WIDTH = 1.0
"""Width of a line, and distance within which curves coincide [point]."""


def count_coinciding(axes: Axes, curves: Iterable[Line2D]) -> None:
    """Write beside curves on each other how many lie there, where limits of axes are set before.

    A curve lies on a longer one where each of its points is within a line's width of one of that.
    """
    places = [np.array(curve.get_data(), float).T for curve in curves]
    groups: list[list[Array]] = []
    for own in sorted(filter(len, places), key=len, reverse=True):
        group = next((each for each in groups if _lies_on(axes, own, each[0])), [])
        groups += [] if group else [group]
        group.append(own)
    paper = {"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8}
    look: Look = {"size": TINY, "color": INK, "ha": "center", "bbox": paper, "zorder": 6}
    for first, *others in groups:
        if others:
            words, place = f"{1 + len(others)} curves coincide", first[int(0.6 * len(first))]
            axes.annotate(words, place, (0.0, 4.0), textcoords="offset points", **look)


def _lies_on(axes: Axes, curve: Array, other: Array) -> bool:
    """True if each point of a curve (n, 2) is within a line's width of one of the other (m, 2)."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    own, others = (axes.transData.transform(each) * POINTS / figure.dpi for each in (curve, other))
    away = np.hypot(*(own[:, None] - others).transpose(2, 0, 1))
    return bool((away.min(axis=1) <= WIDTH).all())
