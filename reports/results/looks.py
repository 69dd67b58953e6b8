"""Looks of engines and their settings, in figures and on pages: colour, marker and line."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from reports.output.palette import colours_of
from reports.protocol.length import SECONDS, common_clock
from reports.results.lines import Line, Named, called, named, registered

SYMBOLS = (
    *("circle", "square", "diamond", "triangle-up", "cross", "star"),
    *("triangle-down", "hourglass", "x"),
)
"""Names of the markers in Plotly; the legends draw the same."""
DASHES = ("solid", "dash", "dot", "dashdot")
SIZES = (11.0, 9.5, 8.0, 6.5)
"""Sizes of markers: equal curves of one engine are seen as rims around each other."""


@dataclass(frozen=True)
class Look:
    """An engine with one set of settings: its number in the page, and its marks.

    Engines differ in marker and colour: the first three have a family of colours each, further ones
    a colour. The settings of an engine differ in dash, and in colour within a family: distinct
    without colours as well.
    """

    number: int
    engine: str
    variant: str
    version: str
    colour: int
    symbol: str
    dash: str
    size: float
    formulation: str = "own"
    precision: str = "double"

    @property
    def name(self) -> str:
        return f"{self.engine} {self.variant}"


def looks(lines: Iterable[Line]) -> Mapping[Named, Look]:
    """Return a look for every engine, variant and drive, in the order of the lines; without the
    drive if all lines are free motions."""
    lines = tuple(lines)
    bare = common_clock(line.drive for line in lines) is SECONDS
    every: dict[Named, Look] = {}
    engines: dict[str, int] = {}
    for line in lines:
        if named(line) in every:
            continue
        family = engines.setdefault(line.engine, len(engines))
        place = sum(1 for engine, *_ in every if engine == line.engine)
        own = registered(line.engine)
        every[named(line)] = Look(
            number=len(every),
            engine=line.engine,
            variant=line.variant if bare else called(line.variant, line.drive),
            version=line.version,
            colour=colours_of(family)[place % len(colours_of(family))],
            symbol=SYMBOLS[family % len(SYMBOLS)],
            dash=DASHES[place % len(DASHES)],
            size=SIZES[place % len(SIZES)],
            formulation=own.formulation,
            precision=own.precision,
        )
    return every
