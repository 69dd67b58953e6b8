"""Columns become readings: by their names, and by what the user's map says of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few, suggestion
from models.laws import MOST_TURNS
from models.scene import Scene
from reports.logs.channel import Channel, Gap, OwnLog, Reading
from reports.logs.columns import Columns
from reports.logs.instants import instants, refuse_back, refuse_far
from reports.logs.kinds import KINDS
from reports.logs.map_file import LEFT_OUT, ChannelTable, Map
from reports.logs.names import LENGTH, Meaning, Named, meaning, time_of
from reports.logs.spelling import DIMENSION
from reports.logs.units import UNITS, si

MOST = 1e15
"""The most of a reading [SI] that is no angle."""
DIGITS = 2e-3
"""What rounding may add to half a turn [rad]: that to 3.142."""


@dataclass(frozen=True)
class _GapColumn:
    """A column that says how far the bodies at a pin or slider are apart."""

    column: str
    of: str
    unit: str


def understood(columns: Columns, scene: Scene, map_: Map | None = None) -> OwnLog:
    """The log of a scene.

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
    times = _times(columns, map_)
    told = {one.column: one for one in map_.channel}
    _refuse_unknown(told, columns, "[[channel]] column")
    for column in told:
        if column in times.values():
            raise CrankcheckError(
                f"[[channel]] {column!r}: it is the column of times; say of it in [time], or which "
                "other column that is"
            )
    named = Named(scene)
    channels: list[Channel] = []
    gaps: list[_GapColumn] = []
    unused: list[tuple[str, str]] = []
    for column in columns.raw:
        if column in times.values():
            continue
        found = _meaning(column, told.get(column), named, times)
        if isinstance(found, str):
            unused.append((column, found))
        elif isinstance(found, _GapColumn):
            gaps.append(found)
        else:
            channels.append(found)
    channels, lengths = _without_lengths(channels, told)
    unused += lengths
    channels, copies, spare = _slots(channels, scene)
    unused += spare
    if not (channels or gaps):
        in_python = "(in Python: the argument map, with {'channel': [{'column': ...}]})"
        raise CrankcheckError(f"{_nothing(columns, scene, unused)} {in_python}")
    main = times["time"]
    base = instants(columns, main, _unit_of_time(main, map_), holes=map_.file.holes == "meant")
    zero_s = float(base[0]) if map_.time.zero else 0.0
    base = base - zero_s
    refuse_far(columns, main, base, scene)
    others = {c: _stamp(columns, c, zero_s, scene) for c in times.values() if c != main}
    reader = _Reader(columns, base, others)
    return OwnLog(
        source=columns.source,
        scene=scene,
        time_s=base,
        readings=tuple(reader.reading(each, told.get(each.column)) for each in channels),
        stamp=(main, _unit_of_time(main, map_)),
        zero_s=zero_s,
        copies=tuple(reader.reading(each, told.get(each.column)) for each in copies),
        gaps=_gaps(columns, gaps),
        unused=tuple(unused),
    )


def wanted(scene: Scene, map_: Map) -> Callable[[str], bool]:
    """Whether a column of that name is worth reading: others are only named."""
    named = Named(scene)
    told = {one.column: one for one in map_.channel}

    def is_wanted(column: str) -> bool:
        if column in told:
            return not told[column].ignore
        try:
            if column == map_.time.column or time_of(column):
                return True
            found = meaning(column, named)
        except CrankcheckError:
            return True  # a name that contradicts itself, which is told later
        return not isinstance(found, str) and (found.gap or found.of not in scene.ground)

    return is_wanted


@dataclass(frozen=True)
class _Reader:
    """What makes readings of columns: the instants of the rows, and those of other columns."""

    columns: Columns
    time_s: Array
    others: dict[str, Array]

    def reading(self, channel: Channel, told: ChannelTable | None) -> Reading:
        """The numbers of a channel in SI, and their instants."""
        unit = UNITS[channel.kind.dimension][channel.unit]
        raw = self.columns.numbers(channel.column)
        with np.errstate(over="ignore"):  # which is refused
            values = channel.sign * unit * (raw + channel.offset)
        _refuse_huge(self.columns, channel, values)
        if channel.kind.turns:
            wrapped = told.wrapped if told else None
            if wrapped is None:
                wrapped = _is_wrapped(unit * raw)
            channel = replace(channel, wrapped=wrapped)
        own = self.others.get(channel.time, self.time_s)
        if channel.delay_s:
            own = own + channel.delay_s
        return Reading(channel, np.asarray(values), own)


