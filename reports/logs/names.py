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
from reports.logs.force_columns import looks_like_force

FILLERS = {"angular", "rotational", "linear", "lin", "translational", "of", "the", "link", "body",
           "point", "joint", "joints", "revolute", "hinge", "pin", "slider", "block", "log", "get",
           "at", "on", "in", "signal", "value", "state", "states", "field", "cm", "mea", "measure",
           "marker", "xform", "transform", "rigidbody", "global", "world", "sensor", "component",
           "tf", "translation", "assem"}  # fmt: skip
AFTER = {"on", "of", "at"}
"""Words that follow a body's name."""
INDEX = re.compile(r"\[([012])\]")
"""Place of a component in a vector: xpos[0]."""
ABSOLUTE = re.compile(r"\|([vaVA])\|")
BELOW = re.compile(r"(?:(?<=[^A-Za-z]s)|(?<=sec)|(?<=\^))-(?=[12](?!\w))")
"""Sign of a power: s-1, mm*s^-2."""
GREEK = {ord(letter): f" {word} " for letter, word in zip("θϑφϕωα\u0307\u0308", (
    "theta", "theta", "phi", "phi", "omega", "alpha", "dot", "ddot"), strict=True)}  # fmt: skip
MODEL = re.compile(r"^[./]?model_?\d*(?=[./])", re.IGNORECASE)
"""Beginning of all names in Adams, and in Gazebo."""
DRIVERS = {"driver", "input", "motor"}
RELATIVE = {"rel", "relative", "wrt", "to", "less", "minus"}


def meaning(column: str, named: SceneNames, told: str = "") -> kinds.Meaning | str:
    """Return the meaning of a column's name, or the reason for none. A unit ``told`` by the map
    replaces that in the name. Raises CrankcheckError for units that contradict another, or their
    kind."""
    if own := named.own.get(column):
        if not told:
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
    words = [SHORTHAND.get(word, word) for word in plain_words(words)]
    words = " ".join(words).split()
    if not {"angular", "rotational", "ang"}.isdisjoint(words):
        words = ["angle" if word in ("displacement", "disp") else word for word in words]
    words = [word for word in words if word not in FILLERS | RELATIVE]
    of, relative_to, on = _roles(bodies, named, relative=relative)
    if not of:
        return f"it names {' and '.join(bodies)}; a map can name the right one"
    if words == ["gap"]:
        kinds.refuse_other_dimension(column, unit, "length")
        return kinds.Meaning(of, None, True, unit or "m")
    slider = "slider" in re.split(r"[^a-z]+", column.lower())
    kind = kind_of_words(named.kinds_of(of), words, unit, slider=slider)
    if not told and VOLTS.search(column):
        return "'V' is not a known unit, such as deg/s or mm/s^2"
    if isinstance(kind, str):
        odd = "" if told else _odd_unit(kinds.OF_TIME.sub("", column), named)
        return f"{cut(odd)!r} is not a known unit, such as deg/s or mm/s^2" if odd else kind
    if kind.dimension == "angle" and re.search(r"rads\W*$", column, re.IGNORECASE):
        unit = told or "rad"  # more often radians than radians per second
    kinds.refuse_other_dimension(column, unit, kind.dimension)
    return kinds.Meaning(of, kind, False, unit or kinds.si(kind.dimension), relative_to, on)


def _odd_unit(column: str, named: SceneNames) -> str:
    """Return the text of the last bracket if it is no unit, no body and no known word, else ""."""
    *_, last = ("", *(hit[1] for hit in kinds.BRACKETS.finditer(column)))
    bodies, words = named.found(last)
    is_word = bodies or kinds.spelled_unit(last) or VOCABULARY.issuperset(plain_words(words))
    return "" if is_word else last


def plain_words(words: Iterable[str]) -> list[str]:
    """Return words one by one, without the number of an instance: angaccel, twist/linear, vel2."""
    text = " ".join(words).replace("/", " ")
    parts = (JOINED.sub(r"\1 ", DOTTED.sub(r"\1 \2", part)).split() for part in text.split())
    every = [(part, part.rstrip("0123456789")) for each in parts for part in each]
    return [stem if stem in VOCABULARY else part for part, stem in every]


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


