"""Meaning of the name of a column: its body, its kind, its unit.

Our own grammar comes first, whatever the names of bodies; then that of other programs' names.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

from models.errors import cut
from models.scene import GROUND, Scene
from reports.logs import kinds

FILLERS = {"angular", "linear", "of", "the", "link", "body", "point", "joint", "pin", "slider",
           "block", "log", "sensor", "at", "on", "in", "signal", "value"}  # fmt: skip
AFTER = {"on", "of", "at"}
"""Words that follow a body's name."""
MODEL = re.compile(r"^[./]?model_?\d*(?=[./])", re.IGNORECASE)
"""Beginning of all names in Adams, and in Gazebo."""
RELATIVE = {"rel", "relative", "wrt", "to", "less", "minus"}


def meaning(column: str, named: SceneNames, told: str = "") -> kinds.Meaning | str:
    """Return the meaning of a column's name, or the reason for none. A unit ``told`` by the map
    replaces that in the name. Raises CrankcheckError for units that contradict each other, or their
    kind."""
    if own := named.own.get(column):
        if isinstance(own, str) or not told:
            return own
        kinds.refuse_other_dimension(column, told, own.kind.dimension if own.kind else "length")
        return replace(own, unit=told)
    bodies, words = named.found(re.sub(MODEL, " ", kinds.without_unit(column)[0]))
    while words and words[-1] in AFTER:
        words.pop()
    unit, words = kinds.trailing_unit(words)
    unit = told or kinds.one_unit(column, unit)
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
        kinds.refuse_other_dimension(column, unit, "length")
        return kinds.Meaning(of, None, True, unit or "m")
    slider = "slider" in re.split(r"[^a-z]+", column.lower())
    kind = kind_of_words(named.kinds_of(of), words, unit, slider=slider)
    if isinstance(kind, str):
        return kind
    kinds.refuse_other_dimension(column, unit, kind.dimension)
    return kinds.Meaning(of, kind, False, unit or kinds.si(kind.dimension), relative_to, on)


def _roles(bodies: Sequence[str], named: SceneNames, *, relative: bool) -> tuple[str, str, str]:
    """Return the body of a column, its relative link, and the body that carries it; "" if open."""
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


PLACES = {"pos", "position", "place", "coordinate", "coord"}
SPEEDS = {"v", "vel", "velocity", "speed", "rate"}
ACCELERATIONS = {"a", "acc", "accel", "acceleration"}
DERIVATIVES: Mapping[str, Sequence[set[str]]] = {
    "link": (
        {"theta", "angle", "ang", "phi", "rot", "rotation", "orientation", "q", *PLACES},
        {"omega", "w", "angvel", "thetadot", "dtheta", "qd", *SPEEDS},
        {"alpha", "angacc", "thetaddot", "qdd", *ACCELERATIONS},
    ),
    "slider": (
        {"displacement", "disp", "s", "stroke", "travel", *PLACES},
        {"sdot", *SPEEDS},
        {"sddot", *ACCELERATIONS},
    ),
}
"""Words for a position and its two rates, by kind of body."""
AXES = {f"{prefix}{axis}": (order, at) for at, axis in enumerate("xy") for order, prefix in
        enumerate(("", "v", "a"))} | {"px": (0, 0), "py": (0, 1)}  # fmt: skip


def kind_of_words(
    body_kinds: Sequence[kinds.LoggedKind], words: Sequence[str], unit: str, *, slider: bool
) -> kinds.Kind | str:
    """Return the kind of reading that words and a unit name, or the reason for none."""
    if "elastic" in body_kinds and ("elastic", " ".join(words)) in kinds.KINDS:
        return kinds.KINDS["elastic", " ".join(words)]
    if "link" in body_kinds:
        if len(words) > 1 and words[-1] == "z":  # the axis that all turn about
            words = words[:-1]
        return _kind_of_order("link", words, unit)
    axis = None if slider else _axis(words)
    if "point" in body_kinds and axis:
        every = kinds.KINDS.values()
        return next(k for k in every if (k.body_kind, k.order, k.axis) == ("point", *axis))
    if "slider" in body_kinds:
        return _kind_of_order("slider", words, unit)
    if list(words) in (["v"], ["a"]):
        return kinds.LENGTH
    return _why_no_kind(words, "point", unit)


def _kind_of_order(
    body_kind: Literal["link", "slider"], words: Sequence[str], unit: str
) -> kinds.Kind | str:
    """Return the kind by a derivative that words name, or by the unit; or why there is none."""
    of_body = [kind for kind in kinds.KINDS.values() if kind.body_kind == body_kind]
    if words:
        order = _order(words, DERIVATIVES[body_kind])
        chosen = [kind for kind in of_body if kind.order == order]
    else:
        dimension = kinds.DIMENSION.get(unit, of_body[0].dimension)
        chosen = [kind for kind in of_body if kind.dimension == dimension]
    return chosen[0] if chosen else _why_no_kind(words, body_kind, unit)


