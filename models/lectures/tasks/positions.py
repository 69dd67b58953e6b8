"""Tasks of positions of a body."""

from __future__ import annotations

import cmath

from pydantic import Field, model_validator

from models.files.schema import Coordinates, Degrees, Name, Table
from models.lectures.tasks.task import TaskTable

RIGID = 1e-3
"""By what share of it the distance of two points may differ between positions: exercises round."""

RESERVED = ("O2", "O4", "O6", "input", "coupler", "output", "crank", "rod", "rocker", "ground")
"""What solutions call their fixed pivots and their links."""


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
            raise ValueError(f"positions: found {told}; give all in the same way, of one body")
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
        """The two points that positions are given by, in the order of the first; none of them."""
        return tuple(self.positions[0].points)

    def _pair(self, position: PoseTable) -> tuple[complex, complex]:
        one, other = (complex(*position.points[name]) for name in self.names)
        return one, other

    @property
    def poses(self) -> list[tuple[complex, float]]:
        """Place of the reference point [m] and angle [rad] of the body in each position: of two
        points those of the first, and of the line to the second."""
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
        """The named points in the body's own frame [m]; P of a body that is given by its angle."""
        if not self.names:
            return {"P": 0j}
        first, second = self._pair(self.positions[0])
        return {self.names[0]: 0j, self.names[1]: complex(abs(second - first))}
