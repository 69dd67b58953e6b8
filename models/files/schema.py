"""Types of values in a scene file, the base of its tables, and the names in them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints

from models.errors import cut, few
from models.scene import GROUND
from models.scene.driver import LONGEST_S

NAME = r"[A-Za-z][A-Za-z0-9_-]{0,39}"
"""Pattern of a name: no character in it leaves a path, a tag or a cell."""
Name = Annotated[str, StringConstraints(pattern=rf"^{NAME}$")]
ACTING = r"\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u206f\ufffe\uffff"
"""Invisible characters with an effect: a terminal obeys them, or they break lines or reverse the
order of letters; XML cannot hold the last two."""
Text = Annotated[str, StringConstraints(max_length=2000, pattern=rf"^[^{ACTING}]*$")]
"""Text that is shown and written into other files."""
LARGEST = 1e15
"""Largest number of a scene, and inverse of the smallest length or mass: their squares, and
products with rates, stay finite."""
Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-LARGEST, le=LARGEST)]
Duration = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST, le=LONGEST_S)]
"""Duration of free motion [s]."""
Degrees = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e6, le=1e6)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST, le=LARGEST)]
NonNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=LARGEST)]
Coordinates = tuple[Number, Number]
MOST_BODIES, MOST_POINTS = 1000, 100
"""Largest numbers of links of a scene (also of sliders and ground points), and of points of a link:
all distances between its points are computed many times."""


def not_tiny(value: float) -> float:
    """Refuse a number so near to 0 that its inverse, a period, is useless."""
    if 0.0 < abs(value) < 1 / LARGEST:
        raise ValueError(
            f"found {value:g}; use {1 / LARGEST:g} or more, or {-1 / LARGEST:g} or less"
        )
    return value


RateNumber = Annotated[Number, AfterValidator(not_tiny)]


class Table(BaseModel):
    """A table of the file: unknown keys are faults, and it stays as read."""

    # Built where a scene has such a table: most have few of them, and each takes a millisecond.
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def within_a_turn(degrees: float) -> float:
    """Convert an angle to radians without its whole turns, which would cost digits."""
    return math.radians(math.fmod(degrees, 360.0))


def in_degrees(angle_rad: float) -> float:
    """Convert an angle to degrees, rounded to twelve decimals where these read as the same angle:
    10, and not 10.000000000000002."""
    plain = round(math.degrees(angle_rad), 12)
    return plain if math.radians(plain) == angle_rad else math.degrees(angle_rad)


LISTED = 12
"""Names that a message lists."""
RawTables = Mapping[str, Any]
"""Tables as the file has them, of any shape."""


def raw_tables(raw: object, key: str) -> RawTables:
    """Return the table under a key, empty if missing or no table."""
    found = raw.get(key) if isinstance(raw, Mapping) else None
    return found if isinstance(found, Mapping) else {}


def each_of(tables: RawTables, head: str) -> Iterator[tuple[str, str, RawTables]]:
    """Yield each table under a head with its place in a message, and its name; values that are no
    tables are faults of their types."""
    for name, table in tables.items():
        if isinstance(table, Mapping):
            yield f"{head}.{cut(name)}", name, table


def first_of(names: Collection[str]) -> str:
    """List the first names."""
    return ", ".join(map(cut, islice(names, LISTED))) + (", ..." if len(names) > LISTED else "")


def use_one_of(names: Collection[str], otherwise: str = "the scene has none") -> str:
    """Return the remedy for an unknown name."""
    return f"use one of {few(map(cut, names), LISTED)}" if names else otherwise


def bodies_at(
    point: str, ground: Collection[str], points: Mapping[str, Collection[str]]
) -> list[str]:
    """List the bodies of a point, the ground first, then links in the order of the file."""
    return [GROUND] * (point in ground) + [link for link, own in points.items() if point in own]


@dataclass(frozen=True)
class NamesInTables:
    """Names in the raw tables of a scene: the points of the ground and of each link, the tables of
    the sliders, and the driver's link.

    Read from the raw tables, so that faults of names are reported beside faults of number or type:
    values of the wrong shape are left out here, and are faults of their types.
    """

    ground: set[str]
    points: Mapping[str, set[str]]
    sliders: RawTables
    driver: object

    @staticmethod
    def of(raw: RawTables) -> NamesInTables:
        """Return the names of a whole file."""
        return NamesInTables(
            set(raw_tables(raw_tables(raw, "ground"), "points")),
            {name: set(_points(link)) for name, link in raw_tables(raw, "links").items()},
            raw_tables(raw, "sliders"),
            raw_tables(raw, "driver").get("link"),
        )

    @cached_property
    def of_bodies(self) -> set[str]:
        """All points of the ground and of links."""
        return self.ground.union(*self.points.values())

    @cached_property
    def blocks(self) -> Mapping[str, str]:
        """Sliders without a link, and the points that their blocks are pinned at."""
        return {
            name: str(slider.get("point", name))
            for _, name, slider in each_of(self.sliders, "")
            if "link" not in slider
        }

    def at(self, point: str) -> list[str]:
        """List the bodies of a point."""
        return bodies_at(point, self.ground, self.points)


def _points(link: object) -> Iterable[str]:
    bar = link.get("bar") if isinstance(link, Mapping) else None
    yield from (end for end in (bar if isinstance(bar, list) else []) if isinstance(end, str))
    yield from raw_tables(link, "points")
