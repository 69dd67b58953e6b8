"""Columns become readings: by their names, and by what the user's map says of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from reports.logs.channel import Channel, OwnLog
from reports.logs.column_meaning import GapColumn, column_meaning
from reports.logs.columns import Columns
from reports.logs.force_columns import log_forces
from reports.logs.force_names import TIMES, names_force, why_not_judged
from reports.logs.instants import instants, refuse_far
from reports.logs.judged_channels import judged_channels, without_lengths
from reports.logs.map_file import LEFT_OUT, ChannelTable, Map
from reports.logs.names import meaning
from reports.logs.readings import Reader, gaps_told
from reports.logs.scene_names import SceneNames
from reports.logs.time_columns import further_instants, time_columns, time_of, unit_of_time

A_FORCE = "a force, which is judged with --forces"


def understood(
    columns: Columns, scene: Scene, map_: Map | None = None, *, forces: bool = False
) -> OwnLog:
    """The log of a scene, its ``forces`` as well where that is asked.

    Parameters
    ----------
    columns : Columns
        What stands in the file.
    map_ : Map or None
        What the user says of columns, in place of their names.

    Raises
    ------
    CrankcheckError
        No column of times, or one that goes back; nothing that is of the scene; two columns for one
        quantity; units that contradict their kind; cells that are no numbers; a map that names what
        is not there.
    """
    map_ = map_ or Map()
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
    channels, lengths = without_lengths(channels, told)
    unused += lengths
    channels, copies, spare = judged_channels(channels, scene)
    unused += spare
    if not (channels or gaps or borne):
        in_python = "(in Python: the argument map, with {'channel': [{'column': ...}]})"
        raise CrankcheckError(f"{_nothing(columns, scene, unused)} {in_python}")
    main = times["time"]
    base = instants(columns, main, unit_of_time(main, map_), holes=map_.file.holes == "meant")
    zero_s = float(base[0]) if map_.time.zero else 0.0
    base = base - zero_s
    refuse_far(columns, main, base, scene)
    others = {c: further_instants(columns, c, zero_s, scene) for c in times.values() if c != main}
    reader = Reader(columns, base, others)
    ignored = {column for column, one in told.items() if one.ignore}
    acts = further_instants(columns, TIMES, zero_s, scene) if TIMES in borne else None
    return OwnLog(
        source=columns.source,
        scene=scene,
        time_s=base,
        readings=tuple(reader.reading(each, told.get(each.column)) for each in channels),
        stamp=(main, unit_of_time(main, map_)),
        zero_s=zero_s,
        copies=tuple(reader.reading(each, told.get(each.column)) for each in copies),
        gaps=gaps_told(columns, gaps),
        unused=tuple(unused),
        forces=log_forces(columns, scene, base, acts, ignored) if forces else None,
    )


def wanted(scene: Scene, map_: Map, *, forces: bool = False) -> Callable[[str], bool]:
    """Whether a column of that name is worth reading: others are only named."""
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
            return True  # a name that contradicts itself, which is told later
        return not isinstance(found, str) and (found.gap or found.of not in scene.ground)

    return is_wanted


def _by_meaning(
    columns: Columns, scene: Scene, told: Mapping[str, ChannelTable], times: Mapping[str, str]
) -> tuple[list[Channel], list[GapColumn], list[tuple[str, str]]]:
    """The columns that are of the scene, and the others with the reason. Raises CrankcheckError."""
    named = SceneNames(scene)
    channels: list[Channel] = []
    gaps: list[GapColumn] = []
    unused: list[tuple[str, str]] = []
    for column in columns.raw:
        if column in times.values():
            continue
        found = column_meaning(column, told.get(column), named, times)
        if isinstance(found, str):
            told_so = A_FORCE if names_force(column, scene) else why_not_judged(column, scene)
            unused.append((column, found if found == LEFT_OUT else told_so or found))
        elif isinstance(found, GapColumn):
            gaps.append(found)
        else:
            channels.append(found)
    return channels, gaps, unused


def _nothing(columns: Columns, scene: Scene, unused: Sequence[tuple[str, str]]) -> str:
    """The message of a log in which nothing is of the scene."""
    bodies = few([*scene.links, *scene.pins, *scene.sliders], 12)
    why = f" ({cut(unused[0][0])!r}: {unused[0][1]})" if unused else ""
    return (
        f"{columns.source}: no column is of scene {scene.name}, which has {bodies}; found "
        f"{few(map(cut, columns.raw), 8)}{why}; name columns such as "
        f"{next(iter(scene.links))}_deg, or write a map: --write-map map.toml"
    )
