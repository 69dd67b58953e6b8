"""The shape of a scheme's file in pydantic models: which joint is given by what."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.errors import suggestion
from models.files.schema import LARGEST, MOST_BODIES, Degrees, Name, Number, Table, Text
from models.lectures.scheme import FREEDOMS, PLANAR

Vector = Annotated[list[Number], Field(min_length=2, max_length=3)]
Radius = Annotated[float, Field(strict=True, allow_inf_nan=True, ge=-LARGEST)]
NEEDS = {
    "pin": ("at_m",),
    "slider": ("axis",),
    "contact": ("at_m", "normal", "radii_m"),
    "gear": ("centres_m", "radii_m"),
    "revolute": ("at_m", "axis"),
    "prismatic": ("axis",),
    "screw": ("at_m", "axis", "lead_m"),
    "cylindrical": ("at_m", "axis"),
    "universal": ("at_m", "axes"),
    "spherical": ("at_m",),
    "planar": ("axis",),
    "ball-in-tube": ("at_m", "axis"),
    "cylinder-on-plane": ("at_m", "axis", "normal"),
    "ball-on-plane": ("at_m", "normal"),
}
"""The keys that each kind of joint needs, besides ``between`` and ``kind``."""
MAY_HAVE = {"slider": ("at_m",), "prismatic": ("at_m",), "planar": ("at_m",)}
MAY_HAVE["gear"] = ("pressure_deg",)


class JointTable(Table):
    between: tuple[Name, Name]
    kind: str
    at_m: Vector | None = None
    axis: Vector | None = None
    axes: tuple[Vector, Vector] | None = None
    normal: Vector | None = None
    centres_m: tuple[Vector, Vector] | None = None
    radii_m: tuple[Radius, Radius] | None = None
    lead_m: Number | None = None
    pressure_deg: Degrees | None = None

    @model_validator(mode="after")
    def _is_of_its_kind(self) -> JointTable:
        if self.kind not in NEEDS:
            raise ValueError(
                f"kind: found {self.kind!r}; {suggestion(self.kind, NEEDS, 'use one of', 1)}"
            )
        if self.between[0] == self.between[1]:
            raise ValueError(f"between: found {self.between[0]} twice; name two links")
        needs = NEEDS[self.kind]
        given = set(self.model_fields_set) - {"between", "kind"}
        if missing := [key for key in needs if key not in given]:
            raise ValueError(f"{', '.join(missing)}: missing; a {self.kind} joint is given by it")
        if strange := sorted(given - {*needs, *MAY_HAVE.get(self.kind, ())}):
            raise ValueError(
                f"{strange[0]}: not of a {self.kind} joint, which is given by {', '.join(needs)}"
            )
        if self.pressure_deg is not None and not 5.0 <= self.pressure_deg <= 45.0:
            raise ValueError(f"pressure_deg: found {self.pressure_deg:g}; use 5 to 45 (mostly 20)")
        self._directions_have_lengths()
        self._is_a_higher_pair()
        return self

    def _directions_have_lengths(self) -> None:
        for key in ("axis", "normal"):
            if (vector := getattr(self, key)) is not None and not any(vector):
                raise ValueError(f"{key}: found {vector}, of length 0; give a direction")
        for vector in self.axes or ():
            if not any(vector):
                raise ValueError(f"axes: found {vector}, of length 0; give two directions")

    def _is_a_higher_pair(self) -> None:
        if self.radii_m is None:
            return
        first, second = self.radii_m
        if any(map(math.isnan, self.radii_m)):
            raise ValueError("radii_m: found nan; give numbers, or inf for a straight profile")
        if self.kind == "gear" and (0.0 in self.radii_m or any(map(math.isinf, self.radii_m))):
            raise ValueError(
                f"radii_m: found {list(self.radii_m)}; give the radii of two pitch circles, below "
                "0 where the teeth are inside"
            )
        if self.kind == "contact" and first + second == 0.0:
            raise ValueError(
                "radii_m: the centres of curvature coincide, so the two turn about one point; "
                "that is a pin"
            )
        if min(self.radii_m) < 0.0 and not (max(self.radii_m) >= 0.0 and first + second < 0.0):
            raise ValueError(
                f"radii_m: found {list(self.radii_m)}; below 0 is hollow, and in a hollow there "
                "lies what is round, with a smaller radius"
            )
        if self.kind == "contact" and math.isinf(first) and math.isinf(second):
            raise ValueError(
                "radii_m: both profiles are straight and touch along a line; that is a slider"
            )


class SchemeTable(Table):
    name: Name
    space: Literal["planar", "spatial"]
    source: Text
    note: Text = ""
    mobility: Annotated[int, Field(strict=True, ge=0, le=MOST_BODIES)] | None = None
    links: list[Name] = Field(min_length=1, max_length=60)
    joints: dict[Name, JointTable] = Field(min_length=1, max_length=100)

    @model_validator(mode="after")
    def _joints_are_of_its_space(self) -> SchemeTable:
        if len(set(self.links)) < len(self.links):
            raise ValueError("links: a name stands there twice; each link has its own")
        if "ground" in self.links:
            raise ValueError("links: ground is always there; list the moving links")
        kinds = FREEDOMS[self.space]
        length = 2 if self.space == PLANAR else 3
        for name, joint in self.joints.items():
            if joint.kind not in kinds:
                raise ValueError(
                    f"joints.{name}.kind: found {joint.kind}; {self.space} schemes have "
                    f"{', '.join(kinds)}"
                )
            for key, vector in _vectors(joint):
                if len(vector) != length:
                    raise ValueError(
                        f"joints.{name}.{key}: found {len(vector)} numbers; {self.space} schemes "
                        f"have {length}"
                    )
        return self


def _vectors(joint: JointTable) -> list[tuple[str, list[float]]]:
    """The points and directions of a joint with their keys."""
    one = ((key, getattr(joint, key)) for key in ("at_m", "axis", "normal"))
    pairs = ((key, each) for key in ("axes", "centres_m") for each in getattr(joint, key) or ())
    return [(key, vector) for key, vector in (*one, *pairs) if vector is not None]
