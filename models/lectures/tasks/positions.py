"""Tasks of positions: of a coupler, a rocker, a stroke, and of a quick return."""

from __future__ import annotations

import cmath
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.files.schema import Coordinates, Degrees, Name, NonNegative, Positive, Table
from models.lectures.shipped_tables import TaskTable

RIGID = 1e-3
"""Relative difference of the distance of two points between positions: exercises round."""

RESERVED = ("O2", "O4", "O6", "input", "coupler", "output", "crank", "rod", "rocker", "ground")
"""Names of fixed pivots and links in solutions."""


class PoseTable(Table):
    """A position of a body: of a point with an angle, or of two points by their names."""

    point_m: Coordinates | None = None
    angle_deg: Degrees | None = None
    points: dict[Name, Coordinates] = Field(default_factory=dict, max_length=2)

    @model_validator(mode="after")
    def _is_given_in_one_way(self) -> PoseTable:
        by_angle = self.point_m is not None and self.angle_deg is not None
        if by_angle == bool(self.points) or (self.point_m is None) != (self.angle_deg is None):
            raise ValueError(
                "a position is given by point_m and angle_deg, or by the places of two points: "
                "points = { C = [0.1, 0.2], D = [0.3, 0.2] }"
            )
        if self.points and len(self.points) != 2:
            raise ValueError(f"points: found {', '.join(self.points)} alone; name two points")
        return self


class PositionsTask(TaskTable):
    """A task of positions of a body."""

    positions: list[PoseTable] = Field(min_length=2, max_length=5)

    @model_validator(mode="after")
    def _is_of_one_rigid_body(self) -> PositionsTask:
        kinds = {tuple(sorted(one.points)) for one in self.positions}
        if len(kinds) > 1:
            told = " and ".join(", ".join(names) or "point_m and angle_deg" for names in kinds)
            raise ValueError(f"positions: found {told}; give all in the same form, of one body")
        taken = [name for name in self.names if name in RESERVED]
        if taken:
            raise ValueError(
                f"positions: {' and '.join(taken)}: solutions have pivots and links of that name "
                f"({', '.join(RESERVED)}); give the point another"
            )
        lengths = [abs(b - a) for a, b in (self._pair(one) for one in self.positions if one.points)]
        if lengths and lengths[0] == 0.0:
            raise ValueError("positions: the two points coincide; name two points apart")
        for number, length in enumerate(lengths, 1):
            if abs(length - lengths[0]) > RIGID * lengths[0]:
                one, other = self.names
                raise ValueError(
                    f"positions: {one} and {other} are {lengths[0]:g} m apart in position 1 and "
                    f"{length:g} m in position {number}; a body is rigid"
                )
        return self

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the two points of the positions, in the order of the first; empty for angles."""
        return tuple(self.positions[0].points)

    def _pair(self, position: PoseTable) -> tuple[complex, complex]:
        one, other = (complex(*position.points[name]) for name in self.names)
        return one, other

    @property
    def poses(self) -> list[tuple[complex, float]]:
        """Place of the reference point [m] and angle [rad] of the body in each position; with two
        points the place of the first, and the angle of the line to the second."""
        found = []
        for one in self.positions:
            if one.points:
                first, second = self._pair(one)
                found.append((first, cmath.phase(second - first)))
            else:
                assert one.point_m is not None
                assert one.angle_deg is not None
                found.append((complex(*one.point_m), cmath.pi * one.angle_deg / 180.0))
        return found

    @property
    def own_points(self) -> dict[str, complex]:
        """Named points in the body's own frame [m]; P for a body given by its angle."""
        if not self.names:
            return {"P": 0j}
        first, second = self._pair(self.positions[0])
        return {self.names[0]: 0j, self.names[1]: complex(abs(second - first))}


