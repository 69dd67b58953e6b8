"""What the name of a column says: of which body it is, of which kind, in which unit.

Our own grammar comes first, whatever bodies are called; then that of strangers' names.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from models.scene import GROUND
from reports.logs.name_units import (
    one_unit,
    refuse_other_dimension,
    trailing_unit,
    without_unit,
)
from reports.logs.own_columns import Meaning
from reports.logs.reading_words import kind_of_words
from reports.logs.scene_names import SceneNames
from reports.logs.units import si

FILLERS = {"angular", "linear", "of", "the", "link", "body", "point", "joint", "pin", "slider",
           "block", "log", "sensor", "at", "on", "in", "signal", "value"}  # fmt: skip
AFTER = {"on", "of", "at"}
"""Words after which a body has stood."""
MODEL = re.compile(r"^[./]?model_?\d*(?=[./])", re.IGNORECASE)
"""What Adams begins all names with, and Gazebo."""
RELATIVE = {"rel", "relative", "wrt", "to", "less", "minus"}


def meaning(column: str, named: SceneNames, told: str = "") -> Meaning | str:
    """What a column's name says, or why nothing is made of it. A unit that is ``told`` takes the
    place of that in the name.

    Raises CrankcheckError for units that contradict each other, or what they are units of.
    """
    if own := named.own.get(column):
        if isinstance(own, str) or not told:
            return own
        refuse_other_dimension(column, told, own.kind.dimension if own.kind else "length")
        return replace(own, unit=told)
    bodies, words = named.found(re.sub(MODEL, " ", without_unit(column)[0]))
    while words and words[-1] in AFTER:
        words.pop()
    unit, words = trailing_unit(words)
    unit = told or one_unit(column, unit)
    if not bodies:
        return "it names no link, point or slider of the scene"
    relative = not RELATIVE.isdisjoint(words)
    if "angular" in words:
        words = ["angle" if word == "displacement" else word for word in words]
    words = [word for word in words if word not in FILLERS | RELATIVE]
    of, relative_to, on = _roles(bodies, named, relative=relative)
    if not of:
        return f"it names {' and '.join(bodies)}; a map says of which it is"
    if words == ["gap"]:
        refuse_other_dimension(column, unit, "length")
        return Meaning(of, None, True, unit or "m")
    slider = "slider" in re.split(r"[^a-z]+", column.lower())
    kind = kind_of_words(named.kinds_of(of), words, unit, slider=slider)
    if isinstance(kind, str):
        return kind
    refuse_other_dimension(column, unit, kind.dimension)
    return Meaning(of, kind, False, unit or si(kind.dimension), relative_to, on)


def _roles(bodies: Sequence[str], named: SceneNames, *, relative: bool) -> tuple[str, str, str]:
    """Of which body a column is, relative to which link, and on which body; "" for nothing told."""
    bodies = list(dict.fromkeys(bodies))
    if len(bodies) == 1:
        return bodies[0] if bodies[0] != GROUND else "", "", ""
    if len(bodies) > 2:
        return "", "", ""
    links = [name for name in bodies if name in named.scene.links or name == GROUND]
    if len(links) == 2 and relative:
        return (links[0], "" if links[1] == GROUND else links[1], "")
    points = [name for name in bodies if name in named.points]
    if len(links) == 1 and len(points) == 1 and links != points:
        return points[0], "", links[0]
    return "", "", ""
