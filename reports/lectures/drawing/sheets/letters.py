"""Letters and numbers beside their points: clear of all lines and of one another.

A letter is as near as possible; where all near places are taken it is farther off, with a thin line
to its point. Among faint lines it interrupts these, as draughtsmen do.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Rectangle
from matplotlib.textpath import TextPath

from models.array import Array
from reports.figures.layout import FONT
from reports.figures.style import INK, POINTS, QUIET, styled
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, Canvas, line, text

PIXEL_MM = 0.2
TINT, FAINT = 0.08, 0.36
"""Limits of darkness: below the first a pixel counts as blank (the inside of a plate is paper with
a tint), below the second as a faint line, which may be interrupted."""


@dataclass(frozen=True)
class Ink:
    """The darkness of a sheet: ``below_left`` (rows + 1, columns + 1) has the sum of all pixels
    below and on the left of each corner of a pixel; the sheet's lower left corner is the first."""

    below_left: Array

    def within(self, middles: Array, half: Array) -> Array:
        """Darkness times area [mm²], in boxes of half a size (2,) about places (k, 2) [mm];
        (k,)."""
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
    """Render a figure as it is now: its dark lines, and its faint ones."""
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


LETTER, NUMBER = 8.0, 5.5
"""Type of the letters of points, and of numbers along a circle [point]."""
CLEAR_MM, AIRY_MM = 0.45, 1.0
"""Room around a text that must be blank, and that preferably is [mm]."""
AWAY_MM = (0.3, 0.6, 1.0, 1.5, 2.0, 2.8, 3.6, 4.5, 6.0, 8.0, 10.0, 13.0, 16.0, 20.0)
"""Distances of the edge of a text from its point [mm]."""
LED_MM = 2.6
"""Distance from which a text has a line to its point [mm]."""
AROUND = 32
FRONT = 8
"""Drawing order of letters: over everything in their layer."""
DARK_COST, FAINT_COST, AIRY_COST, LED_COST = 60.0, 6.0, 0.2, 1.5
"""Costs, in millimetres of distance: of a square millimetre of dark or of faint lines under a text,
of any line close by, and of a leading line."""
COVER_COST, CROSS_COST = 1e4, 30.0
"""Costs of covering another text or leaving the box, and of covering a leading line."""
LOOKED_AT = 600
"""Number of places examined: those that are best except other texts."""
LEADING = np.linspace(0.0, 1.0, 12)
"""Shares of a leading line at which it is examined."""
GROUND_MM = 0.2
"""Width of the blank around a text that interrupts faint lines [mm]."""
ROUNDING = 1e-6
"""Ink [mm²] within the rounding of sums."""


@dataclass(frozen=True)
class Letter:
    """A text that names one of the places ``at`` (n, 2) [mm], drawn with a radius [mm]."""

    text: str
    at: Array
    radius: float
    size: float = LETTER
    color: str = INK

    @property
    def half(self) -> Array:
        """Half the width and height of the print [mm]."""
        low, high = _printed(self.text, self.size)
        return (high - low) / 2

    def base(self, middle: Array) -> Array:
        """The start of the base line of a text whose print has its middle at a place [mm]."""
        low, high = _printed(self.text, self.size)
        return np.asarray(middle - (low + high) / 2)


@lru_cache(maxsize=1024)
def _printed(words: str, size: float) -> tuple[Array, Array]:
    """The corners of a text's outlines, from the start of its base line [mm]."""
    outline = TextPath((0.0, 0.0), words, size, prop=FontProperties(family=FONT)).get_extents()
    low, high = np.array(outline.min), np.array(outline.max)
    return MM_PER_IN / POINTS * low, MM_PER_IN / POINTS * high


def together(at: Mapping[str, Array], within_mm: float) -> dict[str, Array]:
    """Names at their places [mm]; names within a distance of one another are joined."""
    spots: dict[str, Array] = {}
    for name, there in at.items():
        same = [one for one, spot in spots.items() if np.hypot(*(spot - there)) < within_mm]
        if same:
            spots = {
                f"{one}, {name}" if one == same[0] else one: spot for one, spot in spots.items()
            }
        else:
            spots[name] = there
    return spots


