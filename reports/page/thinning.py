"""Which cells of a line, and which pictures, a page draws when it can not hold all of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reports.results.lines import Line

BUDGET = 1_900_000
"""Characters for all drawings and curves: with Plotly (4.8 MB) a page of 560 cells stays below
8 MB."""
LEAST = 2
"""The coarsest and the finest step are always there."""


def steps_held(sizes: dict[str, int], lines: tuple[Line, ...], budget: int = BUDGET) -> int:
    """How many steps of each line a page holds.

    ``sizes`` says what each traced cell takes [characters], by its key.
    """
    most = max((len(line.cells) for line in lines), default=LEAST)
    for number in range(most, LEAST, -1):
        taken = sum(sizes[key] for line in lines for key in chosen(line, sizes, number))
        if taken <= budget:
            return number
    return LEAST


def chosen(line: Line, sizes: dict[str, int], number: int) -> list[str]:
    """The keys of at most ``number`` traced cells: the two ends of the line, and evenly between."""
    keys = [str(key) for key in line.cells["key"] if str(key) in sizes]
    if len(keys) <= number:
        return keys
    places = np.unique(np.round(np.linspace(0, len(keys) - 1, number)).astype(int))
    return [keys[place] for place in places]


def fitting(order: Sequence[int], sizes: Sequence[int], room: int) -> list[int]:
    """Which things a page holds, in their own order, when it takes them in the ``order`` given.

    ``sizes`` says what each takes [characters]. One that does not fit makes way for smaller ones.
    """
    kept = []
    for index in order:
        if sizes[index] <= room:
            room -= sizes[index]
            kept.append(index)
    return sorted(kept)
