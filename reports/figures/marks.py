"""How variants are told apart without colour: marker, filled or open, dashes, and brightness."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from reports.results.lines import Line, Named, named

MARKERS = ("o", "s", "^", "D", "v", "<", ">", "p", "X", "P", "h", "*")
DASHES: tuple[tuple[float, ...], ...] = (
    (),
    (4.0, 1.5),
    (1.0, 1.2),
    (6.0, 1.5, 1.0, 1.5),
    (2.5, 1.0),
    (6.0, 1.2, 1.0, 1.2, 1.0, 1.2),
    (9.0, 2.0),
)
"""Lengths of dashes and gaps in line widths; none is a whole line."""
COLOURS = (
    ("#0a2a4d", "#1f5f9e", "#4a90c9", "#79b1dc"),
    ("#7a1f0f", "#c04a1d", "#d97b35", "#dc9f66"),
    ("#0f4023", "#2f7d4c", "#55a572", "#84bf97"),
    ("#3b1a5a", "#71479f", "#9877bd", "#b89fd3"),
)
"""One hue an engine, from dark to light."""
SIZES = {True: (3.0, 3.4, 3.8, 4.2), False: (2.6, 4.0, 5.4, 6.0)}
"""Of filled and open markers [point]: open ones of equal curves stand around each other."""


@dataclass(frozen=True)
class Mark:
    """How the curve of a variant looks."""

    marker: str
    filled: bool
    dashes: tuple[float, ...]
    colour: str
    size: float

    def scaled(self, factor: float) -> Mark:
        """The same with smaller markers, for smaller panels."""
        return replace(self, size=factor * self.size)

    @property
    def style(self) -> dict[str, Any]:
        """What `Axes.plot` takes for it."""
        return {**self.line, **self.points}

    @property
    def line(self) -> dict[str, Any]:
        """The line alone."""
        dashes: object = (0, self.dashes) if self.dashes else "-"
        return {"color": self.colour, "linestyle": dashes, "linewidth": 1.0}

    @property
    def points(self) -> dict[str, Any]:
        """The marker alone."""
        return {
            "marker": self.marker,
            "markersize": self.size,
            "markerfacecolor": self.colour if self.filled else "none",
            "markeredgecolor": self.colour,
            "markeredgewidth": 0.8,
        }


def marks(lines: Iterable[Line]) -> Mapping[Named, Mark]:
    """A mark for each variant, the same in all figures of a store.

    No two have the same marker and dashes; engines differ in filling and hue as well.
    """
    names = list(dict.fromkeys(named(line) for line in lines))
    engines = list(dict.fromkeys(engine for engine, _, _ in names))
    before = dict.fromkeys(engines, 0)
    every: dict[Named, Mark] = {}
    for name in names:
        at, k = engines.index(name[0]), before[name[0]]
        before[name[0]] += 1
        every[name] = Mark(
            marker=MARKERS[k % len(MARKERS)],
            filled=at % 2 == 0,
            dashes=_dashes(k // len(MARKERS) * len(engines) + at),
            colour=COLOURS[at % len(COLOURS)][k % len(COLOURS[0])],
            size=SIZES[at % 2 == 0][k % len(COLOURS[0])],
        )
    return every


def _dashes(turn: int) -> tuple[float, ...]:
    """The dashes of a number: those of the list, then the same ones longer and longer."""
    round_, at = divmod(turn, len(DASHES))
    if not round_:
        return DASHES[at]
    return tuple(length + 1.5 * round_ for length in DASHES[at] or (12.0, 1.0))