def _refuse_huge(columns: Columns, of: Channel | _GapColumn, values: Array) -> None:
    """Refuse readings [SI] beyond all sense: of an angle its place within a turn would be lost.
    Raises CrankcheckError."""
    angle = isinstance(of, Channel) and of.kind.turns
    most = MOST_TURNS * math.tau if angle else MOST
    row = int(np.argmax(np.abs(values) > most))
    if not abs(values[row]) > most:
        return
    bound = f"{MOST_TURNS:g} turns" if angle else f"{MOST:g} {si(DIMENSION[of.unit])}"
    raise CrankcheckError(
        f"{columns.at(of.column, row)}: found {float(columns.raw[of.column][row]):.6g} {of.unit}; "
        f"readings are at most {bound}: mend the cell, or leave the column out ([[channel]] ignore "
        "= true)"
    )


def _is_wrapped(angle_rad: Array) -> bool:
    """Whether an angle, as it was logged, stays within a turn from -pi or from 0 on, and jumps by
    more than half of one; within another turn it may have lost one."""
    leaps = np.abs(np.diff(angle_rad)) > math.pi
    least, most = float(np.min(angle_rad)), float(np.max(angle_rad))
    within = (low - DIGITS <= least and most <= low + math.tau + DIGITS for low in (-math.pi, 0.0))
    return bool(leaps.any()) and any(within)


def _times(columns: Columns, map_: Map) -> dict[str, str]:
    """The columns of times, by whose they are: those of all rows are called ``time``.

    Raises CrankcheckError for none, and for two.
    """
    found: dict[str, list[str]] = {}
    others = {one.column for one in map_.channel if one.ignore or map_.time.column is not None}
    for column in columns.raw:
        if column not in others and (time := time_of(column, map_.time.unit or "")):
            found.setdefault(time[0], []).append(column)
    if map_.time.column is not None:
        _refuse_unknown([map_.time.column], columns, "[time] column")
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


def _unit_of_time(column: str, map_: Map) -> str:
    """The unit of the times of all rows."""
    told = time_of(column, map_.time.unit or "")
    return map_.time.unit or (told[1] if told else si("time"))


def _stamp(columns: Columns, column: str, zero_s: float, scene: Scene) -> Array:
    """The instants in a further column of times [s]. Raises CrankcheckError for those that go back,
    and for some that are far from the start."""
    told = time_of(column)
    time_s = columns.numbers(column) * UNITS["time"][told[1] if told else si("time")]
    refuse_back(columns, column, time_s)
    refuse_far(columns, column, time_s - zero_s, scene)
    return np.asarray(time_s - zero_s)


def _meaning(
    column: str, told: ChannelTable | None, named: Named, times: dict[str, str]
) -> Channel | _GapColumn | str:
    """What a column is, or why nothing is made of it. Raises CrankcheckError."""
    if told and told.ignore:
        return LEFT_OUT
    if told is None or told.of is None or told.kind is None:
        found = meaning(column, named, told.unit or "" if told else "")
        if isinstance(found, str):
            if told is None:
                return found
            if told.of is None or told.kind is None:
                raise CrankcheckError(
                    f"[[channel]] {column!r}: add of, kind and unit, as the name does not say "
                    f"them: {found}"
                )
            found = Meaning("", None, False, "")
    else:
        found = Meaning(told.of, None, told.kind == "gap", "")
    return _channel(column, told, found, named, times)


def _channel(
    column: str,
    told: ChannelTable | None,
    found: Meaning,
    named: Named,
    times: dict[str, str],
) -> Channel | _GapColumn:
    """A channel of what the name says and the map corrects. Raises CrankcheckError."""
    told = told or ChannelTable.model_construct(column=column)
    where = f"[[channel]] {column!r}"
    of = told.of or found.of
    kinds = named.kinds_of(of)
    if not kinds:
        hint = suggestion(of, [n for n in named.bodies if n != "ground"], "the scene has")
        raise CrankcheckError(f"{where}, of: {of!r} is not in scene {named.scene.name}; {hint}")
    if (told.kind or ("gap" if found.gap else "")) == "gap":
        return _GapColumn(column, of, told.unit or found.unit or "m")
    if told.kind is not None:
        kind = next((KINDS[k, told.kind] for k in kinds if (k, told.kind) in KINDS), None)
    else:
        kind = found.kind
    if kind is None or kind.body_kind not in kinds:
        have = ", ".join(name for k, name in KINDS if k in kinds)
        asked = f"{told.kind!r} is no kind of reading of" if told.kind else "none for"
        raise CrankcheckError(f"{where}, kind: {asked} {' and '.join(kinds)} {of}; use {have}")
    unit = told.unit or found.unit or si(kind.dimension)
    if DIMENSION[unit] != kind.dimension:
        raise CrankcheckError(
            f"{where}, unit: {unit} is a unit of {DIMENSION[unit]}, and {kind.name} is "
            f"{kind.dimension}; use one of {', '.join(UNITS[kind.dimension])}"
        )
    relative_to = found.relative_to if told.relative_to is None else told.relative_to
    relative_to = "" if relative_to == "ground" else relative_to
    on = found.on if told.on is None else told.on
    _check_roles(where, named.scene, kind.body_kind, of, relative_to, on)
    whose = ("", "velocity time", "acceleration time")[kind.order]
    time = told.time or times.get(whose, "")
    if told.time is not None and told.time not in times.values():
        hint = suggestion(told.time, times.values(), "columns of times are")
        raise CrankcheckError(f"{where}, time: {told.time!r} is no column of times; {hint}")
    return Channel(
        column,
        kind,
        of,
        unit,
        told.sign,
        told.offset,
        relative_to=relative_to,
        on=on,
        delay_s=told.delay_s,
        time=time if time != times["time"] else "",
    )