class CouplerTask(PositionsTask):
    """A body that is to be the coupler of a four-bar, in two to five positions.

    ``moving_m`` are the moving pivots in the first position (of two and three; by default the two
    named points); ``fixed_m`` the fixed pivots in their place (three positions). With two
    positions, ``distances_m`` are the distances of the fixed pivots from the middles, to the left
    of the way along the bisector. ``driver`` is the driven side. ``best`` is the number of listed
    solutions where there are infinitely many.
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


Swing = Annotated[float, Field(strict=True, gt=0.0, lt=180.0)]


class RockerTask(TaskTable):
    """A crank that is to swing a rocker, by its angle or between two positions of a body on it.

    ``rocker_m`` is the distance of its pin B from its pivot O4 (default with positions: the
    distance of the body's first point); ``distance_m`` the distance of the crank's pivot O2 from
    the middle of the chord B1 B2, on whose extension it lies: by default several are tried.
    """

    swing_deg: Swing | None = None
    positions: list[PoseTable] = Field(default_factory=list, max_length=2)
    rocker_m: Positive | None = None
    distance_m: Positive | None = None

    @model_validator(mode="after")
    def _is_by_angle_or_by_positions(self) -> RockerTask:
        if (self.swing_deg is None) == (not self.positions):
            raise ValueError("give swing_deg, or two positions, one of the two")
        if self.positions and len(self.positions) != 2:
            raise ValueError("positions: found 1; a rocker swings between two")
        if self.swing_deg is not None and self.rocker_m is None:
            raise ValueError("rocker_m: missing; a rocker by its angle needs its length")
        if self.positions:
            _ = self.body
        return self

    @property
    def body(self) -> PositionsTask:
        """Body in its two positions. Raises ValidationError for positions of no rigid body."""
        return PositionsTask(name=self.name, source=self.source, positions=self.positions)


TimeRatio = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=1.0, lt=1000.0)]
"""Time of the slow stroke over the time of the quick stroke."""


class StrokeTask(TaskTable):
    """A slider-crank of a stroke: ``central`` (of 2 cranks), ``isosceles`` (rod as long as the
    crank, 4 cranks), or ``offset`` by a length, or by its time ratio.

    ``rod_m`` is the rod; by default several are tried.
    """

    stroke_m: Positive
    form: Literal["central", "isosceles", "offset"] = "central"
    rod_m: Positive | None = None
    offset_m: NonNegative | None = None
    time_ratio: TimeRatio | None = None

    @model_validator(mode="after")
    def _goes_together(self) -> StrokeTask:
        offset = self.offset_m is not None or self.time_ratio is not None
        if self.form != "offset" and offset:
            raise ValueError(f'offset_m and time_ratio belong to form = "offset", not {self.form}')
        if self.form == "offset" and not offset:
            raise ValueError("give offset_m, or time_ratio, or both: an offset slider-crank")
        if self.form == "isosceles" and self.rod_m is not None:
            raise ValueError("rod_m: of an isosceles slider-crank it is a quarter of the stroke")
        if self.rod_m is not None and self.offset_m is not None and self.time_ratio is not None:
            raise ValueError("rod_m, offset_m, time_ratio: the third follows from two; leave one")
        return self


NEEDS = {
    "slotted-lever": ("crank_m", "pivots_m", "stroke_m"),
    "whitworth": ("crank_m", "pivots_m", "stroke_m"),
    "crank-rocker": ("rocker_m",),
}
"""Keys that give a mechanism its size, one of them."""


class QuickReturnTask(TaskTable):
    """A mechanism whose slow stroke takes ``time_ratio`` times the quick one, at constant speed.

    Its size is given by ``crank_m``, by the distance of the pivots (``pivots_m``) or by the ram's
    ``stroke_m``; for a crank-rocker by ``rocker_m``, which needs ``swing_deg`` as well. A ram has a
    rod of ``rod_m``, by default twice its stroke.
    """

    mechanism: Literal["slotted-lever", "whitworth", "crank-rocker"]
    time_ratio: TimeRatio
    crank_m: Positive | None = None
    pivots_m: Positive | None = None
    stroke_m: Positive | None = None
    rocker_m: Positive | None = None
    swing_deg: Swing | None = None
    rod_m: Positive | None = None

    @model_validator(mode="after")
    def _has_one_size(self) -> QuickReturnTask:
        sizes = ("crank_m", "pivots_m", "stroke_m", "rocker_m")
        given = [key for key in sizes if getattr(self, key) is not None]
        own = NEEDS[self.mechanism]
        if len(given) != 1 or given[0] not in own:
            raise ValueError(
                f"found {' and '.join(given) or 'no size'}; a {self.mechanism} is given one of "
                f"{', '.join(own)}"
            )
        if (self.swing_deg is not None) != (self.mechanism == "crank-rocker"):
            raise ValueError(
                "swing_deg: a crank-rocker needs it, and the swing of other mechanisms follows "
                "from the time ratio"
            )
        if self.rod_m is not None and self.stroke_m is None:
            raise ValueError("rod_m: a ram with a rod needs its stroke_m")
        return self
