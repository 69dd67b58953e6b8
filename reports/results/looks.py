"""How engines and their settings look in all diagrams: colours in families, a marker per engine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from reports.results.lines import Line, Named, called, named
from reports.way.clock import SECONDS, common_clock

FAMILY = 4
"""Colours in a family; the style sheet has three families: cool, warm, and green with grey."""
FAMILIES = 3
SYMBOLS = ("circle", "square", "diamond", "triangle-up", "cross", "star")
"""Plotly's names of the markers; the legends draw the same."""
DASHES = ("solid", "dash", "dot", "dashdot")
SIZES = (11.0, 9.5, 8.0, 6.5)
"""Of markers: equal curves of one engine are seen as rims around each other."""


@dataclass(frozen=True)
class Look:
    """An engine with one set of settings: its number in the page, and how it is drawn.

    Engines differ in marker and in the family of their colours, the settings of an engine in
    colour and dash: told apart without colours as well.
    """

    number: int
    engine: str
    variant: str
    version: str
    colour: int
    symbol: str
    dash: str
    size: float

    @property
    def name(self) -> str:
        return f"{self.engine} {self.variant}"


def looks(lines: Iterable[Line]) -> Mapping[Named, Look]:
    """A look for every engine, variant and drive, in the order of the lines; where all were let go
    the drive needs no word."""
    lines = tuple(lines)
    bare = common_clock(line.drive for line in lines) is SECONDS
    every: dict[Named, Look] = {}
    engines: dict[str, int] = {}
    for line in lines:
        if named(line) in every:
            continue
        family = engines.setdefault(line.engine, len(engines))
        place = sum(1 for engine, *_ in every if engine == line.engine)
        every[named(line)] = Look(
            number=len(every),
            engine=line.engine,
            variant=line.variant if bare else called(line.variant, line.drive),
            version=line.version,
            colour=family % FAMILIES * FAMILY + place % FAMILY,
            symbol=SYMBOLS[family % len(SYMBOLS)],
            dash=DASHES[place % len(DASHES)],
            size=SIZES[place % len(SIZES)],
        )
    return every


def label(name: Named) -> str:
    """A variant as a legend calls it; the drive where it is not the usual one."""
    engine, variant, drive = name
    return f"{engine} {called(variant, drive)}"