PLACES = {"pos", "position", "place", "coordinate", "coord", "pose", "location", "qpos", "xpos"}
SPEEDS = {"v", "vel", "velocity", "speed", "rate", "twist", "qvel", "dot"}
ACCELERATIONS = {"a", "acc", "accel", "acceleration", "qacc", "ddot"}
DERIVATIVES: Mapping[str, Sequence[set[str]]] = {
    "link": (
        {"theta", "angle", "angles", "ang", "phi", "rot", "rotation", "orientation", "q", "rz",
         "euler", "yaw", "heading", *PLACES},
        {"omega", "w", "dtheta", "qd", "wz", *SPEEDS},
        {"alpha", "b", "ddtheta", "qdd", "wdtz", *ACCELERATIONS},
    ),
    "slider": (
        {"displacement", "disp", "s", "stroke", "travel", *PLACES}, SPEEDS, ACCELERATIONS),
}  # fmt: skip
"""Words for a position and its two rates, by kind of body."""
AXES = {f"{prefix}{axis}": (order, at) for at, axis in enumerate("xy") for prefix, order in
        {"": 0, "p": 0, "t": 0, "v": 1, "a": 2}.items()}  # fmt: skip
SIZES = {"size", "mag", "magnitude", "norm", "resultant", "total", "tm"}
OF_PLACES = PLACES | {"p", "displacement", "disp"}
ASIDE = {"z": "x", "vz": "vx", "az": "ax", "pz": "x", "tz": "x"}
"""Components of points across the plane, and those along x."""
TILTS = {"x", "y", "rx", "ry"}
VOCABULARY = {*FILLERS, *RELATIVE, *AXES, *SIZES, *OF_PLACES, *ASIDE, *TILTS, *DRIVERS, "gap",
              *(word for sets in DERIVATIVES.values() for one in sets for word in one)}  # fmt: skip
VAGUE = {"a", "b", "s", "p", "v", "w", "rate", "place", "location", "total", "size"}
QUANTITY_WORDS = {"torque", "force", "moment", "reaction", "deflection", "extension", "angular",
                  *(VOCABULARY - FILLERS - RELATIVE - DRIVERS - VAGUE)}  # fmt: skip
FOREIGN = {"temperature", "temp", "current", "amps", "voltage", "volts", "volt", "power", "energy",
           "battery", "pressure", "humidity", "cpu", "memory", "count", "counter"}  # fmt: skip
"""Words of quantities of no mechanism: the C of temperature_C is a unit."""
INDICES = {"i", "u", "t"}
"""Letters of an index, a current, a voltage, a temperature: the A of i (A) is a unit."""
VOLTS = re.compile(r"[\[(]\s*V\s*[\])]\s*$")
SHORTHAND = {"dt": "dot", "dtdt": "ddot", "dd": "ddot", "vm": "v mag", "vmag": "v mag",
             "accm": "a mag", "amag": "a mag", "xd": "x dot", "yd": "y dot", "xdd": "x ddot",
             "ydd": "y ddot"}  # fmt: skip
"""Words of programs behind a body's name: GetPosDt, VM, ACCM."""
_JOINABLE = "|".join(sorted({*OF_PLACES, *SPEEDS, *ACCELERATIONS} - VAGUE, key=len, reverse=True))
JOINED = re.compile(rf"^(ang|angular|lin|linear|rot|rotational|trans)(?=(?:{_JOINABLE})\d*$)")
DOTTED = re.compile(r"^(theta|phi|q|x|y|s|omega)(d?dot)\d*$")
_QUANTITIES = "|".join(sorted((word for word in QUANTITY_WORDS if len(word) > 1), key=len)[::-1])
OUT_OF_PLANE = "it is a component out of the plane, which is constant in a plane motion"


def kind_of_words(
    body_kinds: Sequence[kinds.LoggedKind], words: Sequence[str], unit: str, *, slider: bool
) -> kinds.Kind | str:
    """Return the kind of reading that words and a unit name, or the reason for none."""
    if "elastic" in body_kinds and ("elastic", " ".join(words)) in kinds.KINDS:
        return kinds.KINDS["elastic", " ".join(words)]
    if "link" in body_kinds:
        if "orientation" in words and not {*"xyzw"}.isdisjoint(words):
            return "a component of a quaternion is not an angle"
        kind = _kind_of_order("link", [word for word in words if word != "z"] or words, unit)
        if isinstance(kind, str) and len(words) > 1:
            upright = _kind_of_order("link", [word for word in words if word not in TILTS], "")
            return kind if isinstance(upright, str) else OUT_OF_PLANE
        return kind
    sized = not SIZES.isdisjoint(words)
    axis = None if slider or sized else _axis(words)
    every = [kind for kind in kinds.KINDS.values() if kind.body_kind == "point"]
    if "point" in body_kinds and axis:
        return next(k for k in every if (k.order, k.axis) == axis)
    if "slider" in body_kinds and not sized:
        return _kind_of_order("slider", words, unit)
    order = _order(
        [word for word in words if not ((sized and word.isdigit()) or word in SIZES)],
        (set(), SPEEDS, ACCELERATIONS),
    )
    if sized and set(words) <= SIZES:  # the unit names the kind
        order = {"velocity": 1, "acceleration": 2}.get(kinds.DIMENSION.get(unit, ""))
    if "point" in body_kinds and order:
        return next(k for k in every if k.is_size and k.order == order)
    if _axis([ASIDE.get(word, word) for word in words]):
        return OUT_OF_PLANE
    return _why_no_kind(words, "point", unit)


