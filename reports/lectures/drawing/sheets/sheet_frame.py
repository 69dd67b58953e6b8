"""What all sheets have: a margin, a title above, a note at the foot, and boxes with borders."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes

from reports.figures.style import FRONT, LARGE, QUIET, TINY, cut
from reports.lectures.drawing.sheets.canvas import line, text
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, Paper

MARGIN, HEAD, FOOT = 8.0, 9.0, 6.0
"""Around the sheet, and of title and note [mm]."""


def inner_box(paper: Paper) -> Box:
    """What is left between title and note."""
    width, height = paper.width - 2 * MARGIN, paper.height - 2 * MARGIN - HEAD - FOOT
    return Box(MARGIN, MARGIN + FOOT, width, height)


def write_head(axes: Axes, paper: Paper, title: str, note: str) -> None:
    """The title, and the note at the foot."""
    text(axes, MARGIN, paper.height - MARGIN - 4.0, title, LARGE, weight="bold")
    room = (paper.width - 2 * MARGIN) / MM_PER_IN
    text(axes, MARGIN, MARGIN, cut(note, room, TINY), TINY, color=QUIET)


def draw_border(axes: Axes, box: Box) -> None:
    """A thin line around a box."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * (box.width, box.height)
    for start, end in itertools.pairwise(corners + np.array([box.left, box.bottom])):
        line(axes, start, end, color=FRONT, linewidth=0.6)
