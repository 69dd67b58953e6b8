"""Tables of the ground, links and sliders of a scene file, and of the branch of their assembly."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping

from pydantic import Field, model_validator

from models.errors import cut
from models.files import schema
from models.files.elastic_table import ElasticTable
from models.files.schema import Coordinates, Name, NonNegative, RawTables
from models.scene import GROUND, Link, Point, Slider

MOST_ASSEMBLIES = 6
"""Largest number of real assemblies of a group of four links."""
ROD_KG_PER_M = 1.0
FARTHEST = 1e12
"""Largest distance of a ground point, over the longest link: positions keep four digits there."""
BLOCK_OF_LONGEST = 0.1
"""Side of a square slider block with mass, over the longest link, for the default inertia."""


class GroundTable(schema.Table):
    points: dict[Name, Coordinates] = Field(min_length=1, max_length=schema.MOST_BODIES)

    def faults_of_place(self, longest: float) -> list[str]:
        """List points so far away that a float cannot distinguish the places of the links."""
        return [
            f"ground.points.{name}: {math.hypot(*place):.3g} m from the origin, {far:.3g} times "
            f"the longest link ({longest:.3g} m); at most {FARTHEST:g}: move the scene towards the "
            "origin"
            for name, place in self.points.items()
            if (far := math.hypot(*place) / longest) > FARTHEST
        ]


class LinkTable(schema.Table):
    """A link; ``bar`` with ``length_m`` is short for two points on its x-axis."""

    bar: tuple[Name, Name] | None = None
    length_m: schema.Positive | None = None
    points: dict[Name, Coordinates] = Field(default_factory=dict, max_length=schema.MOST_POINTS)
    mass_kg: NonNegative | None = None
    centre_m: Coordinates | None = None
    inertia_kg_m2: NonNegative | None = None
    flywheel_kg_m2: NonNegative = 0.0
    """Moment of inertia of a flywheel on the link, added to the link's own."""

    @model_validator(mode="after")
    def _bar_goes_with_length(self) -> LinkTable:
        if (self.bar is None) != (self.length_m is None):
            raise ValueError('bar and length_m go together: bar = ["A", "B"], length_m = 0.1')
        if self.bar is None and not self.points:
            raise ValueError(
                'a link needs points: bar = ["A", "B"] with length_m, or points = {...}'
            )
        if self.bar is not None and self.bar[0] == self.bar[1]:
            raise ValueError(f"the bar joins point {self.bar[0]} to itself; name two points")
        return self

    @property
    def every_point(self) -> dict[str, Point]:
        """All points in the frame of the link, including the ends of its bar."""
        bar: dict[str, Point] = {}
        if self.bar is not None and self.length_m is not None:
            bar = {self.bar[0]: (0.0, 0.0), self.bar[1]: (self.length_m, 0.0)}
        return bar | dict(self.points)

    def faults_of_points(self, name: str) -> Iterator[str]:
        """Yield faults of points that are given twice, or are too few to spread a mass over."""
        if self.bar is not None and set(self.bar) & set(self.points):
            yield f"links.{name}.points: the bar already gives its ends"
        given = (self.mass_kg, self.centre_m, self.inertia_kg_m2)
        if len(self.every_point) < 2 and None in given:
            yield (
                f"links.{name}: one point has no length to derive a mass from; give "
                "mass_kg, centre_m and inertia_kg_m2, or a second point"
            )

    def link(self, name: str, section: ElasticTable | None, faults: list[str]) -> Link:
        """Make the link; missing mass data default to those of its elastic section, or to a uniform
        slender rod on its longest span."""
        length, a, b = longest_of(self.every_point)
        own = self.mass_kg
        of_section = None if section is None else section.mass_kg(length)
        if of_section is not None and own is not None:
            faults.append(
                f"links.{name}: mass_kg is {own:g}, and its section and density_kg_m3 give "
                f"{of_section:g}; give one of them"
            )
        mass = next((one for one in (own, of_section) if one is not None), ROD_KG_PER_M * length)
        centre = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) if self.centre_m is None else self.centre_m
        inertia = mass * length**2 / 12 if self.inertia_kg_m2 is None else self.inertia_kg_m2
        if mass == 0.0 and inertia > 0.0:
            faults.append(
                f"links.{name}: inertia_kg_m2 is {inertia} with mass_kg 0; give both or none"
            )
        if mass == 0.0 and self.flywheel_kg_m2 > 0.0:
            faults.append(
                f"links.{name}: flywheel_kg_m2 is {self.flywheel_kg_m2:g} with mass_kg 0; give the "
                "link the mass of its flywheel too"
            )
        return Link(name, self.every_point, mass, centre, inertia + self.flywheel_kg_m2)


def longest_of(points: Mapping[str, Point]) -> tuple[float, Point, Point]:
    """Return the largest distance between two points, and the two."""
    places = list(points.values())
    pairs = [(math.dist(a, b), a, b) for i, a in enumerate(places) for b in places[i:]]
    return max(pairs, key=lambda pair: pair[0])


