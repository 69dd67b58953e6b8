"""Look of all figures (type, lines and sizes of a paper), and sets of figures as files of a folder.

Text stays text in SVG and PDF.
"""

import base64
import io
import logging
import math
import re
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from html import unescape
from pathlib import Path
from typing import Any, Generic, Literal, Protocol, TypeVar

import numpy as np
from fontTools.subset import (  # type: ignore[import-untyped]  # ships no stubs
    Options,
    Subsetter,
)
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]  # as above
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont
from matplotlib.textpath import text_to_path
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from models.array import Array
from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.layout import DOTS_PER_IN, FONT, LAYOUT
from reports.output.numbers import count
from reports.output.write import clean, crankcheck_version, write

Look = dict[str, Any]
"""Look of a line, in keywords of matplotlib."""
COLUMN_IN, PAGE_IN = 3.4, 7.0
"""Widths of a column and of a page of two [inch]."""
POINTS = 72.0
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
    """Draw and write figures in the style within this context; nothing outside changes."""
    fonts = LAYOUT.get().fonts
    own = RC | {"font.family": fonts} if len(fonts) > 1 else RC
    with (
        rc_context(own),  # type: ignore[arg-type]  # the names are matplotlib's, the values ours
        warnings.catch_warnings(),
    ):
        # A name may have letters that the font lacks: in an SVG they are another font's.
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        yield


def width_in(text: str, size: float = SMALL) -> float:
    """Return the width of a text [inch]."""
    return _width_in(text, size, LAYOUT.get().fonts)


@lru_cache(maxsize=4096)
def _width_in(text: str, size: float, fonts: Sequence[str]) -> float:
    font = FontProperties(family=fonts, size=size)
    return float(text_to_path.get_text_width_height_descent(text, font, False)[0]) / POINTS


def cut(text: str, room_in: float, size: float = SMALL) -> str:
    """Return a text in one line, without its middle where it is too wide."""
    text = " ".join(text.split())
    if width_in(text, size) <= room_in:
        return text
    for kept in range(len(text) - 1, 1, -1):
        short = f"{text[: kept - kept // 2].rstrip()}…{text[len(text) - kept // 2 :].lstrip()}"
        if width_in(short, size) <= room_in:
            return short
    return "…"


def wrapped(text: str, room_in: float, size: float = SMALL) -> list[str]:
    """Return a text in lines that are no wider than there is room; a longer word is broken."""
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
    """Return 10⁻³ and the like."""
    return f"10{str(round(math.log10(value))).translate(RAISED)}"


def decades(low: float, high: float, ticks: int) -> list[float]:
    """Return powers of ten within an axis, at most about ``ticks`` of them."""
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    every = max(1, math.ceil((last - first + 1) / max(ticks, 1)))
    return [10.0**n for n in range(first, last + 1) if n % every == 0]


def logarithmic(axes: Axes, which: str, low: float, high: float, ticks: int = 8) -> None:
    """Set a logarithmic axis with numbers at powers of ten, and small ticks where these are few."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    (axes.set_xlim if which == "x" else axes.set_ylim)(low, high)
    axis.set_major_locator(FixedLocator(decades(low, high, ticks)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: power_of_ten(value)))
    few = high / low < 10.0**FEW
    axis.set_minor_locator(LogLocator(subs=range(2, 10)) if few else NullLocator())
    axis.set_minor_formatter(NullFormatter())


def mark_zero(axes: Axes, *series: Array) -> None:
    """Draw a line at 0 where the series come near to it; else they have the axis for themselves."""
    low, high = min(map(np.min, series)), max(map(np.max, series))
    if low <= 0.2 * high and high >= 0.2 * low:
        axes.axhline(0.0, color=QUIET, linewidth=0.5)


def shorten(axes: Axes) -> None:
    """Set short numbers on the vertical axis, with one power of ten for all of them."""
    axes.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=False)
    axes.yaxis.get_offset_text().set_fontsize(SMALL)


Face = Literal["normal", "italic"]
LETTERS = frozenset(map(chr, range(32, 127))) | frozenset("⁻⁰¹²³⁴⁵⁶⁷⁸⁹±…\N{MINUS SIGN}")
"""Letters in every file, so that most figures share the same cut of a font."""
FACES: dict[Face, str] = {"normal": "", "italic": "italic"}
"""Styles of the font, and the sign in an SVG that needs them."""
IDLE = re.compile(r' transform="rotate\(-0 [^"]*"|(?<=\n) +')
"""Parts of an SVG by matplotlib that do nothing: turns by 0, and indents."""
TEXT = re.compile(r"<text[^>]*>(.*?)</text>", re.DOTALL)


FACTS: Mapping[str, Mapping[str, str | None]] = {
    "svg": {"Creator": "crankcheck", "Date": None},
    "pdf": {"Creator": "crankcheck", "CreationDate": None},
    "png": {"Software": "crankcheck"},
}


def saved(figure: Figure, kind: str, title: str) -> bytes:
    """Return the file of a figure, of a kind in `DOTS_PER_IN`, without a date.

    In an SVG all text is text, and the letters that it needs of its font go with it; in a PDF the
    fonts are TrueType (type 42), so that text can be searched and edited.
    """
    facts = {"Title": clean(title), **FACTS[kind]}
    buffer = io.BytesIO()
    with styled():
        figure.savefig(buffer, format=kind, metadata=facts, dpi=DOTS_PER_IN[kind])
    raw = buffer.getvalue()
    return _with_fonts(clean(raw.decode())).encode() if kind == "svg" else raw


def _with_fonts(svg: str) -> str:
    svg = IDLE.sub("", svg)
    texts = TEXT.findall(svg)
    letters = "".join(sorted(LETTERS.union(unescape("".join(texts))) - {"\n"}))
    faces = [style for style, sign in FACES.items() if sign in svg]
    fonts = LAYOUT.get().fonts
    rules = "".join(_rule(font, style, letters) for font in fonts for style in faces)
    return svg.replace("<defs>", f'<defs>\n  <style type="text/css">{rules}</style>', 1)


def _rule(font: str, style: Face, letters: str) -> str:
    """Return the style sheet's rule for a face; its bytes are a WOFF file."""
    code = base64.b64encode(_letters_of(font, style, letters)).decode()
    return (
        f"@font-face{{font-family:'{font}';font-style:{style};"
        f"src:url(data:font/woff;base64,{code})}}"
    )


