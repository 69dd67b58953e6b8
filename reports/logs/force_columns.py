"""The forces of a user's own log, by the names of columns.

``C_rod_fx_n`` is the force of pin C on the rod, along x of the ground; ``C_fx_n`` suffices where
two bodies meet, and acts on the second of them. ``C_slider_normal_n`` and ``C_slider_moment_n_m``
are reactions of the guide, ``torque_n_m`` is the drive's on the driver, ``drive_force_n`` that on a
slider. Dots and spaces replace underscores, and the unit may be in brackets. ``force_time_s`` are
the instants at which forces act, where they differ from those of the rows.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.motion import Forces, SliderForces
from models.scene import GROUND, Scene
from models.scene.joints import joined_at
from reports.logs.kinds import OF_TIME
from reports.output.numbers import listed

if TYPE_CHECKING:
    from reports.logs.columns import Columns


QUANTITIES = {"pin": "reaction", "push": "torque"}
"""Judged quantity of a kind of column, where the names differ."""


@dataclass(frozen=True)
class LogForces:
    """The forces of a log, NaN where missing; the ``columns`` of origin by quantity and body, and
    whether the first row has none, as for forces of steps."""

    forces: Forces
    columns: Mapping[tuple[str, str], tuple[str, ...]]
    of_steps: bool

    def first(self, rows: int) -> LogForces:
        """Return the forces of the first rows alone."""
        some = self.forces.each_series(lambda series: series[:rows])
        return replace(self, forces=replace(some, time_s=some.time_s[:rows]))


def log_forces(
    columns: Columns, scene: Scene, time_s: Array, acting_s: Array | None, ignored: set[str]
) -> LogForces:
    """Return the forces in the columns of a log but those ``ignored`` by the map: at the instants
    of the rows [s], (T,), or at those at which they are ``acting_s``. Raises CrankcheckError for no
    column of forces, two of one, or cells that are no numbers."""
    found = _found(columns, scene, ignored)
    if not found:
        raise CrankcheckError(
            f"{columns.source}: no column is a force of {scene.name}; found "
            f"{few(map(cut, columns.raw), 8)}; name columns such as {few(shown_names(scene), 6)}, "
            "or leave --forces out"
        )
    nothing = np.full(time_s.shape, np.nan)
    read = {place: values for place, (_, values) in found.items()}
    forces = Forces(
        time_s if acting_s is None else acting_s,
        {p: _pin(p, bodies, read, nothing) for p, bodies in joined_at(scene).items()},
        {
            name: SliderForces(*(read.get((kind, name, "", 0), nothing) for kind in OF_GUIDES))
            for name in scene.sliders
        },
        read.get(drive_place(scene), nothing),
        drive_unit=scene.driver.effort_unit,
    )
    by_body: dict[tuple[str, str], tuple[str, ...]] = {}
    for (kind, of, body, _), (column, _) in found.items():
        pair = len(joined_at(scene).get(of, ())) == 2
        name = f"{of} on {body}" if kind == "pin" and not pair else of
        key = (QUANTITIES.get(kind, kind), name)
        by_body[key] = (*by_body.get(key, ()), column)
    of_steps = any(np.isnan(values[0]) for values in read.values())
    return LogForces(forces, by_body, of_steps)


def _found(columns: Columns, scene: Scene, ignored: set[str]) -> dict[Place, tuple[str, Array]]:
    """Return the columns of forces, with their numbers in SI. Raises CrankcheckError."""
    places = force_places(scene)
    found: dict[Place, tuple[str, Array]] = {}
    for column in columns.raw:
        meant = None if column in ignored else force_meaning(column, places)
        if meant is None:
            continue
        place, factor = meant
        if math.isnan(factor):
            raise CrankcheckError(
                f"{columns.source}, column {cut(column)!r}: its unit may be milli or mega; write "
                "mN or MN, or ignore = true"
            )
        if place in found:
            raise CrankcheckError(
                f"two columns for one force: {cut(found[place][0])!r} and {cut(column)!r}; rename "
                "one, or ignore = true"
            )
        found[place] = column, factor * force_numbers(columns, column)
    lacking = [column for column, values in found.values() if np.isnan(values[0])]
    if lacking and len(lacking) < len(found):  # where forces are those of steps, all lack it
        columns.numbers(lacking[0])  # which refuses the cell
    return found


def _pin(
    point: str, bodies: tuple[str, ...], read: Mapping[Place, Array], nothing: Array
) -> dict[str, Array]:
    """Return the forces of a pin: of two bodies, the force on one is opposite to that on the
    other."""

    def component(body: str, axis: int) -> Array:
        own = read.get(("pin", point, body, axis))
        if own is None and len(bodies) == 2:
            other = read.get(("pin", point, bodies[body == bodies[0]], axis))
            own = None if other is None else -other
        return nothing if own is None else own

    return {body: np.stack([component(body, axis) for axis in (0, 1)], axis=-1) for body in bodies}


def force_numbers(columns: Columns, name: str) -> Array:
    """Return a column as numbers; the first cell may be empty."""
    cell = columns.raw[name][0]
    empty = cell is None or (isinstance(cell, float | np.floating) and math.isnan(cell))
    if not (empty or (isinstance(cell, str) and not cell.strip())):
        return columns.numbers(name)
    rest = replace(columns, raw={name: columns.raw[name][1:]}, first=columns.first + 1)
    return np.concatenate([[np.nan], rest.numbers(name)])


POUND, INCH = 4.4482216152605, 0.0254
UNITS: Mapping[str, Mapping[str, float]] = {
    "force": {"n": 1.0, "kn": 1e3, "mN": 1e-3, "MN": 1e6, "lbf": POUND},
    "moment": {
        **dict.fromkeys(("n_m", "nm"), 1.0),
        **dict.fromkeys(("n_mm", "nmm"), 1e-3),
        **dict.fromkeys(("kn_m", "knm"), 1e3),
        **dict.fromkeys(("mN_m", "mNm"), 1e-3),
        **dict.fromkeys(("MN_m", "MNm"), 1e6),
        "lbf_in": POUND * INCH,
        "lbf_ft": POUND * 12 * INCH,
    },
}
"""Size of each unit in SI, by its spelling: in letters of any case, except milli and mega."""
TIMES = "force_time_s"
Place = tuple[Literal["torque", "push", "pin", "normal", "moment"], str, str, int]
"""Content of a column: kind, point or slider, body, and axis; a push drives a slider."""
OF_GUIDES: Sequence[Literal["normal", "moment"]] = ("normal", "moment")
MOMENTS = ("torque", "moment")
A_FORCE = "a force, which is judged with --forces"
FORCE_LENGTH = "it is the length of a force, whose components are judged with --forces"
FRICTION = "it is friction, which is not judged"


def names_force(column: str, scene: Scene) -> bool:
    """True if a column is one of forces."""
    return column == TIMES or force_meaning(column, force_places(scene)) is not None


def shown_names(scene: Scene) -> list[str]:
    """Return the preferred name of each column of forces: at a pin of two bodies for the second."""
    names: dict[Place, str] = {}
    for name, place in force_places(scene).items():
        kind, of, body, _ = place
        if kind == "pin" and len(bodies := joined_at(scene)[of]) == 2 and body != bodies[1]:
            continue
        names.setdefault(place, f"{name}_{'n_m' if kind in MOMENTS else 'n'}")
    return list(names.values())


def force_places(scene: Scene) -> dict[str, Place]:
    """Return the accepted names of columns, without their units."""
    drive = drive_place(scene)
    names = [f"drive_{scene.driver.effort}"]
    if drive[0] == "torque":
        names = ["torque", f"{drive[1]}_torque", *names]
    found = dict.fromkeys(names, drive)
    for point, bodies in joined_at(scene).items():
        for axis, letter in enumerate("xy"):
            for body in bodies:
                place: Place = ("pin", point, body, axis)
                name = body.replace(" ", "_")
                found[f"{point}_{name}_f{letter}"] = place
                found[f"{point}_on_{name}_f{letter}"] = place
            if len(bodies) == 2:
                found[f"{point}_f{letter}"] = ("pin", point, bodies[1], axis)
    for name in scene.sliders:
        for kind in OF_GUIDES:
            found[f"{name}_slider_{kind}"] = found[f"{name}_{kind}"] = (kind, name, "", 0)
    return found


def drive_place(scene: Scene) -> Place:
    """Return the content of a column of the drive on the driver."""
    return "torque" if scene.driver.slider is None else "push", scene.driver.name, "", 0


def force_meaning(column: str, places: Mapping[str, Place]) -> tuple[Place, float] | None:
    """Return the content of a column, and the size of its unit in SI, NaN where that may be milli
    or mega; None for other columns."""
    for stem, kind, unit in _stems(column):
        place = places.get(stem)
        if place is None:  # torque in capitals, point b; but not if case separates two
            alike = {where for name, where in places.items() if name.lower() == stem.lower()}
            place = alike.pop() if len(alike) == 1 else None
        if place and (place[0] in MOMENTS) == (kind == "moment"):
            known = {"": 1.0, **UNITS[kind]}
            return place, known.get(unit, known.get(unit.lower(), math.nan))
    return None


def _stems(column: str) -> Iterator[tuple[str, str, str]]:
    """Yield names without a unit, with the kind of the unit, and its spelling, if any."""
    bare = re.sub(r"\s*[\[(]([^\[\]()]*)[\])]\s*$", r"_\1", OF_TIME.sub(" ", column).strip())
    words = re.sub(r"[\s._·*]+", "_", bare.strip()).strip("_")
    for kind, units in UNITS.items():
        for unit in units:
            stem = words[: -len(unit) - 1]
            if words.lower().endswith(f"_{unit.lower()}"):
                yield stem, kind, words[len(stem) + 1 :]
        yield words, kind, ""


def beside_forces(columns: Columns, unjudged: Iterable[tuple[str, str]]) -> dict[str, Array]:
    """Return the lengths of forces and the friction of a log, by column, of those ``unjudged``."""
    own = (FORCE_LENGTH, FRICTION)
    return {column: force_numbers(columns, column) for column, why in unjudged if why in own}


def why_not_judged(column: str, scene: Scene) -> str:
    """Return the reason why a column named like a force is not judged beside the motion: a force, a
    length, friction, a missing body; "" for other columns."""
    if names_force(column, scene):
        return A_FORCE
    reasons = _others(scene)
    why = next((reasons[stem] for stem, _, _ in _stems(column) if stem in reasons), "")
    return why or (UNCLEAR if looks_like_force(column, scene) else "")


_JOIN = r"[\s_.·⋅*-]*"
FORCE_UNIT = re.compile(
    rf"(?:[\[(]\s*|[\s_.,/]|^)(?:[kmM]?N(?:{_JOIN}[cm]?m)?|(?i:newtons?(?:{_JOIN}[a-z]+)?"
    rf"|lbf?{_JOIN}(?:in|ft)|(?:in|ft){_JOIN}lbf?|lbf|kgf|ozf|k?n_m|nmm))\s*[\])]?\s*$"
)
UNCLEAR = "it may be a force, which is judged by a name such as torque_n_m"


def looks_like_force(column: str, scene: Scene) -> bool:
    """True if a column is one of forces, has a unit of force or torque, or is a letter of force
    with its place or direction: T (N m), FB, RAx, F12x, Fx."""
    points = "|".join(re.escape(name) for name in (*scene.ground, *scene.pins) if len(name) < 3)
    letters = rf"(?:[FRN][xy]?_?(?:{points or '(?!)'})|F_?\d\d)_?[xyXY]?|F_?\d?[xyXY]"
    stem = re.sub(r"[\s_.]+", "_", re.sub(r"\s*[\[(].*$", "", column.strip()))
    has_letters = re.fullmatch(letters, stem) is not None
    return has_letters or bool(FORCE_UNIT.search(column)) or names_force(column, scene)


def _others(scene: Scene) -> dict[str, str]:
    """Return names of columns beside forces, without units, with the reason against judging."""
    every = [*scene.ground, *scene.pins, *(slider.point for slider in scene.sliders.values())]
    met: dict[str, tuple[str, ...]] = dict.fromkeys(every, ()) | dict(joined_at(scene))
    bodies = [GROUND, *scene.links, *(name for meet in met.values() for name in meet)]
    found: dict[str, str] = {}
    for point, meet in met.items():
        where = f"in {point} meet {listed(meet)}" if meet else f"{point} is not a pin"
        for body in dict.fromkeys(bodies):
            why = FORCE_LENGTH if body in meet else f"{where}, not {body}" if meet else where
            for stem in (f"{point}_{body}", f"{point}_on_{body}"):
                found |= dict.fromkeys(_vector(stem.replace(" ", "_")), why)
        which = f"{where}: name the body, as in {point}_{meet[0]}_fx_n" if meet else where
        found |= dict.fromkeys(_vector(point), FORCE_LENGTH if len(meet) == 2 else which)
        found[f"{point}_friction"] = FRICTION
    for name in scene.sliders:
        found |= dict.fromkeys((f"{name}_slider_friction", f"{name}_friction"), FRICTION)
    places = force_places(scene)
    return {name: why for name, why in found.items() if name not in places}


def _vector(stem: str) -> tuple[str, str, str]:
    return f"{stem}_fx", f"{stem}_fy", f"{stem}_f"