def coincident_points(body: str, points: Mapping[str, Point]) -> list[str]:
    """List the pairs of points of a link or the ground that are one."""
    names = list(points)
    return [
        f"{'' if body == GROUND else 'links.'}{body}: length {a}{b} is "
        f"{math.dist(points[a], points[b]):g}; set the points apart"
        for i, a in enumerate(names)
        for b in names[i + 1 :]
        if math.dist(points[a], points[b]) < 1 / schema.LARGEST
    ]


def link_table(link: Link, flywheel_kg_m2: float | None) -> Mapping[str, object]:
    """Write the table of a link, its flywheel beside its own inertia."""
    return {
        "points": link.points,
        "mass_kg": link.mass_kg,
        "centre_m": link.centre_m,
        "inertia_kg_m2": link.inertia_kg_m2,
        **({} if flywheel_kg_m2 is None else {"flywheel_kg_m2": flywheel_kg_m2}),
    }


class SliderTable(schema.Table):
    on: Name
    point: Name | None = None
    link: Name | None = None
    through_m: Coordinates = (0.0, 0.0)
    direction_deg: schema.Degrees = 0.0
    angle_deg: schema.Degrees = 0.0
    mass_kg: NonNegative | None = None
    inertia_kg_m2: NonNegative | None = None

    @model_validator(mode="after")
    def _a_sliding_link_has_its_own_mass(self) -> SliderTable:
        if self.link is not None and (self.mass_kg is not None or self.inertia_kg_m2 is not None):
            raise ValueError(f"the slider is link {self.link}: give mass and inertia there")
        if self.link is None and self.angle_deg != 0.0:
            raise ValueError("angle_deg needs link = ...: a block has the direction of its line")
        return self

    def slider(self, name: str, longest: float) -> Slider:
        """Make the slider; a mass has by default the inertia of a square block."""
        mass = self.mass_kg or 0.0
        side = BLOCK_OF_LONGEST * longest
        inertia = mass * side**2 / 6 if self.inertia_kg_m2 is None else self.inertia_kg_m2
        return Slider(
            name=name,
            point=self.point or name,
            on=self.on,
            through_m=self.through_m,
            direction_rad=schema.within_a_turn(self.direction_deg),
            link=self.link,
            angle_rad=schema.within_a_turn(self.angle_deg),
            mass_kg=mass,
            inertia_kg_m2=inertia,
        )


def slider_table(slider: Slider) -> Mapping[str, object]:
    """Write the table of a slider."""
    table: dict[str, object] = {
        "point": slider.point,
        "on": slider.on,
        "through_m": slider.through_m,
        "direction_deg": schema.in_degrees(slider.direction_rad),
    }
    if slider.link is not None:
        return {**table, "link": slider.link, "angle_deg": schema.in_degrees(slider.angle_rad)}
    return {**table, "mass_kg": slider.mass_kg, "inertia_kg_m2": slider.inertia_kg_m2}


def faults_of_links(links: RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield faults of names that a link cannot have."""
    for name in (GROUND, "world"):
        if name in links:
            yield f"links.{name}: that name means the ground; rename the link"
    for name in names.sliders:
        if name in links:
            yield f"sliders.{cut(name)}: a link has that name too; name the slider after its point"


def faults_of_sliders(sliders: RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield faults of sliders on, of, or at missing things."""
    points = names.points
    all_points = schema.first_of(sorted(names.of_bodies))
    points_of = {name: schema.first_of(sorted(each)) for name, each in points.items()}
    blocks = Counter(names.blocks.values())
    for key, name, slider in schema.each_of(sliders, "sliders"):
        point = slider.get("point", name)
        if not isinstance(point, str):
            continue
        on, link = slider.get("on"), slider.get("link")
        if isinstance(on, str) and on != GROUND and on not in points:
            yield f"{key}.on: found {cut(on)}; use one of {schema.first_of([GROUND, *points])}"
        if isinstance(link, str) and link not in points:
            yield f"{key}.link: found {cut(link)}; use one of {schema.first_of(points)}"
        elif isinstance(link, str) and link == on:
            yield f"{key}.on: link {cut(link)} slides on itself; name another body"
        elif isinstance(link, str) and point not in points[link]:
            yield f"{key}.point: {cut(link)} has no point {cut(point)}; it has {points_of[link]}"
        elif link is None and point not in names.of_bodies and blocks[point] < 2:
            yield f"{key}.point: no body has a point {cut(point)}; set point to one of {all_points}"


def faults_of_branch(branch: RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield faults of branches: unknown names, sides and numbers."""
    for name, chosen in branch.items():
        if name not in names.of_bodies.union(names.sliders, names.points):
            yield f"branch.{cut(name)}: no pin, slider or link of that name"
        elif not isinstance(chosen, int):
            continue  # already a fault of the schema
        elif name in names.points and not 1 <= chosen <= MOST_ASSEMBLIES:
            yield (
                f"branch.{cut(name)}: found {cut(str(chosen))}; the assemblies of a group about a "
                f"link are numbered from 1 to at most {MOST_ASSEMBLIES}"
            )
        elif name not in names.points and chosen not in (-1, 1):
            yield f"branch.{cut(name)}: found {cut(str(chosen))}; use 1 or -1"
