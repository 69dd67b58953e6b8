"""How much ink there is where words might stand: a picture of the sheet, looked at box by box."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from models.array import Array
from reports.figures.style import styled
from reports.lectures.drawing.sheets.paper import MM_PER_IN

PIXEL_MM = 0.2
TINT, FAINT = 0.08, 0.36
"""What is less dark than the first counts as blank (the inside of a plate is paper with a tint),
and less dark than the second as a faint line, which may be interrupted."""


@dataclass(frozen=True)
class Ink:
    """The darkness of a sheet: ``below_left`` (rows + 1, columns + 1) has the sum of all pixels
    below and on the left of each corner of a pixel; the sheet's lower left corner is the first."""

    below_left: Array

    def within(self, middles: Array, half: Array) -> Array:
        """The darkness, times the area [mm²], in boxes of half a size (2,) about places (k, 2)
        [mm]; shape (k,)."""
        most = np.array(self.below_left.shape)[::-1] - 1
        low = np.clip(np.floor((middles - half) / PIXEL_MM), 0, most).astype(int)
        high = np.clip(np.ceil((middles + half) / PIXEL_MM), 0, most).astype(int)
        sums = self.below_left
        dark = (
            sums[high[:, 1], high[:, 0]]
            - sums[low[:, 1], high[:, 0]]
            - sums[high[:, 1], low[:, 0]]
            + sums[low[:, 1], low[:, 0]]
        )
        return np.asarray(PIXEL_MM**2 * np.maximum(dark, 0.0))


def ink_of(figure: Figure) -> tuple[Ink, Ink]:
    """What is drawn on a figure by now: dark lines, and faint ones."""
    dpi = figure.dpi
    figure.set_dpi(MM_PER_IN / PIXEL_MM)
    with styled():
        canvas = FigureCanvasAgg(figure)
        canvas.draw()  # type: ignore[no-untyped-call]  # matplotlib has no annotation here
    figure.set_dpi(dpi)
    rows = np.asarray(canvas.buffer_rgba())[::-1]  # type: ignore[no-untyped-call]  # as above
    # a minimum over the last axis takes five times as long
    lightest = np.minimum(np.minimum(rows[..., 0], rows[..., 1]), rows[..., 2])
    dark = 255 - lightest.astype(int)
    is_dark = dark > 255 * FAINT
    is_faint = (dark > 255 * TINT) & ~is_dark
    return _summed(np.where(is_dark, dark, 0)), _summed(np.where(is_faint, dark, 0))


def _summed(dark: Array) -> Ink:
    sums = np.zeros((dark.shape[0] + 1, dark.shape[1] + 1))
    sums[1:, 1:] = (dark / 255.0).cumsum(axis=0).cumsum(axis=1)
    return Ink(sums)
