"""Scheme files, shipped or a user's own, read into a `Scheme`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.errors import SceneError, suggestion
from models.files.assemble import toml_text
from models.files.faults import read_table
from models.files.schema import LARGEST, MOST_BODIES, Degrees, Name, Number, Table, Text
from models.lectures.scheme import FREEDOMS, PLANAR, Place, Scheme, SchemeJoint
from models.lectures.shipped_tables import find_table, shipped_in
from models.scene import GROUND

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
"""Keys that each kind of joint needs, besides ``between`` and ``kind``."""
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
            raise ValueError(f"{', '.join(missing)}: missing; a {self.kind} joint needs it")
        if strange := sorted(given - {*needs, *MAY_HAVE.get(self.kind, ())}):
            raise ValueError(
                f"{strange[0]}: not for a {self.kind} joint, which needs {', '.join(needs)}"
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
                f"radii_m: found {list(self.radii_m)}; below 0 is hollow, and the profile in a "
                "hollow is round, with a smaller radius"
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
            raise ValueError("links: a name is given twice; each link has its own")
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
    one = ((key, getattr(joint, key)) for key in ("at_m", "axis", "normal"))
    pairs = ((key, each) for key in ("axes", "centres_m") for each in getattr(joint, key) or ())
    return [(key, vector) for key, vector in (*one, *pairs) if vector is not None]


def scheme_text(scheme: Scheme) -> str:
    """Write the TOML of a scheme, a joint a line."""
    head: dict[str, object] = {"name": scheme.name, "space": scheme.space, "source": scheme.source}
    if scheme.note:
        head["note"] = scheme.note
    if scheme.mobility is not None:
        head["mobility"] = scheme.mobility
    size = 2 if scheme.space == PLANAR else 3
    joints = {
        joint.name: {"between": joint.between, "kind": joint.kind, **_given(joint, size)}
        for joint in scheme.joints
    }
    return toml_text(head | {"links": scheme.links}, {"joints": joints})


def _given(joint: SchemeJoint, size: int) -> dict[str, object]:
    """Return the keys of a joint's kind with their values, vectors of a size."""
    axes = [axis[:size] for axis in joint.axes]
    at = joint.at[:size]
    values: dict[str, object] = {
        "at_m": at,
        "axis": axes[0] if axes else (),
        "normal": axes[-1] if axes else (),
        "axes": axes,
        "radii_m": joint.radii,
        "lead_m": joint.lead,
    }
    if joint.kind == "gear":
        values["centres_m"] = (at, _second_centre(joint)[:size])
    given = {key: values[key] for key in NEEDS[joint.kind]}
    if joint.kind == "gear":
        return {**given, "pressure_deg": math.degrees(joint.pressure)}
    return given | ({"at_m": at} if "at_m" not in given and any(joint.at) else {})


def _second_centre(joint: SchemeJoint) -> Place:
    """Return the centre of the second wheel of a pair of gears."""
    distance = abs(sum(joint.radii))
    x, y, z = (at + distance * along for at, along in zip(joint.at, joint.axes[0], strict=True))
    return (x, y, z)


SCHEMES = Path(__file__).parents[1] / "schemes"
PRESSURE_DEG = 20.0
"""Default pressure angle of gears (ISO 53)."""
SMALLEST = 1e-6
"""Least sine between two directions, and largest relative error of a gear's centre distance."""


def shipped_schemes() -> list[str]:
    """List the names of the schemes that come with crankcheck."""
    return list(shipped_in(SCHEMES))


def find_scheme(name_or_path: str) -> Path:
    """Find the file of a scheme. Raises CrankcheckError where there is none."""
    return find_table(name_or_path, SCHEMES, "scheme", "crankcheck mobility")


def load_scheme(name_or_path: str) -> Scheme:
    """Load a shipped scheme by name, or a scheme of a file. Raises CrankcheckError where there is
    none, and SceneError for a file with faults, all in one message."""
    path = find_scheme(name_or_path)
    table = read_table(path, SchemeTable)
    faults: list[str] = []
    for name, joint in table.joints.items():
        faults += [f"joints.{name}.{fault}" for fault in _faults(joint, table.links)]
    if not faults:
        joints = tuple(_joint(name, each) for name, each in table.joints.items())
        scheme = Scheme(
            table.name,
            table.space,
            table.source,
            tuple(table.links),
            joints,
            table.mobility,
            table.note,
        )
        faults = [
            f"links: no row of joints leads from ground to {link}; join it"
            for link in scheme.loose()
        ]
    if faults:
        raise SceneError(str(path), faults)
    return scheme


def _faults(joint: JointTable, links: list[str]) -> list[str]:
    faults = [
        f"between: no link {each}; {suggestion(each, (GROUND, *links), 'there are')}"
        for each in joint.between
        if each not in (GROUND, *links)
    ]
    if joint.axes is not None and _sine(*map(_place, joint.axes)) < SMALLEST:
        faults.append("axes: the two are parallel; those of a universal joint cross")
    if joint.kind == "cylinder-on-plane" and joint.axis and joint.normal:
        axis, normal = _place(joint.axis), _place(joint.normal)
        if abs(sum(a * b for a, b in zip(axis, normal, strict=True))) > SMALLEST * _size(
            axis
        ) * _size(normal):
            faults.append("axis: not across the normal; a cylinder lies on its plane")
    if joint.centres_m is not None and joint.radii_m is not None:
        distance, sum_of_radii = math.dist(*joint.centres_m), abs(sum(joint.radii_m))
        if abs(distance - sum_of_radii) > SMALLEST * sum_of_radii:
            faults.append(
                f"centres_m: {distance:g} m apart, where the pitch circles of radii_m touch at "
                f"{sum_of_radii:g} m"
            )
    return faults


def _joint(name: str, table: JointTable) -> SchemeJoint:
    """Make a joint of the theory. For gears ``at`` is the first centre, and the axis leads to the
    second."""
    at = _place(table.at_m or (0.0, 0.0))
    axes = tuple(_place(each) for each in (table.axis, *(table.axes or ()), table.normal) if each)
    if table.centres_m is not None:
        at, other = map(_place, table.centres_m)
        axes = ((other[0] - at[0], other[1] - at[1], 0.0),)
    degrees = PRESSURE_DEG if table.pressure_deg is None else table.pressure_deg
    return SchemeJoint(
        name,
        table.kind,
        table.between,
        at,
        tuple(_unit(axis) for axis in axes),
        table.radii_m or (0.0, 0.0),
        table.lead_m or 0.0,
        math.radians(degrees) if table.kind == "gear" else 0.0,
    )


def _place(given: list[float] | tuple[float, ...]) -> Place:
    x, y, z = (*given, 0.0)[:3]
    return (x, y, z)


def _size(vector: Place) -> float:
    return math.hypot(*vector)


def _unit(vector: Place) -> Place:
    size = _size(vector)
    x, y, z = (each / size for each in vector)
    return (x, y, z)


def _sine(a: Place, b: Place) -> float:
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return _size(cross) / (_size(a) * _size(b))
