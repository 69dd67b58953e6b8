"""A characteristic of steps: what is switched on, and off again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.characteristics import Characteristic


@dataclass(frozen=True)
class Staircase(Characteristic):
    """``values[k]`` from ``places[k]`` on, up to the next place; 0 before the first.

    In a place itself the new value holds. Its slope is without bound there, so that whoever needs
    one (`steepest`) is told infinity.
    """

    places: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.places) != len(self.values) or not self.places:
            raise ValueError(
                f"found {len(self.places)} places and {len(self.values)} values; give one each, of "
                "one step at least"
            )
        for before, after in zip(self.places, self.places[1:], strict=False):
            if not after > before:
                raise ValueError(
                    f"found {after:g} after {before:g}; the instants of steps have to increase "
                    "from one to the next"
                )

    @property
    def kinks(self) -> tuple[float, ...]:
        return self.places

    def at(self, x: Array) -> Array:
        level = np.searchsorted(self.places, x, side="right")
        return np.asarray(np.concatenate([[0.0], self.values])[level])

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        low = np.searchsorted(self.places, np.asarray(x) - by, side="left")
        high = np.searchsorted(self.places, np.asarray(x) + by, side="right")
        return np.where((high > low) & (np.asarray(by) > 0.0), np.inf, 0.0)

    def rounding(self, x: Array) -> Array | float:
        return 0.0

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Staircase:
        if stretch < 0.0:
            raise ValueError("steps have no mirror image: what is on for ever would have been so")
        places = tuple(stretch * place + shift for place in self.places)
        return Staircase(places, tuple(size * value for value in self.values))
