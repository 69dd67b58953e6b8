"""What a person would measure on a sheet, or see at once: words over lines, over one another, off
the paper.

The sheet is drawn without its words: where their letters would be, that picture has to be blank. So
the check knows nothing of how a sheet is drawn, and misses nothing that is.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.textpath import TextPath

from models.array import Array

SVG = "{http://www.w3.org/2000/svg}"
MM_PER_POINT = 25.4 / 72.0
TENTH_MM = 0.1
DPI = 200
INK, DARK = 0.9, 0.5
"""Ink is darker than the first in one of its colours, which the inside of a plate is not; a line
that no text may interrupt is darker than the second."""


def drawn_lines(svg: bytes) -> dict[str, list[Array]]:
    """The places (n, 2) [mm] of every line by its name, from the upper left corner."""
    found: dict[str, list[Array]] = {}
    for group in ElementTree.fromstring(svg).iter(f"{SVG}g"):
        path = group.find(f"{SVG}path")
        if path is not None and group.get("id"):
            numbers = re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", path.get("d", ""))
            places = np.array(numbers, float).reshape(-1, 2) * MM_PER_POINT
            found.setdefault(str(group.get("id")), []).append(places)
    return found


@dataclass(frozen=True)
class Word:
    """A text, and the rows and columns that its letters are within, from the lower left corner."""

    text: str
    low: Array
    high: Array

    def covers(self, other: Word) -> bool:
        return bool(np.all(self.low < other.high) and np.all(other.low < self.high))


def overlaps(figure: Figure) -> list[str]:
    """A line for each text that lies over a line, over another text, or off the sheet."""
    figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(figure)
    texts = [t for axes in figure.axes for t in axes.texts if t.get_text().strip()]
    blanks = [a for axes in figure.axes for a in axes.patches if a.get_gid() == "blank"]
    drawing = _picture(canvas, hidden=texts) < INK
    if blanks:
        drawing |= _picture(canvas, hidden=[*texts, *blanks]) < DARK
    words = [_word(text, canvas) for text in texts]
    told = [
        f"{one.text!r} over {other.text!r}"
        for one, other in itertools.combinations(words, 2)
        if one.covers(other)
    ]
    for word in words:
        if np.any(word.low <= 0) or np.any(word.high >= drawing.shape):
            told.append(f"{word.text!r} off the sheet")
        (bottom, left), (top, right) = word.low, word.high
        if drawing[bottom:top, left:right].any():
            told.append(f"{word.text!r} on a line")
    return told


def _word(text: Text, canvas: FigureCanvasAgg) -> Word:
    """The box of type is higher than the letters in it: theirs are those of their outlines, whose
    control points are in no corner of it that the curves do not reach."""
    renderer, font = canvas.get_renderer(), text.get_fontproperties()
    typed = text.get_window_extent(renderer)
    below = renderer.get_text_width_height_descent("lp", font, False)[2]
    outline = TextPath((0.0, 0.0), text.get_text(), prop=font)
    places = outline.vertices[outline.codes != Path.CLOSEPOLY][:, ::-1]
    base = np.array([typed.y0 + below, typed.x0])
    low, high = base + DPI / 72.0 * np.array([places.min(axis=0), places.max(axis=0)])
    return Word(text.get_text(), np.floor(low).astype(int), np.ceil(high).astype(int))


def _picture(canvas: FigureCanvasAgg, hidden: Sequence[Artist]) -> Array:
    """How light a picture without some of its parts is, its lowest row first."""
    for artist in hidden:
        artist.set_visible(False)
    canvas.draw()
    for artist in hidden:
        artist.set_visible(True)
    colours = np.asarray(canvas.buffer_rgba())[::-1]
    return np.asarray(np.minimum.reduce([colours[..., k] for k in range(3)]) / 255.0)
