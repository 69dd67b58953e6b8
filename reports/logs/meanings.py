"""Conversion of columns to readings, by their names and the map; and the map that says it."""

from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from pathlib import Path

import numpy as np

from models.errors import CrankcheckError, cut, few
from models.files.assemble import toml_value
from models.scene import Scene
from reports.logs import column_meaning, instants, map_file
from reports.logs.channel import Channel, GapColumn, OwnLog, Reading
from reports.logs.columns import Columns, read_columns
from reports.logs.force_columns import TIMES, beside_forces, log_forces, names_force, why_not_judged
from reports.logs.names import SceneNames, is_named, meaning


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
    times = instants.time_columns(columns, map_)
    told = {one.column: one for one in map_.channel}
    columns.require(told, "[[channel]] column")
    for column in told:
        if column in times.values():
            raise CrankcheckError(
                f"[[channel]] {column!r}: it is the column of times; describe it, or name "
                "another, in [time]"
            )
    borne = {name for name in columns.raw if forces and names_force(name, scene)}
    named = SceneNames(scene)
    meant = {
        column: column_meaning.of_column(column, told.get(column), named, times)
        for column in columns.raw
        if column not in borne and column not in times.values()
    }
    gaps = [each for each in meant.values() if isinstance(each, GapColumn)]
    unused = [
        (column, why if why == map_file.LEFT_OUT else why_not_judged(column, scene) or why)
        for column, why in meant.items()
        if isinstance(why, str)
    ]
    channels = [each for each in meant.values() if isinstance(each, Channel)]
    channels = column_meaning.sized_channels(channels, columns, told, scene.sliders)
    channels, copies, still = judged_channels(channels, scene)
    unjudged = column_meaning.unjudged_columns(columns, unused, named)
    unused += [(each.column, STILL) for each in still]
    if not (channels or gaps or borne):
        in_python = "(in Python: the argument map, with {'channel': [{'column': ...}]})"
        raise CrankcheckError(f"{_nothing_found_text(columns, scene, unused)} {in_python}")
    main, unit, zero_s = times["time"], "", Decimal(0)
    further = {c for c in times.values() if c != main}
    if main:
        base, unit, zero_s = instants.of_rows(columns, main, map_, scene)
    else:
        others = {name for name, reason in unused if reason != map_file.LEFT_OUT} | {*further}
        others -= {name for name, _ in unjudged}  # which are refused themselves
        angle = instants.driver_channel(columns, scene, channels, others, forces=bool(borne))
        crank = column_meaning.reading(columns, angle, told.get(angle.column), np.empty(0))
        base = instants.turning_s(crank, scene)
    apart = {name: instants.further(columns, name, zero_s, scene) for name in further}

    def reading(of: Channel) -> Reading:
        at = apart.get(of.time, base)
        return column_meaning.reading(columns, of, told.get(of.column), at)

    ignored = {column for column, one in told.items() if one.ignore}
    acts = instants.further(columns, TIMES, zero_s, scene) if TIMES in borne else None
    return OwnLog(
        source=columns.source,
        scene=scene,
        time_s=base,
        readings=tuple(map(reading, channels)),
        stamp=(main, unit),
        zero_s=float(zero_s),
        timed=bool(main),
        copies=tuple(map(reading, copies)),
        gaps=column_meaning.gaps_told(columns, gaps),
        still=tuple(map(reading, still)),
        unused=tuple(unused),
        unjudged=unjudged,
        besides=beside_forces(columns, unjudged) if forces else {},
        forces=log_forces(columns, scene, base, acts, ignored) if forces else None,
    )


STILL = "it belongs to a point of the ground, which does not move"


def wanted(scene: Scene, map_: map_file.Map, *, forces: bool = False) -> Callable[[str], bool]:
    """Return a test of the names of columns that are worth reading: others are only named."""
    is_meant, named = _meant(scene, map_, forces=forces), SceneNames(scene)
    ignored = {one.column for one in map_.channel if one.ignore}
    return lambda column: is_meant(column) or (column not in ignored and is_named(column, named))


def columns_worth(path: Path, scene: Scene, map_: map_file.Map, *, forces: bool = False) -> Columns:
    """Return the columns of a file that are worth reading; of one without times all, as one of them
    may be the times. Raises CrankcheckError."""
    columns = read_columns(path, map_.file, wanted(scene, map_, forces=forces))
    ignored = {one.column for one in map_.channel if one.ignore}
    if map_.time.column or _times(columns.raw, ignored):
        return columns
    return read_columns(path, map_.file, lambda name: name not in ignored)


