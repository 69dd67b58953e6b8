"""Pydantic models of a scene file: keys, types, and the rules of one table each."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    StrictInt,
    StringConstraints,
    model_validator,
)

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


SECTION = "width_m and height_m, or area_m2 and second_moment_m4"
Section = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST**2, le=LARGEST)]
"""Quantity that grows with squares of lengths, or their squares: a thin strip's is under 1e-15."""


class ElasticTable(Table):
    """Stiffness of a link in bending, in stretching, or both: by its modulus and section, or by EI
    and EA. A density with the section gives its mass, which otherwise is the mass of the link."""

    modulus_pa: Positive | None = None
    width_m: Positive | None = None
    height_m: Positive | None = None
    """Height of a rectangle, in the plane of the motion."""
    area_m2: Section | None = None
    second_moment_m4: Section | None = None
    flexural_n_m2: Section | None = None
    axial_n: Positive | None = None
    density_kg_m3: Positive | None = None
    damping_s: NonNegative = 0.0
    bends: bool = True
    stretches: bool = False

    @property
    def area(self) -> float | None:
        """Area of the section [m^2]."""
        if self.width_m is not None and self.height_m is not None:
            return self.width_m * self.height_m
        return self.area_m2

    @property
    def second_moment(self) -> float | None:
        """Second moment of area, about the axis across the plane [m^4]."""
        if self.width_m is not None and self.height_m is not None:
            return self.width_m * self.height_m**3 / 12.0
        return self.second_moment_m4

    @property
    def flexural(self) -> float | None:
        """EI [N m^2]."""
        if self.modulus_pa is not None and self.second_moment is not None:
            return self.modulus_pa * self.second_moment
        return self.flexural_n_m2

    @property
    def axial(self) -> float | None:
        """EA [N]."""
        if self.modulus_pa is not None and self.area is not None:
            return self.modulus_pa * self.area
        return self.axial_n

    @model_validator(mode="after")
    def _has_one_section(self) -> ElasticTable:
        rectangle, other = (self.width_m, self.height_m), (self.area_m2, self.second_moment_m4)
        if self.width_m is not None and self.height_m is None:
            raise ValueError("width_m goes with height_m, which is missing")
        if None not in rectangle and any(each is not None for each in other):
            raise ValueError(f"found two sections; give one: {SECTION}")
        if self.modulus_pa is not None and (self.flexural_n_m2 or self.axial_n):
            raise ValueError(
                "modulus_pa with a section says flexural_n_m2 and axial_n too; give one of them"
            )
        if self.density_kg_m3 is not None and self.area is None:
            raise ValueError(f"density_kg_m3 goes with a section: {SECTION}")
        return self

    @model_validator(mode="after")
    def _gives_way(self) -> ElasticTable:
        if not (self.bends or self.stretches):
            raise ValueError("it neither bends nor stretches; leave the table out")
        missing = [
            f"{key} (or modulus_pa with {SECTION})"
            for key, asked, value in (
                ("flexural_n_m2", self.bends, self.flexural),
                ("axial_n", self.stretches, self.axial),
            )
            if asked and value is None
        ]
        if missing:
            raise ValueError(f"its stiffness is missing: give {' and '.join(missing)}")
        return self


class GroundTable(Table):
    points: dict[Name, Coordinates] = Field(min_length=1, max_length=MOST_BODIES)


class LinkTable(Table):
    """A link; ``bar`` with ``length_m`` is short for two points on its x-axis."""

    bar: tuple[Name, Name] | None = None
    length_m: Positive | None = None
    points: dict[Name, Coordinates] = Field(default_factory=dict, max_length=MOST_POINTS)
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
    """Start of free motion beyond the driver, by link and by slider; and of elastic links."""

    angles_deg: dict[Name, Degrees] = Field(default_factory=dict, max_length=MOST_BODIES)
    rates_rad_s: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    displacements_m: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    speeds_m_s: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    shape: Literal["quasi-static", "straight", "periodic"] | None = None


class FrictionTable(Table):
    """Friction in the joint that the table is named after; `models.files.spring_table`, which knows
    the joints, checks that its keys fit a pin or a slider."""

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
    """A whole scene file; `models.files.driver_table.DRIVERS` checks its driver once the law is
    known, and `models.files.load_table.LOADS` its loads."""

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


def within_a_turn(degrees: float) -> float:
    """Convert an angle to radians without its whole turns, which would cost digits."""
    return math.radians(math.fmod(degrees, 360.0))
