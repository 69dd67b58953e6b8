"""A figure as the bytes of a file: the same figure gives the same bytes, on any day."""

from __future__ import annotations

import base64
import io
import logging
import re
from functools import lru_cache
from html import unescape
from typing import Literal

from fontTools.subset import (  # type: ignore[import-untyped]  # ships no stubs
    Options,
    Subsetter,
)
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]  # as above
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont

from reports.figures.style import FONT, styled
from reports.output.write import clean

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
