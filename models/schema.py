"""The shape of a scene file in pydantic models: keys, types, and the rules of one table each."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictInt, StringConstraints, model_validator

from models.elastic_schema import ElasticTable
from models.table_fields import (
    MOST_BODIES,
    MOST_POINTS,
    Coordinates,
    Degrees,
    Name,
    NonNegative,
    Number,
    Positive,
    Table,
    Text,
)


class GroundTable(Table):
    points: dict[Name, Coordinates] = Field(min_length=1, max_length=MOST_BODIES)


class LinkTable(Table):
    """``bar`` with ``length_m`` is short for two points on the link's x-axis."""

    bar: tuple[Name, Name] | None = None
    length_m: Positive | None = None
    points: dict[Name, Coordinates] = Field(default_factory=dict, max_length=MOST_POINTS)
    mass_kg: NonNegative | None = None
    centre_m: Coordinates | None = None
    inertia_kg_m2: NonNegative | None = None
    flywheel_kg_m2: NonNegative = 0.0
    """The moment of inertia of a flywheel on the link, which is added to the link's own."""

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


class SliderTable(Table):
    on: Name
    point: Name | None = None
    link: Name | None = None
    through_m: Coordinates = (0.0, 0.0)
    direction_deg: Degrees = 0.0
    angle_deg: Degrees = 0.0
    mass_kg: NonNegative | None = None
    inertia_kg_m2: NonNegative | None = None

    @model_validator(mode="after")
    def _a_sliding_link_has_its_own_mass(self) -> SliderTable:
        if self.link is not None and (self.mass_kg is not None or self.inertia_kg_m2 is not None):
            raise ValueError(f"the slider is link {self.link}: give mass and inertia there")
        if self.link is None and self.angle_deg != 0.0:
            raise ValueError("angle_deg needs link = ...: a block has the direction of its line")
        return self


class SpringTable(Table):
    """A spring with a damper: between two ``points``, in a ``pin`` (between two ``bodies``), or
    along a ``slider``."""

    points: tuple[Name, Name] | None = None
    pin: Name | None = None
    bodies: tuple[Name, Name] | None = None
    slider: Name | None = None
    rate_n_m: NonNegative | None = None
    damping_n_s_m: NonNegative | None = None
    free_m: Number | None = None
    rate_n_m_rad: NonNegative | None = None
    damping_n_m_s: NonNegative | None = None
    free_deg: Degrees | None = None

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> SpringTable:
        if sum(each is not None for each in (self.points, self.pin, self.slider)) != 1:
            raise ValueError("name where it is: points = [...], pin = ..., or slider = ..., one")
        along = {"rate_n_m": self.rate_n_m, "damping_n_s_m": self.damping_n_s_m}
        turning = {"rate_n_m_rad": self.rate_n_m_rad, "damping_n_m_s": self.damping_n_m_s}
        own, others = (turning, along) if self.pin is not None else (along, turning)
        lengths = {"free_m": self.free_m, "free_deg": self.free_deg}
        other_free = "free_m" if self.pin is not None else "free_deg"
        wrong = [key for key, value in others.items() if value is not None]
        wrong += [other_free] * (lengths[other_free] is not None)
        if wrong:
            where = "a pin" if self.pin is not None else "points, or a slider"
            raise ValueError(f"{wrong[0]} does not go with {where}; give {' and '.join(own)}")
        if not any(own.values()):
            raise ValueError(f"a spring needs a rate or a damping above 0: {' or '.join(own)}")
        if self.bodies is not None and self.pin is None:
            raise ValueError("bodies belong to a spring in a pin; leave them out")
        if self.points is not None and self.points[0] == self.points[1]:
            raise ValueError(f"found {self.points[0]} twice; name two points")
        if self.points is not None and self.free_m is not None and self.free_m < 0.0:
            raise ValueError(f"free_m is {self.free_m:g}; a distance is 0 or more")
        return self


class StartTable(Table):
    """More of the start of free motion, by link and by slider; and how elastic links start."""

    angles_deg: dict[Name, Degrees] = Field(default_factory=dict, max_length=MOST_BODIES)
    rates_rad_s: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    displacements_m: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    speeds_m_s: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    shape: Literal["quasi-static", "straight", "periodic"] | None = None


class FrictionTable(Table):
    """What rubs in the joint that the table is named after; whether its keys fit a pin or a slider
    is for `models.friction_names` to say, which knows the joints."""

    mu: NonNegative | None = None
    radius_m: Positive | None = None
    torque_n_m: NonNegative | None = None
    force_n: NonNegative | None = None

    @model_validator(mode="after")
    def _rubs_in_one_way(self) -> FrictionTable:
        kinds = [key for key in ("mu", "torque_n_m", "force_n") if getattr(self, key) is not None]
        if self.radius_m is not None and self.mu is None:
            raise ValueError("radius_m is that of a pin with mu, which is missing; add mu")
        if len(kinds) != 1:
            raise ValueError(
                f"found {' and '.join(kinds) or 'none of them'}; give one of mu (with radius_m in "
                "a pin), torque_n_m (a pin) and force_n (a slider)"
            )
        return self


class SceneTable(Table):
    """A whole scene file; its driver is checked by `models.driver_tables.DRIVERS` after its law is
    known, its loads by `models.load_tables.LOADS`."""

    name: Name
    source: Annotated[Text, StringConstraints(min_length=1)]
    note: Text = ""
    ground: GroundTable
    links: dict[Name, LinkTable] = Field(min_length=1, max_length=MOST_BODIES)
    sliders: dict[Name, SliderTable] = Field(default_factory=dict, max_length=MOST_BODIES)
    driver: dict[str, object]
    branch: dict[Name, StrictInt] = Field(default_factory=dict)
    gravity_m_s2: Coordinates = (0.0, 0.0)
    tolerance: dict[Name, Positive] = Field(default_factory=dict)
    loads: dict[Name, dict[str, object]] = Field(default_factory=dict, max_length=MOST_BODIES)
    friction: dict[Name, FrictionTable] = Field(default_factory=dict, max_length=MOST_BODIES)
    springs: dict[Name, SpringTable] = Field(default_factory=dict, max_length=MOST_BODIES)
    start: StartTable = Field(default_factory=StartTable)
    elastic: dict[Name, ElasticTable] = Field(default_factory=dict, max_length=MOST_BODIES)