@lru_cache(maxsize=64)
def _letters_of(family: str, style: Face, letters: str) -> bytes:
    """Return a face cut down to some letters, as a WOFF file."""
    logging.getLogger("fontTools.subset").setLevel(logging.ERROR)  # it reports dropped tables
    path = findfont(FontProperties(family=family, style=style))
    options = Options()
    options.hinting, options.layout_features = False, []
    with TTFont(path, recalcTimestamp=False, fontNumber=0) as font:
        cutter = Subsetter(options)
        cutter.populate(text=letters)
        cutter.subset(font)
        font.flavor = "woff"
        buffer = io.BytesIO()
        font.save(buffer)
    return buffer.getvalue()


class Solved(Protocol):
    """Input of such figures."""

    @property
    def scene(self) -> Scene: ...


Of = TypeVar("Of", bound=Solved)


@dataclass(frozen=True)
class FigureSet(Generic[Of]):
    """Figures by the name of their file, and ``of``, their subject in words, if they have one. Each
    gives None where there is nothing to draw. To add one, add a function and its line."""

    of: str
    draws: Mapping[str, Callable[[Of], Figure | None]]

    @property
    def files(self) -> list[str]:
        """Names of all files that may be written."""
        return [f"{name}.{kind}" for name in self.draws for kind in LAYOUT.get().formats]

    def pictures(self, solved: Of) -> dict[str, bytes]:
        """Return the figures as SVG files by name."""
        return {name: self._saved(solved, name, each) for name, each in self._drawn(solved)}

    def written(self, solved: Of, folder: Path) -> str:
        """Write all figures; returns a line on their files. Raises CrankcheckError if refused."""
        names = []
        for name, figure in self._drawn(solved):
            names.append(name)
            for kind in LAYOUT.get().formats:
                write(folder / f"{name}.{kind}", self._saved(solved, name, figure, kind))
        figures = count(len(names), "figure") + f" of {self.of}" * bool(self.of)
        return f"{folder}: {figures}, each as {LAYOUT.get().in_words}: {', '.join(names)}"

    def _drawn(self, solved: Of) -> Iterator[tuple[str, Figure]]:
        for name, draw in self.draws.items():
            with styled():
                figure = draw(solved)
            if figure is not None:
                yield name, figure

    @staticmethod
    def _saved(solved: Of, name: str, figure: Figure, kind: str = "svg") -> bytes:
        return saved(figure, kind, f"{solved.scene.name}: {name}")


def note(scene: Scene, how: str, driver: str, *more: str) -> str:
    """Return the note under a figure: its method, the law of the driver, and the loads."""
    gravity = float(np.hypot(*scene.gravity_m_s2))
    parts = [
        f"crankcheck {crankcheck_version()}, {how}",
        f"{driver} {describe_law(scene)}",
        f"gravity {gravity:g} m/s²" if gravity else "no gravity",
        *more,
    ]
    return f"{'; '.join(parts)}."


def loads_told(scene: Scene) -> str:
    """Return the loads of a scene by name."""
    return f"loads: {', '.join(scene.loads)}" if scene.loads else "no loads"