def _order(words: Sequence[str], names: Sequence[set[str]]) -> int | None:
    """Return the derivative that some words name; None where they name none, or several."""
    orders = {n for word in words for n, known in enumerate(names) if word in known}
    known = set().union(*names)
    if len(orders) == 2 and 0 in orders and not PLACES.isdisjoint(names[0]):
        orders -= {0}  # angle velocity
    return orders.pop() if len(orders) == 1 and known.issuperset(words) else None


def _axis(words: Sequence[str]) -> tuple[int, int] | None:
    """Return derivative and axis of a point's component; None where the words name none."""
    axes = [word for word in words if word in AXES]
    if len(axes) != 1:
        return None
    order, axis = AXES[axes[0]]
    for word in words:
        if word == axes[0] or word in PLACES | {"p"}:
            continue
        if word in SPEEDS and order == 0:
            order = 1
        elif word in ACCELERATIONS and order == 0:
            order = 2
        else:
            return None
    return order, axis


def _why_no_kind(words: Sequence[str], kind: str, unit: str) -> str:
    told: Mapping[str, str] = {
        "link": "angle, angular velocity or angular acceleration",
        "point": "x, y, vx, vy, ax or ay",
        "slider": "displacement, speed or acceleration",
    }
    if words:
        return f"{cut(' '.join(words))!r} is no kind of reading of a {kind}: {told[kind]}"
    of = f"{unit} is a unit of {kinds.DIMENSION[unit]}, and" if unit else "it tells no kind:"
    return f"{of} a {kind} has {told[kind]}"


DRIVERS = {"driver", "input", "motor"}
SHORT = 2
"""Names of bodies up to this length depend on case: `a` is an acceleration, `A` a point."""


@dataclass(frozen=True)
class SceneNames:
    """The bodies of a scene, in the forms that names of columns may have."""

    scene: Scene

    @cached_property
    def points(self) -> frozenset[str]:
        return frozenset([*self.scene.pins, *(each.point for each in self.scene.sliders.values())])

    @cached_property
    def bodies(self) -> Sequence[str]:
        """All names, longest first."""
        every = {*self.scene.links, *self.points, *self.scene.sliders, GROUND}
        return sorted(every, key=lambda name: (-len(name), name))

    @cached_property
    def own(self) -> Mapping[str, kinds.Meaning | str]:
        """The meanings of the columns that we write ourselves, by name."""
        return kinds.own_meanings({body: self.kinds_of(body) for body in self.bodies})

    def kinds_of(self, name: str) -> tuple[kinds.LoggedKind, ...]:
        """Return the kinds of bodies of that name: often a slider and its point have the same."""
        there: Iterable[tuple[kinds.LoggedKind, bool]] = (
            ("link", name in self.scene.links),
            ("point", name in self.points),
            ("slider", name in self.scene.sliders),
            ("elastic", name in self.scene.elastic),
        )
        return tuple(kind for kind, holds in there if holds)

    def found(self, text: str) -> tuple[list[str], list[str]]:
        """Return the bodies that a text names, in its order, and the other words, in lower case:
        `xC` and `rockerAngle` too."""
        bodies, words = self._apart(text)
        if not bodies:
            bodies, words = self._apart(self._parted(text))
        if not bodies and not DRIVERS.isdisjoint(words):
            bodies = [self.scene.driver.name]
            words = [word for word in words if word not in DRIVERS]
        return bodies, words

    def _in_its_case(self, text: str) -> str:
        """Return the body of that spelling, or the only one in other letters; "" for several."""
        alike = [name for name in self.bodies if name.lower() == text.lower()]
        return text if text in alike else alike[0] if len(alike) == 1 else ""

    def _parted(self, text: str) -> str:
        """Return a text with spaces before capitals in words, and between a point and its axis."""
        text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
        points = "|".join(re.escape(name) for name in self.bodies if name in self.points)
        text = re.sub(rf"(?<![A-Za-z0-9])({points})([va]?[xy])(?![A-Za-z0-9])", r"\1 \2", text)
        return re.sub(rf"(?<![A-Za-z0-9])([va]?[xy])({points})(?![A-Za-z0-9])", r"\1 \2", text)

    def _apart(self, text: str) -> tuple[list[str], list[str]]:
        places: list[tuple[int, str]] = []
        for name in self.bodies:
            flags = 0 if len(name) <= SHORT else re.IGNORECASE
            pattern = rf"(?<![A-Za-z0-9]){re.escape(name)}(?![A-Za-z0-9])"
            while hit := re.search(pattern, text, flags):
                body = self._in_its_case(hit[0])
                if not body:
                    break
                places.append((hit.start(), body))
                text = text[: hit.start()] + " " * len(name) + text[hit.end() :]
        words = [word.strip("/").lower() for word in re.split(r"[^A-Za-z0-9°µμ²/^*']+", text)]
        return [name for _, name in sorted(places)], [word for word in words if word]
