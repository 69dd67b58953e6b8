"""A section of the page, and its contents: text of a user's file, and drawings within the room."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from models.errors import cut, harmless
from models.files.assemble import toml_value
from reports.results.lines import Line, value_text
from reports.results.overview import Report
from reports.stability.matrix import Matrix
from sim.engine import Settings


@dataclass(frozen=True)
class PageReport(Report):
    """A store as the page shows it, with the hard cases that were run beside it, if any."""

    matrix: Matrix | None = None


@dataclass(frozen=True, eq=False)
class WaySection:
    """The section of a way: None where a store has none of its cells. ``lighter`` is the same with
    fewer drawings and curves, in a room of characters."""

    build: Callable[[PageReport], Section | None]
    lighter: Callable[[PageReport, int], Section | None] | None = None


@dataclass(frozen=True)
class Section:
    """A section: its place in the page, the words of its template, and the input of its scripts.

    ``template`` is a file of ``templates/sections``, or another file, rendered with ``words``.
    ``embedded`` is put into the page as JSON, to be read with ``crankcheck.embedded(anchor)``;
    ``scripts`` are files of ``assets`` that the section needs, in order, and ``styles`` its style
    sheets beside the page's own; ``plotly`` says that it draws diagrams.
    """

    anchor: str
    title: str
    template: str | Path
    words: Mapping[str, object] = field(default_factory=dict)
    embedded: Mapping[str, object] | None = None
    scripts: tuple[str, ...] = ()
    styles: tuple[str, ...] = ()
    plotly: bool = False


LONGEST = 80
"""Most characters of a name, for any header."""
LONGEST_SENTENCE = 2_000


def name_text(text: str, most: int = LONGEST) -> str:
    """Return a name on one line: ``\\u202e`` and the like, which reverse later text, as escapes."""
    return cut(" ".join(harmless(text).split()), most)


def sentence_text(text: str) -> str:
    """Return a sentence with such names on one line."""
    return name_text(text, LONGEST_SENTENCE)


def toml_text(value: object) -> str:
    """Return a value as exact TOML, to be copied: invisible characters as their numbers."""
    return "".join(each if each.isprintable() else _escape(each) for each in toml_value(value))


def _escape(character: str) -> str:
    number = ord(character)
    return f"\\u{number:04x}" if number < 0x10000 else f"\\U{number:08x}"


def setting_rows(
    columns: Sequence[Settings], usual: Settings
) -> list[tuple[str, list[tuple[str, bool]]]]:
    """Return each setting with its value in every column, and whether it differs from the usual."""
    rows = []
    for name in dict.fromkeys(name for own in columns for name in own):
        values = [value_text(own.get(name)) for own in columns]
        rows.append((name, [(each, each != value_text(usual.get(name))) for each in values]))
    return rows


BUDGET = 1_900_000
"""Characters for all drawings and curves: with Plotly (4.8 MB), 560 cells stay below 8 MB."""
LEAST = 2
"""Least number of steps of a line: the coarsest and the finest are always shown."""


def steps_held(sizes: dict[str, int], lines: tuple[Line, ...], budget: int = BUDGET) -> int:
    """Return how many steps of each line a page holds.

    ``sizes`` is the size of each traced cell [characters], by its key.
    """
    most = max((len(line.cells) for line in lines), default=LEAST)
    for number in range(most, LEAST, -1):
        taken = sum(sizes[key] for line in lines for key in chosen(line, sizes, number))
        if taken <= budget:
            return number
    return LEAST


def chosen(line: Line, sizes: dict[str, int], number: int) -> list[str]:
    """Return the keys of at most ``number`` traced cells: both ends of the line, evenly between."""
    keys = [str(key) for key in line.cells["key"] if str(key) in sizes]
    if len(keys) <= number:
        return keys
    places = np.unique(np.round(np.linspace(0, len(keys) - 1, number)).astype(int))
    return [keys[place] for place in places]


def fitting(order: Sequence[int], sizes: Sequence[int], room: int) -> list[int]:
    """Return the indices that fit a page, sorted, if they are taken in the given ``order``.

    ``sizes`` are in characters. An index that does not fit makes way for smaller ones.
    """
    kept = []
    for index in order:
        if sizes[index] <= room:
            room -= sizes[index]
            kept.append(index)
    return sorted(kept)
