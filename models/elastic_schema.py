"""The shape of a table `[elastic.LINK]` of a scene file."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from models.table_fields import LARGEST, NonNegative, Positive, Table

SECTION = "width_m and height_m, or area_m2 and second_moment_m4"
Section = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST**2, le=LARGEST)]
"""What goes with squares of lengths, and their squares: that of a thin strip is under 1e-15."""


class ElasticTable(Table):
    """How a link bends, stretches, or both: by its modulus and section, or by EI and EA. With a
    density its section says its mass, which otherwise is that of the link."""

    modulus_pa: Positive | None = None
    width_m: Positive | None = None
    height_m: Positive | None = None
    """Of a rectangle, in the plane of the motion."""
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
        """Of the section [m^2]."""
        if self.width_m is not None and self.height_m is not None:
            return self.width_m * self.height_m
        return self.area_m2

    @property
    def second_moment(self) -> float | None:
        """Of the area, about the axis across the plane [m^4]."""
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