def _check_roles(
    where: str, scene: Scene, body_kind: str, of: str, relative_to: str, on: str
) -> None:
    """Refuse another link, or a body of a point, that is not there. Raises CrankcheckError."""
    if relative_to and (body_kind != "link" or relative_to not in scene.links or relative_to == of):
        others = [name for name in scene.links if name != of]
        hint = suggestion(relative_to, others, "use one of")
        raise CrankcheckError(
            f"{where}, relative_to: {relative_to!r}; an angle, or a rate of it, of a link is "
            f"relative to another link: {hint}"
        )
    bodies = scene.pins.get(of, ())
    if on and on not in bodies:
        raise CrankcheckError(
            f"{where}, on: {on!r} does not carry {of}; {of} is on {', '.join(bodies) or 'no link'}"
        )


def _without_lengths(
    channels: Sequence[Channel], told: Container[str]
) -> tuple[list[Channel], list[tuple[str, str]]]:
    """The channels without lengths of vectors, which are those that a map does not tell of, of a
    slider's point whose components are there, beside the slider's own."""
    parts = {(each.of, each.kind.order) for each in channels if each.kind.body_kind == "point"}
    sliders = [each for each in channels if each.kind.body_kind == "slider"]
    own = {(each.of, each.kind.order) for each in sliders if "slider" in each.column.lower()}
    lengths = [
        each
        for each in sliders
        if "slider" not in each.column.lower()
        and each.column not in told
        and (each.of, each.kind.order) in parts & own
    ]
    kept = [each for each in channels if each not in lengths]
    return kept, [(each.column, LENGTH) for each in lengths]


def _slots(
    channels: Sequence[Channel], scene: Scene
) -> tuple[list[Channel], list[Channel], list[tuple[str, str]]]:
    """The channels to be judged, those of further copies of a point's place, which a gap is taken
    of, and what is not judged with the reason. Raises CrankcheckError for two columns of one
    quantity."""
    first: dict[tuple[object, ...], Channel] = {}
    main: list[Channel] = []
    copies: list[Channel] = []
    spare: list[tuple[str, str]] = []
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
            spare.append((each.column, "it is of a point of the ground, which does not move"))
            continue
        before = next((o for o in main if (o.kind, o.of) == (each.kind, each.of)), None)
        if before is not None and each.kind.body_kind == "point" and each.kind.order == 0:
            copies.append(each)
        else:
            main.append(each)
    place = {each.column: n for n, each in enumerate(channels)}
    return sorted(main, key=lambda one: place[one.column]), copies, spare


def _gaps(columns: Columns, gaps: Iterable[_GapColumn]) -> tuple[Gap, ...]:
    """The gaps that a log tells itself. Raises CrankcheckError for two of one pin."""
    found: list[Gap] = []
    for gap in gaps:
        if gap.of in {each.of for each in found}:
            raise CrankcheckError(
                f"two columns for one quantity, the gap of {gap.of}; rename one, or ignore = true"
            )
        if DIMENSION[gap.unit] != "length":
            raise CrankcheckError(f"column {gap.column!r}: {gap.unit} is no unit of length")
        opening = np.abs(columns.numbers(gap.column) * UNITS["length"][gap.unit])
        _refuse_huge(columns, gap, opening)
        found.append(Gap(gap.column, gap.of, gap.unit, opening))
    return tuple(found)


def _refuse_unknown(asked: Iterable[str], columns: Columns, where: str) -> None:
    """Refuse columns that the log has not. Raises CrankcheckError."""
    for column in asked:
        if column not in columns.raw:
            hint = suggestion(column, columns.raw, "it has") if len(columns.raw) < 40 else ""
            raise CrankcheckError(
                f"{where}: {cut(column)!r} is not in {columns.source}; {hint or 'see its header'}"
            )


def _nothing(columns: Columns, scene: Scene, unused: Sequence[tuple[str, str]]) -> str:
    """The message of a log in which nothing is of the scene."""
    bodies = few([*scene.links, *scene.pins, *scene.sliders], 12)
    why = f" ({cut(unused[0][0])!r}: {unused[0][1]})" if unused else ""
    return (
        f"{columns.source}: no column is of scene {scene.name}, which has {bodies}; found "
        f"{few(map(cut, columns.raw), 8)}{why}; name columns such as "
        f"{scene.driver.link}_deg, or write a map: --write-map map.toml"
    )
