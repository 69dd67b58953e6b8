"""Scheme files: the shipped ones and a user's own, read into a `Scheme`."""

from __future__ import annotations

import math
from pathlib import Path

from models.errors import SceneError, suggestion
from models.lectures.scheme import Place, Scheme, SchemeJoint
from models.lectures.scheme_schema import JointTable, SchemeTable
from models.lectures.shipped_tables import find_table, read_table, shipped_in
from models.scene import GROUND

SCHEMES = Path(__file__).parents[1] / "schemes"
PRESSURE_DEG = 20.0
"""Of gears where the file says none (ISO 53)."""
SMALLEST = 1e-6
"""Of the sine between two directions, and of a gear's centre distance over what its radii make."""


def shipped_schemes() -> list[str]:
    """The names of the schemes that come with crankcheck."""
    return list(shipped_in(SCHEMES))


def find_scheme(name_or_path: str) -> Path:
    """The file of a scheme. Raises CrankcheckError where there is none."""
    return find_table(name_or_path, SCHEMES, "scheme", "crankcheck mobility")


def load_scheme(name_or_path: str) -> Scheme:
    """A shipped scheme by name, or one of a file.

    Raises
    ------
    CrankcheckError
        Nothing there.
    SceneError
        A file with faults, all that were found in one message.
    """
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
    """What is wrong with a joint beside the others."""
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
    """A joint as the theory has it. Of gears ``at`` is the first centre, and the axis leads to the
    second one."""
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
    """Two or three coordinates as three."""
    x, y, z = (*given, 0.0)[:3]
    return (x, y, z)


def _size(vector: Place) -> float:
    return math.hypot(*vector)


def _unit(vector: Place) -> Place:
    size = _size(vector)
    x, y, z = (each / size for each in vector)
    return (x, y, z)


def _sine(a: Place, b: Place) -> float:
    """The sine of the angle between two directions."""
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return _size(cross) / (_size(a) * _size(b))
