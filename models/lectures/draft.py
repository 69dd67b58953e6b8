"""A scene under design, as the text of its file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import cast

from models.files.assemble import Table, toml_text
from models.files.reading import parse_scene
from models.scene import Scene

SPEED_RAD_S = 10.0
"""Default speed of a driver in tasks of angles only."""


@dataclass(frozen=True)
class Draft:
    """The tables of a scene file: places in m, angles in degrees, as the file has them."""

    name: str
    source: str
    ground: Mapping[str, complex]
    links: Mapping[str, Table]
    driver: Table
    sliders: Mapping[str, Table] = field(default_factory=dict)
    branch: Mapping[str, int] = field(default_factory=dict)
    note: str = ""
    loads: Mapping[str, Table] = field(default_factory=dict)

    def driven(self, driver: Table) -> Draft:
        """Return the draft with another table of the driver."""
        return replace(self, driver=driver)

    def with_branch(self, branch: Mapping[str, int]) -> Draft:
        """Return the draft in another assembly."""
        return replace(self, branch=branch)

    @property
    def text(self) -> str:
        """Text of the file."""
        points = {name: (place.real, place.imag) for name, place in self.ground.items()}
        head = {"name": self.name, "source": self.source}
        if self.note:
            head["note"] = self.note
        tables: dict[str, Table] = {"ground": {"points": points}}
        for name in ("links", "sliders", "driver", "branch", "loads"):
            if table := getattr(self, name):
                tables[name] = table
        return toml_text(head, tables)

    @property
    def scene(self) -> Scene:
        """Scene read from the file. Raises SceneError for faults."""
        return parse_scene(self.text, self.name)


def bar(first: str, second: str, length_m: float) -> Table:
    """Table of a link of two points."""
    return {"bar": [first, second], "length_m": length_m}


def plate(points: Mapping[str, complex]) -> Table:
    """Table of a link of points in its own frame [m]."""
    return {"points": {name: (place.real, place.imag) for name, place in points.items()}}


def points_of(link: Table) -> dict[str, complex]:
    """Return the points of a link's table in its own frame [m]."""
    if "bar" in link:
        (one, other), length = cast(Sequence[str], link["bar"]), cast(float, link["length_m"])
        return {one: 0j, other: complex(length)}
    points = cast(Mapping[str, tuple[float, float]], link["points"])
    return {name: complex(*place) for name, place in points.items()}
