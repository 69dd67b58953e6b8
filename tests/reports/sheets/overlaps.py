"""What a person would see at once on a sheet: words over lines, over one another, off the paper.

The sheet is drawn twice, once with its words alone and once without them: where a word's letters
are, the other picture has to be blank. So the check knows nothing of how a sheet is drawn, and
misses nothing that is.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from models.array import Array

DPI = 200
INK, DARK = 0.9, 0.5
"""Ink is darker than the first in one of its colours, which the inside of a plate is not; a line
that no text may interrupt is darker than the second."""


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
    lines = [a for axes in figure.axes for a in (*axes.lines, *axes.patches)]
    blanks = [each for each in lines if each.get_gid() == "blank"]
    letters = _picture(canvas, hidden=lines) < INK
    drawing = (_picture(canvas, hidden=texts) < INK) | (
        _picture(canvas, hidden=[*texts, *blanks]) < DARK
    )
    words = [_word(text, letters, canvas) for text in texts]
    told = [
        f"{one.text!r} over {other.text!r}"
        for one, other in itertools.combinations(words, 2)
        if one.covers(other)
    ]
    for word in words:
        if np.any(word.low <= 0) or np.any(word.high >= letters.shape):
            told.append(f"{word.text!r} off the sheet")
        (bottom, left), (top, right) = word.low, word.high
        if drawing[bottom:top, left:right].any():
            told.append(f"{word.text!r} on a line")
    return told


def _word(text: Text, letters: Array, canvas: FigureCanvasAgg) -> Word:
    """The box of type is higher than the letters in it: theirs is where it has ink."""
    extent = text.get_window_extent(canvas.get_renderer())
    low = np.floor([extent.y0, extent.x0]).astype(int).clip(0)
    part = letters[low[0] : int(np.ceil(extent.y1)), low[1] : int(np.ceil(extent.x1))]
    rows, columns = np.nonzero(part)
    assert rows.size, f"{text.get_text()!r} is not on the sheet at all"
    return Word(
        text.get_text(),
        low + np.array([rows.min(), columns.min()]),
        low + np.array([rows.max(), columns.max()]) + 1,
    )


def _picture(canvas: FigureCanvasAgg, hidden: Sequence[Artist]) -> Array:
    """How light a picture without some of its parts is, its lowest row first."""
    for artist in hidden:
        artist.set_visible(False)
    canvas.draw()
    for artist in hidden:
        artist.set_visible(True)
    colours = np.asarray(canvas.buffer_rgba())[::-1, :, :3] / 255.0
    return np.asarray(colours.min(axis=2))
