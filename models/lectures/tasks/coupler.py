"""The task of carrying a body through positions, as its coupler."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from models.files.schema import Coordinates
from models.lectures.tasks.positions import PositionsTask


class CouplerTask(PositionsTask):
    """A body is to be the coupler of a four-bar, in two to five positions.

    ``moving_m`` are moving pivots, where they are in the first position (of two and three; the two
    named points where it is silent); ``fixed_m`` the fixed pivots in their place (three positions).
    Of two positions, ``distances_m`` says how far the fixed pivots lie from the middles, to the
    left of the way along the bisector. ``driver`` is the side that is driven. ``best`` is how many
    solutions are listed where there are infinitely many.
    """

    moving_m: tuple[Coordinates, Coordinates] | None = None
    fixed_m: tuple[Coordinates, Coordinates] | None = None
    distances_m: Coordinates | None = None
    driver: Literal["first", "second", "either"] = "either"
    driving_dyad: bool = False

    @model_validator(mode="after")
    def _pivots_fit_the_count(self) -> CouplerTask:
        count = len(self.positions)
        if self.fixed_m is not None and self.moving_m is not None:
            raise ValueError("fixed_m and moving_m: the one follows from the other; give one")
        if self.fixed_m is not None and count != 3:
            raise ValueError(
                f"fixed_m: found with {count} positions; fixed pivots are given for three"
            )
        if self.moving_m is not None and count > 3:
            raise ValueError(
                f"moving_m: found with {count} positions; of four and five they follow from the "
                "positions, leave it out"
            )
        if self.distances_m is not None and count != 2:
            raise ValueError(
                f"distances_m: found with {count} positions; of more than two the centres of the "
                "circles are the fixed pivots, leave it out"
            )
        if self.driving_dyad and count != 2:
            raise ValueError(
                f"driving_dyad: found with {count} positions; a dyad leads to and fro between two"
            )
        if count < 4 and not self.names and self.moving_m is None and self.fixed_m is None:
            raise ValueError(
                "moving_m: missing; two or three positions by their angle need two moving pivots, "
                "where they are in the first position: moving_m = [[0.1, 0.2], [0.3, 0.2]]"
            )
        return self
