"""A scene that is being designed, as the text of its file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from models.files.assemble import Table, toml_value
from models.files.reading import parse_scene
from models.scene import Scene

SPEED_RAD_S = 10.0
"""Of a driver of which nothing is asked but angles."""


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
        """The same with another table of the driver."""
        return replace(self, driver=driver)

    def with_branch(self, branch: Mapping[str, int]) -> Draft:
        """The same in another assembly."""
        return replace(self, branch=branch)

    @property
    def text(self) -> str:
        """The file."""
        points = {name: (place.real, place.imag) for name, place in self.ground.items()}
        heads: dict[str, Table] = {"ground": {"points": points}, "links": self.links}
        if self.sliders:
            heads["sliders"] = self.sliders
        heads["driver"] = self.driver
        if self.branch:
            heads["branch"] = self.branch
        if self.loads:
            heads["loads"] = self.loads
        lines = [f"name = {toml_value(self.name)}", f"source = {toml_value(self.source)}"]
        lines += [f"note = {toml_value(self.note)}"] * bool(self.note)
        for head, table in heads.items():
            lines += ["", f"[{head}]", *(f"{key} = {toml_value(v)}" for key, v in table.items())]
        return "\n".join(lines) + "\n"

    @property
    def scene(self) -> Scene:
        """The scene that the file reads as. Raises SceneError for what is none."""
        return parse_scene(self.text, self.name)


def bar(first: str, second: str, length_m: float) -> Table:
    """A link of two points."""
    return {"bar": [first, second], "length_m": length_m}


def plate(points: Mapping[str, complex]) -> Table:
    """A link of points in its own frame [m]."""
    return {"points": {name: (place.real, place.imag) for name, place in points.items()}}
