"""A scheme as the text of a file that `scheme_files` reads back as the same scheme."""

from __future__ import annotations

import math
from collections.abc import Iterator

from models.lectures.scheme import PLANAR, Place, Scheme, SchemeJoint
from models.lectures.scheme_schema import NEEDS


def scheme_text(scheme: Scheme) -> str:
    """The TOML of a scheme, a joint a line."""
    head = [("name", scheme.name), ("space", scheme.space), ("source", scheme.source)]
    head += [("note", scheme.note)] if scheme.note else []
    lines = [f"{key} = {_quoted(value)}" for key, value in head]
    if scheme.mobility is not None:
        lines.append(f"mobility = {scheme.mobility}")
    lines += [f"links = [{', '.join(map(_quoted, scheme.links))}]", "", "[joints]"]
    size = 2 if scheme.space == PLANAR else 3
    for joint in scheme.joints:
        first, second = map(_quoted, joint.between)
        keys = [f"between = [{first}, {second}]", f"kind = {_quoted(joint.kind)}"]
        keys += [f"{key} = {value}" for key, value in _given(joint, size)]
        lines.append(f"{joint.name} = {{ {', '.join(keys)} }}")
    return "\n".join(lines) + "\n"


def _given(joint: SchemeJoint, size: int) -> Iterator[tuple[str, str]]:
    """The keys of a joint's kind with their values."""
    axes = iter(joint.axes)
    for key in NEEDS[joint.kind]:
        if key == "at_m":
            yield key, _numbers(joint.at[:size])
        elif key in ("axis", "normal"):
            yield key, _numbers(next(axes)[:size])
        elif key == "axes":
            yield key, f"[{', '.join(_numbers(axis[:size]) for axis in axes)}]"
        elif key == "radii_m":
            yield key, _numbers(joint.radii)
        elif key == "lead_m":
            yield key, repr(joint.lead)
        elif key == "centres_m":
            yield key, f"[{_numbers(joint.at[:size])}, {_numbers(_second_centre(joint)[:size])}]"
    if "at_m" not in NEEDS[joint.kind] and joint.kind != "gear" and any(joint.at):
        yield "at_m", _numbers(joint.at[:size])
    if joint.kind == "gear":
        yield "pressure_deg", repr(math.degrees(joint.pressure))


def _second_centre(joint: SchemeJoint) -> Place:
    """Where the second wheel of a pair of gears turns."""
    distance = abs(sum(joint.radii))
    x, y, z = (at + distance * along for at, along in zip(joint.at, joint.axes[0], strict=True))
    return (x, y, z)


def _numbers(values: tuple[float, ...]) -> str:
    return f"[{', '.join(map(repr, values))}]"


def _quoted(text: str) -> str:
    """A text as TOML has it; names and sources hold no character that acts."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return '"' + escaped.replace("\t", "\\t") + '"'
