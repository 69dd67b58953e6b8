"""Conversion of columns to readings, by their names and the map; and the columns of times."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from models.scene.laws import MOST_TURNS
from reports.logs import map_file
from reports.logs.channel import Channel, OwnLog, Reading
from reports.logs.column_meaning import (
    GapColumn,
    beside_forces,
    column_meaning,
    gaps_told,
    reading,
    sized_channels,
    unjudged_columns,
)
from reports.logs.columns import Columns
from reports.logs.force_columns import A_FORCE, TIMES, log_forces, names_force, why_not_judged
from reports.logs.kinds import DIMENSION, UNITS, one_unit, si, spelled_unit, without_unit
from reports.logs.map_file import Map
from reports.logs.names import SceneNames, is_named, meaning

TIME_NAMES = {"time", "t", "timestamp", "time stamp", "times", "sim time", "simtime",
              "simulation time", "elapsed", "elapsed time", "time steps",
              "timesteps"}  # fmt: skip


def time_of(column: str, told: str = "") -> tuple[str, str] | None:
    """Return kind (``time``, ``velocity time``, ``acceleration time``) and unit, perhaps ``told``,
    of a column of times; None for others. Raises CrankcheckError for two units."""
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", without_unit(column)[0])
    words = [word.lower() for word in re.split(r"[^A-Za-z0-9µμ]+", text) if word]
    unit = ""
    if len(words) > 1 and DIMENSION.get(spelled_unit(words[-1])) == "time":
        unit = spelled_unit(words.pop())
        if words[-1] == "in":
            words.pop()
    name = " ".join(words)
    if name not in TIME_NAMES and name not in ("velocity time", "acceleration time"):
        return None
    unit = told or one_unit(column, unit) or si("time")
    return ("time" if name in TIME_NAMES else name, unit) if DIMENSION[unit] == "time" else None


def time_columns(columns: Columns, map_: Map) -> dict[str, str]:
    """Return the columns of times, by kind: that of all rows is ``time``. Raises CrankcheckError
    for none, and for two."""
    found: dict[str, list[str]] = {}
    others = {one.column for one in map_.channel if one.ignore or map_.time.column is not None}
    for column in columns.raw:
        if column not in others and (time := time_of(column, map_.time.unit or "")):
            found.setdefault(time[0], []).append(column)
    if map_.time.column is not None:
        columns.require([map_.time.column], "[time] column")
        found["time"] = [map_.time.column]
    if "time" not in found:
        raise CrankcheckError(
            f"{columns.source}: no column of times; found {few(map(cut, columns.raw), 8)}; name "
            "one time_s or time_ms, or say it in [time] of a map"
        )
    for whose, several in found.items():
        if len(several) > 1:
            raise CrankcheckError(
                f"{columns.source}: two columns of times, {several[0]!r} and {several[1]!r}; say "
                f"which in [time] of a map, and ignore the other"
                if whose == "time"
                else f"{columns.source}: two columns for {whose}: {', '.join(several[:2])}"
            )
    return {whose: several[0] for whose, several in found.items()}


def unit_of_time(column: str, map_: Map) -> str:
    """Return the unit of the times of all rows."""
    told = time_of(column, map_.time.unit or "")
    return map_.time.unit or (told[1] if told else si("time"))


def further_instants(columns: Columns, column: str, zero_s: float, scene: Scene) -> Array:
    """Return the instants in a further column of times [s]. Raises CrankcheckError for times that
    go back, or far from the start."""
    told = time_of(column)
    time_s = columns.numbers(column) * UNITS["time"][told[1] if told else si("time")]
    refuse_back(columns, column, time_s)
    refuse_far(columns, column, time_s - zero_s, scene)
    return np.asarray(time_s - zero_s)


EVEN = 0.02
"""Relative difference below which intervals are equal."""
MOSTLY = 0.9
"""The share of equal intervals in an even log."""
HOLE = 1.9
"""Ratio of an interval to the usual one from which on samples are missing."""


def instants(columns: Columns, column: str, unit: str, *, holes: bool = False) -> Array:
    """Return the times of all rows [s], (T,). Raises CrankcheckError for fewer than 2 rows; times
    that go back or stand still; samples missing in an even log, unless ``holes`` are intended."""
    time_s = columns.numbers(column) * UNITS["time"][unit]
    if time_s.size < 2:
        raise CrankcheckError(f"{columns.source}: {time_s.size} row; a motion has at least 2")
    refuse_back(columns, column, time_s)
    if not holes:
        _refuse_holes(columns, column, time_s, np.diff(time_s))
    return np.asarray(time_s)


def refuse_back(columns: Columns, column: str, time_s: Array) -> None:
    """Refuse times that go back or stand still. Raises CrankcheckError."""
    steps = np.diff(time_s)
    back = np.flatnonzero(steps <= 0.0)
    if back.size:
        row = int(back[0])
        does = "goes back" if steps[row] < 0.0 else "stands still"
        raise CrankcheckError(
            f"{columns.at(column, row + 1)}: time {does}, from {time_s[row]:.9g} s to "
            f"{time_s[row + 1]:.9g} s ({back.size} such rows); sort the rows, and keep one of each "
            "instant"
        )


def refuse_far(columns: Columns, column: str, time_s: Array, scene: Scene) -> None:
    """Refuse times so late that the place within a turn is lost. Raises CrankcheckError."""
    far = float(np.max(np.abs(time_s)))
    turns = far / scene.driver.law.period_s
    if turns > MOST_TURNS:
        raise CrankcheckError(
            f"{columns.source}, column {cut(column)!r}: t = {far:.9g} s is {turns:.3g} turns of "
            f"{scene.driver.joint} after the start; count the time from the start of the motion, "
            f"or from the first row: zero = {'first'!r} in [time] of the map"
        )


def _refuse_holes(columns: Columns, column: str, time_s: Array, steps: Array) -> None:
    usual = float(np.median(steps))
    same = np.abs(steps - usual) <= EVEN * usual
    far = np.flatnonzero(steps > HOLE * usual)
    if far.size == 0 or np.mean(same) < MOSTLY:
        return
    row = int(far[0])
    lacking = round(float(steps[row]) / usual) - 1
    raise CrankcheckError(
        f"{columns.at(column, row + 1)}: a gap of {steps[row]:.4g} s in a log of a sample every "
        f"{usual:.4g} s, {lacking} of them missing after t = {time_s[row]:.6g} s ({far.size} such "
        f"gaps); fill them, cut the log there, or say {cut('holes = ' + repr('meant'))} in [file] "
        "of the map"
    )


def understood(
    columns: Columns, scene: Scene, map_: map_file.Map | None = None, *, forces: bool = False
) -> OwnLog:
    """Return the log of a scene, with its ``forces`` on request; meanings of columns by the user's
    map replace those by their names.

    Raises CrankcheckError for no column of times, or one that goes back; no column of the scene;
    two columns for one quantity; units that contradict their kind; cells that are no numbers; a map
    with unknown names.
    """
    map_ = map_ or map_file.Map()
    times = time_columns(columns, map_)
    told = {one.column: one for one in map_.channel}
    columns.require(told, "[[channel]] column")
    for column in told:
        if column in times.values():
            raise CrankcheckError(
                f"[[channel]] {column!r}: it is the column of times; say of it in [time], or which "
                "other column that is"
            )
    borne = {name for name in columns.raw if forces and names_force(name, scene)}
    moving = replace(columns, raw={n: x for n, x in columns.raw.items() if n not in borne})
    channels, gaps, unused = _by_meaning(moving, scene, told, times)
    channels, copies, still = judged_channels(
        sized_channels(channels, columns, told, scene.sliders), scene
    )
    unjudged = unjudged_columns(columns, unused, SceneNames(scene))
    unused += [(each.column, STILL) for each in still]
    if not (channels or gaps or borne):
        in_python = "(in Python: the argument map, with {'channel': [{'column': ...}]})"
        raise CrankcheckError(f"{_nothing_found_text(columns, scene, unused)} {in_python}")
    main = times["time"]
    base = instants(columns, main, unit_of_time(main, map_), holes=map_.file.holes == "meant")
    zero_s = float(base[0]) if map_.time.zero else 0.0
    base = base - zero_s
    refuse_far(columns, main, base, scene)
    others = {c: further_instants(columns, c, zero_s, scene) for c in times.values() if c != main}

    def readings(some: Sequence[Channel]) -> tuple[Reading, ...]:
        return tuple(
            reading(columns, each, told.get(each.column), others.get(each.time, base))
            for each in some
        )

    ignored = {column for column, one in told.items() if one.ignore}
    acts = further_instants(columns, TIMES, zero_s, scene) if TIMES in borne else None
    return OwnLog(
        source=columns.source,
        scene=scene,
        time_s=base,
        readings=readings(channels),
        stamp=(main, unit_of_time(main, map_)),
        zero_s=zero_s,
        copies=readings(copies),
        gaps=gaps_told(columns, gaps),
        still=readings(still),
        unused=tuple(unused),
        unjudged=unjudged,
        besides=beside_forces(columns, unjudged) if forces else {},
        forces=log_forces(columns, scene, base, acts, ignored) if forces else None,
    )


STILL = "it is of a point of the ground, which does not move"


def wanted(scene: Scene, map_: map_file.Map, *, forces: bool = False) -> Callable[[str], bool]:
    """Return a test of the names of columns that are worth reading: others are only named."""
    is_meant, named = _meant(scene, map_, forces=forces), SceneNames(scene)
    ignored = {one.column for one in map_.channel if one.ignore}
    return lambda column: is_meant(column) or (column not in ignored and is_named(column, named))


def _meant(scene: Scene, map_: map_file.Map, *, forces: bool = False) -> Callable[[str], bool]:
    """Return a test of the names of columns with a meaning, but of points of the ground."""
    named = SceneNames(scene)
    told = {one.column: one for one in map_.channel}

    def is_wanted(column: str) -> bool:
        if column in told:
            return not told[column].ignore
        if forces and names_force(column, scene):
            return True
        try:
            if column == map_.time.column or time_of(column):
                return True
            found = meaning(column, named)
        except CrankcheckError:
            return True  # a name that contradicts itself, reported later
        return not isinstance(found, str) and (found.gap or found.of not in scene.ground)

    return is_wanted


def _by_meaning(
    columns: Columns,
    scene: Scene,
    told: Mapping[str, map_file.ChannelTable],
    times: Mapping[str, str],
) -> tuple[list[Channel], list[GapColumn], list[tuple[str, str]]]:
    """Return the columns of the scene, and the others with the reason. Raises CrankcheckError."""
    named = SceneNames(scene)
    channels: list[Channel] = []
    gaps: list[GapColumn] = []
    unused: list[tuple[str, str]] = []
    for column in columns.raw:
        if column in times.values():
            continue
        found = column_meaning(column, told.get(column), named, times)
        if isinstance(found, str):
            is_force = names_force(column, scene)
            told_so = A_FORCE if is_force else why_not_judged(column, scene)
            unused.append((column, found if found == map_file.LEFT_OUT else told_so or found))
        elif isinstance(found, GapColumn):
            gaps.append(found)
        else:
            channels.append(found)
    return channels, gaps, unused


def _nothing_found_text(columns: Columns, scene: Scene, unused: Sequence[tuple[str, str]]) -> str:
    bodies = few([*scene.links, *scene.pins, *scene.sliders], 12)
    why = f" ({cut(unused[0][0])!r}: {unused[0][1]})" if unused else ""
    return (
        f"{columns.source}: no column is of scene {scene.name}, which has {bodies}; found "
        f"{few(map(cut, columns.raw), 8)}{why}; name columns such as "
        f"{next(iter(scene.links))}_deg, or write a map: --write-map map.toml"
    )


def judged_channels(
    channels: Sequence[Channel], scene: Scene
) -> tuple[list[Channel], list[Channel], list[Channel]]:
    """Return the channels to be judged, those of further copies of a point's position, for a gap,
    and those of points of the ground. Raises CrankcheckError for two columns of one
    quantity."""
    first: dict[tuple[object, ...], Channel] = {}
    main: list[Channel] = []
    copies: list[Channel] = []
    still: list[Channel] = []
    order = {body: n for n, body in enumerate([*scene.links])}
    for each in sorted(channels, key=lambda one: (bool(one.relative_to), order.get(one.on, -1))):
        key = (each.kind, each.of, each.on, each.relative_to)
        if key in first:
            raise CrankcheckError(
                f"two columns for one quantity, {each.name}: {first[key].column!r} and "
                f"{each.column!r}; rename one, or say in a map what it is, or ignore = true"
            )
        first[key] = each
        if each.kind.body_kind == "point" and each.of in scene.ground:
            still.append(each)
            continue
        before = next((o for o in main if (o.kind, o.of) == (each.kind, each.of)), None)
        if before is not None and each.kind.body_kind == "point" and each.kind.order == 0:
            copies.append(each)
        else:
            main.append(each)
    place = {each.column: n for n, each in enumerate(channels)}
    return sorted(main, key=lambda one: place[one.column]), copies, still


def blank_map(columns: Columns, scene: Scene, map_: map_file.Map) -> tuple[str, str] | None:
    """Return a form of the map of a log with all its columns, and the entries still missing. None
    where names and map give the times and a column of the scene, as the fault is another one then,
    and where the map names a missing column."""
    told = {one.column: one for one in map_.channel}
    if not {*told, map_.time.column or next(iter(columns.raw))} <= set(columns.raw):
        return None
    left_out = {one.column for one in map_.channel if one.ignore}
    times = {map_.time.column} if map_.time.column else _times(columns.raw, left_out)
    others = [name for name in columns.raw if name not in times]
    bodies = list(filter(_meant(scene, map_), others))
    if times and bodies:
        return None
    lacks = [
        *([] if times else ["the column of the times, in [time]"]),
        *([] if bodies else ["of at least one column what it is of, in a [[channel]]"]),
    ]
    named = SceneNames(scene)
    points = (name for name in scene.pins if name not in scene.ground)
    every = (*scene.links, *points, *scene.sliders)
    lines = [
        *map_file.HEAD,
        f"# Still to be filled in: {'; '.join(lacks)}.",
        f"# The scene has {', '.join(map(map_file.toml_text, dict.fromkeys(every)))}.",
        "",
        *(map_file.file_lines(map_.file) or ["# [file]", '# decimal = ","', ""]),
        *_time_lines(map_, times, columns.raw),
    ]
    for name in others:
        lines.append("")
        if name in told:
            lines += map_file.table_lines("[[channel]]", told[name])
        elif name in bodies:
            lines.append(f"# {map_file.toml_text(name)} is taken as its name says")
        else:
            lines += map_file.form_lines(name, _why_no_meaning(name, named))
    return "\n".join(lines) + "\n", "; ".join(lacks)


def _times(names: Iterable[str], left_out: Iterable[str]) -> set[str]:
    """Return the columns of times by their names; a contradictory name is none."""
    found: set[str] = set()
    for name in set(names).difference(left_out):
        try:
            if time_of(name):
                found.add(name)
        except CrankcheckError:
            continue
    return found


def _time_lines(map_: map_file.Map, times: set[str], names: Iterable[str]) -> Sequence[str]:
    """Return the table of times; with remarks for missing entries."""
    lines = [*map_file.table_lines("[time]", map_.time)]
    if not times:
        lines += [f"# column = {map_file.toml_text(name)}" for name in names]
        lines.append('# unit = "s"')
    return lines


def _why_no_meaning(name: str, named: SceneNames) -> str:
    try:
        found = meaning(name, named)
    except CrankcheckError as error:
        return str(error)
    return found if isinstance(found, str) else "it is of a point of the ground"