def _meant(scene: Scene, map_: map_file.Map, *, forces: bool = False) -> Callable[[str], bool]:
    """Return a test of the names of columns with a meaning, but of points of the ground."""
    named = SceneNames(scene)
    told = {one.column: one for one in map_.channel}
    clocks = {map_.time.column, *(one.time for one in map_.channel)}

    def is_wanted(column: str) -> bool:
        if column in clocks:
            return True
        if column in told:
            return not told[column].ignore
        if forces and names_force(column, scene):
            return True
        try:
            if instants.time_of(column):
                return True
            found = meaning(column, named)
        except CrankcheckError:
            return True  # a name that contradicts itself, reported later
        return not isinstance(found, str) and (found.gap or found.of not in scene.ground)

    return is_wanted


def _nothing_found_text(columns: Columns, scene: Scene, unused: Sequence[tuple[str, str]]) -> str:
    bodies = few([*scene.links, *scene.pins, *scene.sliders], 12)
    why = f" ({cut(unused[0][0])!r}: {unused[0][1]})" if unused else ""
    return (
        f"{columns.source}: no column belongs to scene {scene.name}, which has {bodies}; found "
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
    main, copies, still = list[Channel](), list[Channel](), list[Channel]()
    order = {body: n for n, body in enumerate([*scene.links])}
    for each in sorted(channels, key=lambda one: (bool(one.relative_to), order.get(one.on, -1))):
        key = (each.kind, each.of, each.on, each.relative_to)
        if key in first:
            raise CrankcheckError(
                f"two columns for one quantity, {each.name}: {first[key].column!r} and "
                f"{each.column!r}; rename one, or give its meaning in a map, or ignore = true"
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


def map_text(log: OwnLog, file: map_file.FileTable) -> str:
    """Return the map of a log as understood, with the other columns as remarks, and the entries of
    the original map on the file."""
    lines = [*map_file.HEAD, "", *map_file.file_lines(file)]
    if log.timed:
        lines += ["[time]", *map_file.entries({"column": log.stamp[0], "unit": log.stamp[1]})]
    if log.zero_s:
        lines.append('zero = "first"')
    for reading in (*log.readings, *log.copies):
        lines += ["", "[[channel]]", *_channel_lines(reading.channel)]
    for gap in log.gaps:
        told = {"column": gap.column, "of": gap.of, "kind": "gap", "unit": gap.unit}
        lines += ["", "[[channel]]", *map_file.entries(told)]
    for column, reason in log.unused:
        ignored = ["[[channel]]", *map_file.entries({"column": column, "ignore": True})]
        left_out = reason == map_file.LEFT_OUT
        lines += ["", *(ignored if left_out else map_file.form_lines(column, reason))]
    return "\n".join(lines) + "\n"


def _channel_lines(channel: Channel) -> Sequence[str]:
    """Return a channel as lines of TOML, without defaults."""
    told = {name: getattr(channel, name) for name in ("column", "of", "kind", "unit")}
    told["kind"] = channel.kind.name
    plain = Channel(channel.column, channel.kind, channel.of, channel.unit)
    for name in ("sign", "offset", "wrapped", "relative_to", "on", "time", "delay_s"):
        value = getattr(channel, name)
        if value != getattr(plain, name) or (name == "wrapped" and channel.kind.turns):
            told[name] = value
    return map_file.entries(told)


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
    angle = f', or of = "{scene.driver.link}" and kind = "angle" in a [[channel]]'
    angle *= scene.driver.is_crank and not scene.is_free
    lacks = [
        *([] if times else [f"the column of the times, in [time]{angle}"]),
        *([] if bodies else ["the body of at least one column, in a [[channel]]"]),
    ]
    named = SceneNames(scene)
    points = (name for name in scene.pins if name not in scene.ground)
    every = (*scene.links, *points, *scene.sliders)
    lines = [
        *map_file.HEAD,
        f"# Still to be filled in: {'; '.join(lacks)}.",
        f"# The scene has {', '.join(map(toml_value, dict.fromkeys(every)))}.",
        "",
        *(map_file.file_lines(map_.file) or ["# [file]", '# decimal = ","', ""]),
        *map_file.table_lines("[time]", map_.time),
    ]
    if not times:
        lines += [f"# column = {toml_value(name)}" for name in columns.raw]
        lines.append('# unit = "s"')
    for name in others:
        lines.append("")
        if name in told:
            lines += map_file.table_lines("[[channel]]", told[name])
        elif name in bodies:
            lines.append(f"# {toml_value(name)} is read by its name")
        else:
            lines += map_file.form_lines(name, _why_no_meaning(name, named))
    return "\n".join(lines) + "\n", "; ".join(lacks)


def _times(names: Iterable[str], left_out: Iterable[str]) -> set[str]:
    """Return the columns of times by their names; a contradictory name is none."""
    found: set[str] = set()
    for name in set(names).difference(left_out):
        try:
            if instants.time_of(name):
                found.add(name)
        except CrankcheckError:
            continue
    return found


def _why_no_meaning(name: str, named: SceneNames) -> str:
    try:
        found = meaning(name, named)
    except CrankcheckError as error:
        return str(error)
    return found if isinstance(found, str) else "it belongs to a point of the ground"