def _kind_of_order(
    body_kind: Literal["link", "slider"], words: Sequence[str], unit: str
) -> kinds.Kind | str:
    """Return the kind by a derivative that words name, or by the unit; or why there is none."""
    of_body = [kind for kind in kinds.KINDS.values() if kind.body_kind == body_kind]
    words = [word for word in words if not word.isdigit()]  # of an instance: rocker-1
    if words:
        order = _order(words, DERIVATIVES[body_kind])
        chosen = [kind for kind in of_body if kind.order == order]
    else:
        dimension = kinds.DIMENSION.get(unit, of_body[0].dimension)
        chosen = [kind for kind in of_body if kind.dimension == dimension]
    return chosen[0] if chosen else _why_no_kind(words, body_kind, unit)


def _order(words: Sequence[str], names: Sequence[set[str]]) -> int | None:
    """Return the derivative that some words name; None where they name none, or several."""
    more = words.count("dot") + 2 * words.count("ddot")
    plain = [word for word in words if word not in ("dot", "ddot")]
    orders = {n for word in plain for n, known in enumerate(names) if word in known}
    known = set().union(*names)
    if len(orders) == 2 and 0 in orders and not PLACES.isdisjoint(names[0]):
        orders -= {0}  # angle velocity
    return orders.pop() + more if len(orders) == 1 and known.issuperset(plain) else None


def _axis(words: Sequence[str]) -> tuple[int, int] | None:
    """Return derivative and axis of a point's component; None where the words name none."""
    axes = [word for word in words if word in AXES]
    if len(axes) != 1:
        return None
    order, axis = AXES[axes[0]]
    for word in words:
        if word == axes[0] or word in OF_PLACES or word.isdigit():
            continue
        rate = 1 if word in SPEEDS else 2 if word in ACCELERATIONS else None
        if rate is None or order not in (0, rate):
            return None
        order = rate
    return order, axis


def _why_no_kind(words: Sequence[str], kind: str, unit: str) -> str:
    told: Mapping[str, str] = {
        "link": "angle, angular velocity or angular acceleration",
        "point": "x, y, vx, vy, ax, ay, or v or a in size",
        "slider": "displacement, speed or acceleration",
    }
    if words:
        return f"{cut(' '.join(words))!r} is not a kind of reading of a {kind}: {told[kind]}"
    of = f"{unit} is a unit of {kinds.DIMENSION[unit]}, and" if unit else "it names no kind:"
    return f"{of} a {kind} has {told[kind]}"


