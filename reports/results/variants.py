"""Variants, engines with their settings: how they look in all diagrams, and what they set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from reports.results.lines import Line, Named, called, named
from reports.way.clock import SECONDS, common_clock
from sim.engine import SettingValue

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


OWN = "every setting as the engine is shipped"


def usual(lines: Sequence[Line], engine: str) -> Line:
    """What the others of an engine are held against: it as shipped, or else its first variant."""
    own = [line for line in lines if line.engine == engine]
    return next((line for line in own if line.variant == "as-shipped"), own[0])


def settings_told(lines: Sequence[Line]) -> Mapping[Named, str]:
    """The settings of each variant, by engine, variant and drive.

    Those of an engine as shipped go without saying; where it was not run so, its first variant is
    told in full, and of the others what differs from that.
    """
    return {named(line): _told(line, lines) for line in lines}


def value_text(value: SettingValue | None) -> str:
    """A value as it is shown; empty for a setting that is not there."""
    if value is None:
        return ""
    return f"{value:g}" if isinstance(value, float) else str(value) or "none"


def _told(line: Line, lines: Sequence[Line]) -> str:
    first = usual(lines, line.engine)
    if first.variant == "as-shipped":
        return _words(_differing(line, first)) or OWN
    name = called(first.variant, first.drive)
    if (line.variant, line.drive) == (first.variant, first.drive):
        return _words(line.settings)
    differing = _words(_differing(line, first))
    return f"as {name}, but {differing}" if differing else f"as {name}"


def _differing(line: Line, other: Line) -> Mapping[str, SettingValue]:
    """The settings of a line that another one has not, or otherwise."""
    return {
        name: value
        for name, value in line.settings.items()
        if name not in other.settings or other.settings[name] != value
    }


def _words(settings: Mapping[str, SettingValue]) -> str:
    return ", ".join(f"{name} {value_text(value)}" for name, value in settings.items())