def write_letters(
    canvas: Canvas,
    axes: Axes,
    letters: Iterable[Letter],
    box: Box,
    ink: tuple[Ink, Ink] | None = None,
) -> None:
    """Write letters in a box of the sheet, the first with the first choice; ``ink`` is the drawing
    in the box, where known, as rendering costs more than all else."""
    dark, faint = ink or ink_of(canvas.figure)
    taken: list[tuple[Array, Array]] = []
    for letter in letters:
        middle, anchor = _best(letter, dark, faint, taken, box)
        half = letter.half
        if faint.within(middle[None], half + GROUND_MM)[0] > ROUNDING:
            _interrupt(axes, middle, half + GROUND_MM)
        x, y = letter.base(middle)
        text(axes, x, y, letter.text, letter.size, color=letter.color, zorder=FRONT)
        taken.append((middle, half))
        if (lead := _lead(letter, middle, anchor)) is not None:
            line(axes, *lead, color=QUIET, linewidth=0.3)
            taken += [(spot, np.zeros(2)) for spot in _sampled(*lead)]


def _interrupt(axes: Axes, middle: Array, half: Array) -> None:
    """Draw blank paper under a text."""
    wide, tall = 2 * half
    ground = Rectangle(tuple(middle - half), wide, tall, fc="white", ec="none")
    ground.set_gid("blank")
    axes.add_patch(ground)


def _best(
    letter: Letter, dark: Ink, faint: Ink, taken: Sequence[tuple[Array, Array]], box: Box
) -> tuple[Array, Array]:
    """The middle of the best place for a text, and the place that it names from there [mm]."""
    middles, anchors, away = _candidates(letter)
    half, clear = letter.half, letter.half + CLEAR_MM
    low = np.array([box.left, box.bottom]) + clear
    high = np.array([box.left + box.width, box.bottom + box.height]) - clear
    outside = np.maximum(low - middles, 0.0) + np.maximum(middles - high, 0.0)
    over = dark.within(middles, clear)
    cost = (
        away
        + LED_COST * (away > LED_MM)
        + DARK_COST * (over + 0.5 * (over > ROUNDING))
        + FAINT_COST * faint.within(middles, half + GROUND_MM)
        + AIRY_COST * (dark.within(middles, half + AIRY_MM) + faint.within(middles, half + AIRY_MM))
        + COVER_COST * outside.sum(axis=1)
    )
    few = np.argsort(cost, kind="stable")[:LOOKED_AT]
    covered = np.zeros(len(few))
    # along the line that would lead to it, too
    ways = anchors[few, None] + LEADING[:, None] * (middles - anchors)[few, None]
    for middle, size in taken:
        here = np.all(np.abs(middles[few] - middle) < clear + size, axis=1)
        covered += (COVER_COST if size.any() else CROSS_COST) * here
        if size.any():
            across = np.all(np.abs(ways - middle) < size, axis=2).any(axis=1)
            covered += COVER_COST * (across & (away[few] > LED_MM))
    best = few[int(np.argmin(cost[few] + covered))]
    return middles[best], anchors[best]


def _candidates(letter: Letter) -> tuple[Array, Array, Array]:
    """Middles around each place (k, 2), the place of each, and the distance of its edge."""
    angle = math.tau * np.arange(AROUND) / AROUND + math.pi / 4
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    with np.errstate(divide="ignore"):
        edge = np.min(letter.half / np.abs(direction), axis=1)
    away = np.repeat(AWAY_MM, AROUND)
    reach = np.tile(edge, len(AWAY_MM)) + away + letter.radius
    around = np.tile(direction, (len(AWAY_MM), 1)) * reach[:, None]
    at = np.atleast_2d(letter.at)
    middles = (at[:, None] + around).reshape(-1, 2)
    return middles, np.repeat(at, len(around), axis=0), np.tile(away, len(at))


def _lead(letter: Letter, middle: Array, anchor: Array) -> tuple[Array, Array] | None:
    """The line from a text to its point, where the text is far off."""
    nearest = np.clip(anchor, middle - letter.half - 0.3, middle + letter.half + 0.3)
    length = float(np.hypot(*(anchor - nearest)))
    if length - letter.radius < LED_MM:
        return None
    return nearest, anchor + (nearest - anchor) * letter.radius / length


def _sampled(start: Array, end: Array) -> Array:
    """Points along a line [mm], closely spaced."""
    return np.linspace(start, end, max(int(2 * np.hypot(*(end - start))), 1) + 1)
