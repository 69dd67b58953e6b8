"""How all figures look: type, lines and sizes of a paper; text stays text in both formats."""

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from models.array import Array

Look = dict[str, Any]
"""How a line is drawn, as matplotlib names it."""
COLUMN_IN, PAGE_IN = 3.4, 7.0
"""Widths of a column and of a page of two [inch]."""
POINTS = 72.0
FONT = "DejaVu Sans"
"""Comes with matplotlib: a figure looks the same wherever it is drawn."""
LARGE, SIZE, SMALL, TINY = 8.0, 7.0, 6.0, 4.6
"""Type of titles, of labels, of ticks and legends, and of the notes under a figure [point]."""
INK, QUIET, FRONT = "#1a1a1a", "#6b6b6b", "#d2d2d2"
RC: dict[str, object] = {
    "axes.axisbelow": True,
    "axes.edgecolor": INK,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.labelpad": 2.0,
    "axes.labelsize": SIZE,
    "axes.linewidth": 0.6,
    "axes.titlelocation": "left",
    "axes.titlepad": 2.0,
    "axes.titlesize": SMALL,
    "font.family": "sans-serif",
    "font.sans-serif": [FONT, "Verdana", "Arial", "sans-serif"],
    "font.size": SIZE,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.4,
    "legend.fontsize": SMALL,
    "lines.linewidth": 1.0,
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
    "svg.hashsalt": "crankcheck",
    "text.color": INK,
    "text.parse_math": False,  # a dollar in a name is a dollar
    "xtick.color": INK,
    "xtick.direction": "in",
    "xtick.labelsize": SMALL,
    "xtick.major.pad": 3.2,
    "ytick.color": INK,
    "ytick.direction": "in",
    "ytick.labelsize": SMALL,
    "ytick.major.pad": 2.0,
}
FEW = 5
"""Decades of an axis that have room for small ticks between them."""
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@contextmanager
def styled() -> Iterator[None]:
    """In this context figures are drawn and written in the style; nothing outside changes."""
    with (
        rc_context(RC),  # type: ignore[arg-type]  # the names are matplotlib's, the values ours
        warnings.catch_warnings(),
    ):
        # A name may have letters that the font lacks: in an SVG they are another font's.
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        yield


@lru_cache(maxsize=4096)
def width_in(text: str, size: float = SMALL) -> float:
    """How wide a text is [inch]."""
    font = FontProperties(family=FONT, size=size)
    return float(text_to_path.get_text_width_height_descent(text, font, False)[0]) / POINTS


def cut(text: str, room_in: float, size: float = SMALL) -> str:
    """A text in one line, without its middle where it is too wide."""
    text = " ".join(text.split())
    if width_in(text, size) <= room_in:
        return text
    for kept in range(len(text) - 1, 1, -1):
        short = f"{text[: kept - kept // 2].rstrip()}…{text[len(text) - kept // 2 :].lstrip()}"
        if width_in(short, size) <= room_in:
            return short
    return "…"


def wrapped(text: str, room_in: float, size: float = SMALL) -> list[str]:
    """A text in lines that are no wider than there is room; a longer word is broken."""
    lines = [""]
    for word in text.split():
        joined = f"{lines[-1]} {word}".lstrip()
        if width_in(joined, size) <= room_in:
            lines[-1] = joined
            continue
        lines += [word] * bool(lines[-1])
        lines[-1] = word
        while width_in(lines[-1], size) > room_in and len(lines[-1]) > 1:
            fits = range(len(lines[-1]) - 1, 1, -1)
            kept = next((n for n in fits if width_in(lines[-1][:n], size) <= room_in), 1)
            lines[-1:] = [lines[-1][:kept], lines[-1][kept:]]
    return lines


def power_of_ten(value: float) -> str:
    """10⁻³ and the like."""
    return f"10{str(round(math.log10(value))).translate(RAISED)}"


def decades(low: float, high: float, ticks: int) -> list[float]:
    """Powers of ten within an axis, at most about ``ticks`` of them."""
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    every = max(1, math.ceil((last - first + 1) / max(ticks, 1)))
    return [10.0**n for n in range(first, last + 1) if n % every == 0]


def logarithmic(axes: Axes, which: str, low: float, high: float, ticks: int = 8) -> None:
    """A logarithmic axis with numbers at powers of ten, and small ticks where these are few."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    (axes.set_xlim if which == "x" else axes.set_ylim)(low, high)
    axis.set_major_locator(FixedLocator(decades(low, high, ticks)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: power_of_ten(value)))
    few = high / low < 10.0**FEW
    axis.set_minor_locator(LogLocator(subs=range(2, 10)) if few else NullLocator())
    axis.set_minor_formatter(NullFormatter())


def mark_zero(axes: Axes, *series: Array) -> None:
    """A line at 0 where the series come near to it; else they have the axis for themselves."""
    low, high = min(map(np.min, series)), max(map(np.max, series))
    if low <= 0.2 * high and high >= 0.2 * low:
        axes.axhline(0.0, color=QUIET, linewidth=0.5)


def shorten(axes: Axes) -> None:
    """Short numbers on the vertical axis, with one power of ten for all of them."""
    axes.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=False)
    axes.yaxis.get_offset_text().set_fontsize(SMALL)
