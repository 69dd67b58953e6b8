"""Formulas of pages, `$...$` in a line and `$$...$$` by itself, as MathML: browsers draw it
without a script.

An extension of Python-Markdown; what stands in code is left alone.
"""

from __future__ import annotations

import re
from typing import Any
from xml.etree.ElementTree import Element

from latex2mathml.converter import convert
from markdown import Markdown
from markdown.extensions import Extension
from markdown.inlinepatterns import InlineProcessor

DISPLAYED = r"\$\$(.+?)\$\$"
INLINE = r"(?<![\\$\w])\$(?![\s$])([^$\n]*(?:\n[^$\n]+)*?)(?<![\s\\])\$(?![\w$])"
BEFORE_ESCAPES_AFTER_CODE = 186
"""Python-Markdown takes code at 190 and backslashes at 180."""

OVERLINED = re.compile(r'<mover>((?:(?!<mover>).)*?)<mo accent="true">&#x02015;</mo></mover>')
"""A length such as AB: that bar does not stretch, and browsers draw a border in its place."""


FENCE = re.compile(r"(?:\\left|\\right)?\\([lr])vert(?![A-Za-z])")
SIDES = {"l": r"\left|", "r": r"\right|"}
"""Bars about a size: only in pairs of these are they fences, else the sign of "divides"."""


class FormulaError(Exception):
    """LaTeX that there is no MathML for."""


class Formula(InlineProcessor):
    """One of the two kinds of formulas."""

    def __init__(self, pattern: str, md: Markdown, display: str) -> None:
        super().__init__(pattern, md)
        self.display = display
        self.compiled_re = re.compile(pattern, re.DOTALL)

    def handleMatch(  # noqa: N802
        self, m: re.Match[str], data: str
    ) -> tuple[str | Element, int, int]:
        told = mathml(m[1], self.display)
        if self.display == "block":
            told = f'<span class="formula">{told}</span>'
        return self.md.htmlStash.store(told), m.start(0), m.end(0)


class Formulas(Extension):
    """Adds both kinds."""

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802
        at = BEFORE_ESCAPES_AFTER_CODE
        md.inlinePatterns.register(Formula(DISPLAYED, md, "block"), "displayed formula", at)
        md.inlinePatterns.register(Formula(INLINE, md, "inline"), "formula", at - 1)


def mathml(latex: str, display: str = "inline") -> str:
    """The MathML of a formula. Raises FormulaError, with the formula, where a part is not known."""
    known = latex.strip().replace("{aligned}", "{align*}")
    known = FENCE.sub(lambda bar: SIDES[bar[1]], known)
    try:
        told = convert(known, display=display)
    except Exception as fault:  # of no common kind
        raise FormulaError(f"no MathML for ${latex}$: {fault!r}") from fault
    told = OVERLINED.sub(r'<mrow class="overlined">\1</mrow>', told)
    if unknown := re.search(r"\\[A-Za-z]+|<mi>&</mi>|<mspace linebreak", told):
        raise FormulaError(f"no MathML for {unknown[0]} in ${latex}$")
    return told


def fault_of(page: str) -> str:
    """The formula of a page that there is no MathML for, "" where all have one."""
    try:
        Markdown(extensions=["tables", "pymdownx.superfences", Formulas()]).convert(page)
    except FormulaError as fault:
        return str(fault)
    return ""


def makeExtension(**options: Any) -> Formulas:  # noqa: N802
    """What Python-Markdown calls."""
    return Formulas(**options)
