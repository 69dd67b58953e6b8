"""Conversion of columns to readings, by their names and the map; and the columns of times."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from reports.logs import instants, map_file
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
from reports.logs.columns import ONE_FILE, Columns
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
    """Return the columns of times, by kind: that of all rows is ``time``, "" for none. Raises
    CrankcheckError for two."""
    found: dict[str, list[str]] = {}
    others = {one.column for one in map_.channel if one.ignore or map_.time.column is not None}
    for column in columns.raw:
        if column not in others and (time := time_of(column, map_.time.unit or "")):
            found.setdefault(time[0], []).append(column)
    if map_.time.column is not None:
        columns.require([map_.time.column], "[time] column")
        found["time"] = [map_.time.column]
    for whose, several in found.items():
        if len(several) > 1:
            raise CrankcheckError(
                f"{columns.source}: two columns of times, {several[0]!r} and {several[1]!r}; say "
                "which in [time] of a map, and ignore the other, or say time in the [[channel]] of "
                f"columns that go by it; of two rates, {ONE_FILE}"
                if whose == "time"
                else f"{columns.source}: two columns for {whose}: {', '.join(several[:2])}"
            )
    clocks = (one.time or "" for one in map_.channel if one.time in columns.raw)
    further = {f"clock {name}": name for name in clocks if instants.may_be_times(name)}
    return {"time": "", **{whose: several[0] for whose, several in found.items()}, **further}


def unit_of_time(column: str, map_: Map) -> str:
    """Return the unit of the times of all rows."""
    told = time_of(column, map_.time.unit or "")
    return map_.time.unit or (told[1] if told else instants.unit_named(column) or si("time"))


def further_instants(columns: Columns, column: str, zero_s: Decimal, scene: Scene) -> Array:
    """Return the instants in a further column of times, after ``zero_s`` [s]. Raises
    CrankcheckError for times that go back, or far from the start."""
    told = time_of(column)
    unit = told[1] if told else instants.unit_named(column) or si("time")
    time_s = instants.seconds(columns, column, unit, zero_s)
    instants.refuse_back(columns, column, time_s)
    instants.refuse_far(columns, column, time_s, scene)
    return time_s


def understood(
    columns: Columns, scene: Scene, map_: map_file.Map | None = None, *, forces: bool = False
) -> OwnLog:
    """Return the log of a scene, with its ``forces`` on request; meanings of columns by the user's
    map replace those by their names.

    Raises CrankcheckError for no column of times, or one that goes back (a log with the driver's
    angle needs none, `driver_channel`); no column of the scene; two columns for one quantity; units
    that contradict their kind; cells that are no numbers; a map with unknown names.
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
    main, unit, zero_s = times["time"], "", Decimal(0)
    further = {c for c in times.values() if c != main}
    if main:
        unit = unit_of_time(main, map_)
        if map_.time.zero and columns.numbers(main).size:
            zero_s = columns.exact(main, 0) * Decimal(str(UNITS["time"][unit]))
        base = instants.of_rows(columns, main, unit, zero_s, holes=map_.file.holes == "meant")
        instants.refuse_far(columns, main, base, scene)
    else:
        others = {name for name, reason in unused if reason != map_file.LEFT_OUT} | {*further}
        angle = instants.driver_channel(columns, scene, channels, others, forces=bool(borne))
        base = instants.turning_s(
            reading(columns, angle, told.get(angle.column), np.empty(0)), scene
        )
    apart = {name: further_instants(columns, name, zero_s, scene) for name in further}

    def readings(some: Sequence[Channel]) -> tuple[Reading, ...]:
        return tuple(
            reading(columns, each, told.get(each.column), apart.get(each.time, base))
            for each in some
        )

    ignored = {column for column, one in told.items() if one.ignore}
    acts = further_instants(columns, TIMES, zero_s, scene) if TIMES in borne else None
    return OwnLog(
        source=columns.source,
        scene=scene,
        time_s=base,
        readings=readings(channels),
        stamp=(main, unit),
        zero_s=float(zero_s),
        timed=bool(main),
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