AMBIGUOUS = {"d", "f", "g", "h", "m", "n", "o", *INDICES}
"""Small letters beside an axis that may be no point: a derivative, a force, a unit, an index."""
OF_POINTS = "(?i:pt|point|joint|jnt|node|marker|pin)?"
"""Words in front of a point's name in a word: PointC_x."""
LONG = 5
"""Names of bodies from this length on are searched within words."""
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
    def own(self) -> Mapping[str, kinds.Meaning]:
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

    def found(self, text: str, *, drivers: bool = True) -> tuple[list[str], list[str]]:
        """Return the bodies that a text names, in its order, the driven one also as a motor with
        ``drivers``, and the other words, in lower case: `xC` and `rockerAngle` too."""
        text = INDEX.sub(lambda hit: f" {'xyz'[int(hit[1])]} ", text)
        text = ABSOLUTE.sub(lambda hit: f" {hit[1].lower()} size ", text)
        bodies, words = self._apart(text)
        if not bodies:
            bodies, words = self._apart(self._parted(text))
        if not bodies:
            bodies, words = self._apart(self._raised(text))
        if drivers and not bodies and not DRIVERS.isdisjoint(words):
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
        links = "|".join(re.escape(name) for name in self.bodies if len(name) > SHORT)
        quantities = f"(?i:(?:ang|angular|linear)?(?:{_QUANTITIES})|deg|degrees|rad|rpm)"
        for names, others in ((points, "[vaVA]?[xyXY]"), (f"(?i:{links})", quantities)):
            for pair in (f"({names})({others})", f"({others})({names})"):
                text = re.sub(rf"(?<![A-Za-z0-9]){pair}(?![A-Za-z0-9])", r"\1 \2", text)
        return text

    def _raised(self, text: str) -> str:
        """Return a text with small letters of points as capitals where an axis is named: c_x."""
        every = (name.lower() for name in self.points if len(name) == 1)
        letters = f"[{''.join(sorted({*every} - VOCABULARY - AMBIGUOUS))}]"
        if letters == "[]":
            return text
        for pair in (f"({letters})([va]?[xy])", f"([va]?[xy])({letters})"):
            text = re.sub(rf"(?<![A-Za-z0-9]){pair}(?![A-Za-z0-9])", r"\1 \2", text)
        if AXES.keys().isdisjoint(re.split(r"[^a-z0-9]+", text.lower())):
            return text
        pattern = rf"(?<![A-Za-z0-9]){letters}(?![A-Za-z0-9])"
        return re.sub(pattern, lambda hit: hit[0].upper(), text)

    def is_glued(self, text: str, words: Iterable[str]) -> bool:
        """True if a word begins or ends with a body's name, or, for points of one or two letters,
        is that and a digit or another letter, beside an axis: rockerw, C1_x, OC_x."""
        for name in self.bodies:
            own = re.escape(name) + r"(?!\d)" * name[-1].isdigit()
            if len(name) > SHORT and name != GROUND:
                rest = f"(?:[a-z]?|degs?|rads?|rpm|{_QUANTITIES})(?![a-z])"
                part = own if len(name) >= LONG else f"(?<![a-z])[a-z]?{own}{rest}"
                if re.search(f"(?i:{part})", text):
                    return True
            elif name in self.points:
                digit = r"\d?" * (not name[-1].isdigit())
                alone = f"(?:[A-Za-z]?(?i:{own})|(?:{OF_POINTS}|[a-z][A-Z]){own}(?:pt)?){digit}"
                moved = f"(?:[A-Za-z]{{0,2}}|{OF_POINTS}){own}{digit}(?i:{_QUANTITIES}|[va]?[xy]|v)"
                axis = rf"(?i:{own}{digit}[va]?[xy]\d?|[va]?[xy]{own}{digit})|{moved}\d?"
                for word in re.split(r"[^A-Za-z0-9]+", text):
                    moves = not {*AXES, "v", "a"}.isdisjoint({*words} - {word.lower()})
                    if (moves and re.fullmatch(alone, word)) or (
                        word.lower() not in ("by", "day") and re.fullmatch(axis, word)
                    ):
                        return True
        return False

    def _apart(self, text: str) -> tuple[list[str], list[str]]:
        places: list[tuple[int, str]] = []
        for name in self.bodies:
            flags = 0 if len(name) <= SHORT else re.IGNORECASE
            pattern = rf"(?<![A-Za-z0-9])({re.escape(name)})(?:-\d+)?(?![A-Za-z0-9])"
            while hit := re.search(pattern, text, flags):
                body = self._in_its_case(hit[1])
                if not body:
                    break
                places.append((hit.start(), body))
                text = text[: hit.start()] + " " * len(hit[0]) + text[hit.end() :]
        text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", BELOW.sub("⁻", text.translate(GREEK)))
        words = [word.strip("/·").lower() for word in re.split(r"[^A-Za-z0-9°µμ·⁻¹²/^*']+", text)]
        return [name for _, name in sorted(places)], [word for word in words if word]


def is_named(column: str, named: SceneNames) -> bool:
    """Return whether a column names a link, point or slider, or a quantity that is known."""
    text, unit = kinds.without_unit(column)
    bodies, words = named.found(re.sub(MODEL, " ", text), drivers=False)
    others = INDICES if text.endswith((")", "]")) or words == ["i"] else ()
    foreign = not FOREIGN.union(others).isdisjoint(words)
    told = QUANTITY_WORDS.intersection(plain_words(words))
    last = rf"(?<![A-Za-hj-z0-9])({'|'.join(map(re.escape, bodies)) or '(?!)'})\W*$"
    if foreign and not told and max(map(len, bodies), default=0) == 1 and re.search(last, text):
        return False  # a unit, as the C of temperature_C
    if not unit:
        unit, words = kinds.trailing_unit(words)
        unit = "" if unit in kinds.LAST_ALONE else unit
    has_unit = unit != "g" and kinds.DIMENSION.get(unit, "time") != "time"  # a mass in grams
    words = [word for word in plain_words(words) if not word.isdigit()]
    told = QUANTITY_WORDS.intersection(words)
    # A letter is a quantity among words of a mechanism alone: x of marker 2.
    mechanical = VOCABULARY.union(INDICES).issuperset(words)
    if has_unit or any(len(word) > 1 for word in told) or (told and mechanical):
        return True
    if bodies:
        return bodies != [GROUND]
    return named.is_glued(text, words) or looks_like_force(column, named.scene)
