"""Sets of figures of what is solved: as files of a folder, and what stands under each figure."""

import base64
import io
import logging
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from html import unescape
from pathlib import Path
from typing import Generic, Literal, Protocol, TypeVar

import numpy as np
from fontTools.subset import (  # type: ignore[import-untyped]  # ships no stubs
    Options,
    Subsetter,
)
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]  # as above
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont

from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.style import FONT, styled
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.output.write import clean, write

FORMATS = ("svg", "pdf")
Face = Literal["normal", "italic"]
LETTERS = frozenset(map(chr, range(32, 127))) | frozenset("⁻⁰¹²³⁴⁵⁶⁷⁸⁹±…\N{MINUS SIGN}")
"""Always there, so that most figures share the same cut of a font."""
FACES: dict[Face, str] = {"normal": "", "italic": "italic"}
"""Styles of the font, and what an SVG has that needs them."""
TEXT = re.compile(r"<text[^>]*>(.*?)</text>", re.DOTALL)


def saved(figure: Figure, kind: str, title: str) -> bytes:
    """The file of a figure, of a kind in `FORMATS`, without a date.

    In an SVG all text is text, and the letters that it needs of its font go with it; in a PDF the
    fonts are TrueType (type 42), so that text can be searched and edited.
    """
    undated = {"svg": "Date", "pdf": "CreationDate"}[kind]
    buffer = io.BytesIO()
    with styled():
        figure.savefig(buffer, format=kind, metadata={"Title": clean(title), undated: None})
    raw = buffer.getvalue()
    return _with_fonts(clean(raw.decode())).encode() if kind == "svg" else raw


def _with_fonts(svg: str) -> str:
    """The drawing with the letters of its texts as fonts in a style sheet."""
    texts = TEXT.findall(svg)
    letters = "".join(sorted(LETTERS.union(unescape("".join(texts))) - {"\n"}))
    rules = "".join(_rule(style, letters) for style, sign in FACES.items() if sign in svg)
    return svg.replace("<defs>", f'<defs>\n  <style type="text/css">{rules}</style>', 1)


def _rule(style: Face, letters: str) -> str:
    """The style sheet's rule for a face; its bytes are those of a WOFF file."""
    code = base64.b64encode(_letters_of(style, letters)).decode()
    return (
        f"@font-face{{font-family:'{FONT}';font-style:{style};"
        f"src:url(data:font/woff;base64,{code})}}"
    )


@lru_cache(maxsize=64)
def _letters_of(style: Face, letters: str) -> bytes:
    """A face cut down to some letters, as a WOFF file."""
    logging.getLogger("fontTools.subset").setLevel(logging.ERROR)  # it tells of tables it drops
    path = findfont(FontProperties(family=FONT, style=style))
    options = Options()
    options.hinting, options.layout_features = False, []
    with TTFont(path, recalcTimestamp=False) as font:
        cutter = Subsetter(options)
        cutter.populate(text=letters)
        cutter.subset(font)
        font.flavor = "woff"
        buffer = io.BytesIO()
        font.save(buffer)
    return buffer.getvalue()


class Solved(Protocol):
    """What such figures are drawn of."""

    @property
    def scene(self) -> Scene: ...


Of = TypeVar("Of", bound=Solved)


@dataclass(frozen=True)
class FigureSet(Generic[Of]):
    """Figures by name, which is that of their file, and ``of`` what they are in words. Each gives
    None where there is nothing to draw. To add one, add a function and its line."""

    of: str
    draws: Mapping[str, Callable[[Of], Figure | None]]

    @property
    def files(self) -> list[str]:
        """The names of all files that may be written."""
        return [f"{name}.{kind}" for name in self.draws for kind in FORMATS]

    def pictures(self, solved: Of) -> dict[str, bytes]:
        """The figures as SVG files by name."""
        return {name: self._saved(solved, name, each) for name, each in self._drawn(solved)}

    def written(self, solved: Of, folder: Path) -> str:
        """Write all figures; returns what was written, in a line. Raises CrankcheckError where the
        system refuses."""
        names = []
        for name, figure in self._drawn(solved):
            names.append(name)
            for kind in FORMATS:
                write(folder / f"{name}.{kind}", self._saved(solved, name, figure, kind))
        kinds = " and ".join(f".{kind}" for kind in FORMATS)
        figures = count(len(names), "figure")
        return f"{folder}: {figures} of {self.of}, each as {kinds}: {', '.join(names)}"

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
    """What stands under a figure: how it was solved, the law of the driver, and the loads."""
    gravity = float(np.hypot(*scene.gravity_m_s2))
    parts = [
        f"crankcheck {crankcheck_version()}, {how}",
        f"{driver} {describe_law(scene)}",
        f"gravity {gravity:g} m/s²" if gravity else "no gravity",
        *more,
    ]
    return f"{'; '.join(parts)}."


def loads_told(scene: Scene) -> str:
    """The loads of a scene by name."""
    return f"loads: {', '.join(scene.loads)}" if scene.loads else "no loads"
