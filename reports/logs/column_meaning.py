"""Meaning of a column: by its name, corrected by the map; and its numbers in SI."""

import math
import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, suggestion
from models.scene import Scene
from models.scene.laws import MOST_TURNS
from reports.logs.channel import Channel, Gap, GapColumn, Reading
from reports.logs.columns import Columns
from reports.logs.kinds import DIMENSION, KINDS, TYPICAL, UNITS, Meaning, si
from reports.logs.map_file import LEFT_OUT, ChannelTable
from reports.logs.names import OUT_OF_PLANE, SceneNames, is_named, meaning
from reports.logs.text_lines import is_number


def of_column(
    column: str, told: ChannelTable | None, named: SceneNames, times: Mapping[str, str]
) -> Channel | GapColumn | str:
    """Return the meaning of a column, or the reason for none. Raises CrankcheckError."""
    if told and told.ignore:
        return LEFT_OUT
    where = f"[[channel]] {column!r}"
    found: Meaning | str = Meaning("", None, False, "")
    if told is None or told.of is None or told.kind is None:
        found = meaning(column, named, told.unit or "" if told else "")
    if isinstance(found, str):
        if told is None:
            return found
        raise CrankcheckError(
            f"{where}: add of, kind and unit, which the name does not state: {found}"
        )
    told = told or ChannelTable.model_construct(column=column)
    of = told.of or found.of
    kinds = named.kinds_of(of)
    if not kinds:
        hint = suggestion(of, [n for n in named.bodies if n != "ground"], "the scene has")
        raise CrankcheckError(f"{where}, of: {of!r} is not in scene {named.scene.name}; {hint}")
    if (told.kind or ("gap" if found.gap else "")) == "gap":
        return GapColumn(column, of, told.unit or found.unit or "m")
    kind = found.kind
    if told.kind is not None:
        kind = next((KINDS[k, told.kind] for k in kinds if (k, told.kind) in KINDS), None)
    if kind is None or kind.body_kind not in kinds:
        have = ", ".join(name for k, name in KINDS if k in kinds)
        asked = f"{told.kind!r} is not a kind of reading of" if told.kind else "none for"
        raise CrankcheckError(f"{where}, kind: {asked} {' and '.join(kinds)} {of}; use {have}")
    unit = told.unit or found.unit or si(kind.dimension)
    if DIMENSION[unit] != kind.dimension:
        raise CrankcheckError(
            f"{where}, unit: {unit} is a unit of {DIMENSION[unit]}, and {kind.name} is "
            f"{kind.dimension}; use one of {', '.join(TYPICAL[kind.dimension])}"
        )
    relative_to = found.relative_to if told.relative_to is None else told.relative_to
    relative_to = "" if relative_to == "ground" else relative_to
    on = found.on if told.on is None else told.on
    _check_roles(where, named.scene, kind.body_kind, of, relative_to, on)
    whose = ("", "velocity time", "acceleration time")[kind.order]
    time = told.time or times.get(whose, "")
    if told.time is not None and told.time not in times.values():
        hint = suggestion(told.time, times.values(), "columns of times are")
        raise CrankcheckError(f"{where}, time: {told.time!r} is not a column of times; {hint}")
    time = time if time != times["time"] else ""
    plain = Channel(column, kind, of, unit, told.sign, told.offset)
    return replace(plain, relative_to=relative_to, on=on, delay_s=told.delay_s, time=time)


def _check_roles(
    where: str, scene: Scene, body_kind: str, of: str, relative_to: str, on: str
) -> None:
    if relative_to and (body_kind != "link" or relative_to not in scene.links or relative_to == of):
        others = [name for name in scene.links if name != of]
        hint = suggestion(relative_to, others, "use one of")
        raise CrankcheckError(
            f"{where}, relative_to: {relative_to!r}; only the angle of a link, or its rate, is "
            f"relative to another link: {hint}"
        )
    bodies = scene.pins.get(of, ())
    if on and on not in bodies:
        raise CrankcheckError(
            f"{where}, on: {on!r} does not carry {of}; {of} is on {', '.join(bodies) or 'no link'}"
        )


def sized_channels(
    channels: Sequence[Channel], columns: Columns, told: Container[str], sliding: Container[str]
) -> list[Channel]:
    """Return the channels, those of a slider and its point by their numbers: a rate of the slider
    that is logged besides as one is the size of the point's, and a size is never negative."""
    parts = {(each.of, each.kind.order) for each in channels if each.kind.axis is not None}
    sliders = [each for each in channels if each.kind.body_kind == "slider"]
    own = {(each.of, each.kind.order) for each in sliders if "slider" in each.column.lower()}

    def corrected(each: Channel) -> Channel:
        place, rate = (each.of, each.kind.order), each.kind.order - 1
        if each.column in told or rate < 0:
            return each
        if each in sliders and "slider" not in each.column.lower() and place in parts & own:
            return replace(each, kind=KINDS["point", "va"[rate]])
        slides = each.kind.is_size and each.of in sliding
        if slides and np.min(columns.numbers(each.column)) < 0.0:
            return replace(each, kind=KINDS["slider", ("speed", "acceleration")[rate]])
        return each

    return [corrected(each) for each in channels]


FLAT = 1e-9
"""Change by rounding of a component out of the plane, in its own unit."""


LOOKED_AT = 10_000
"""Rows in which the numbers of a column are searched."""
WITH_UNIT = re.compile(
    r"[-+]?(\d+[.,]?\d*|[.,]\d+)(e[-+]?\d+)?\s*([^\W\d]|[°%/*·^²])+(-?[12])?", re.I
)
"""A number with a unit behind it: 218.7 deg."""


def has_numbers(cells: Sequence[object]) -> bool:
    """True if some cell is a finite number, with or without a unit; truths are none."""
    values = np.asarray(cells[:LOOKED_AT])
    if values.dtype.kind in "iuf":
        return bool(np.isfinite(values).any())
    return any(
        is_number(cell.strip()) or bool(WITH_UNIT.fullmatch(cell.strip()))
        if isinstance(cell, str)
        else _is_finite(cell)
        for cell in values.tolist()
    )


def _is_finite(cell: object) -> bool:
    return isinstance(cell, int | float) and not isinstance(cell, bool) and math.isfinite(cell)


def unjudged_columns(
    columns: Columns, unused: Iterable[tuple[str, str]], named: SceneNames
) -> tuple[tuple[str, str], ...]:
    """Return the unused columns with numbers that name a body or a known quantity; none that the
    map ignores, or that stays the same where it is out of the plane."""
    return tuple(
        (column, why)
        for column, why in unused
        if why != LEFT_OUT
        and is_named(column, named)
        and has_numbers(columns.raw[column])
        and not (why == OUT_OF_PLANE and np.ptp(columns.numbers(column)) <= FLAT)
    )


MOST = 1e15
"""Largest magnitude of a reading [SI] that is no angle."""
DIGITS = 2e-3
"""Largest excess over half a turn by rounding [rad]: that of 3.142."""


def reading(
    columns: Columns, channel: Channel, told: ChannelTable | None, instants: Array
) -> Reading:
    """Return the numbers of a channel in SI, at ``instants`` [s] but for its delay."""
    unit = UNITS[channel.kind.dimension][channel.unit]
    raw = columns.numbers(channel.column)
    with np.errstate(over="ignore"):  # which is refused
        values = channel.sign * unit * (raw + channel.offset)
    _refuse_huge(columns, channel, values)
    if channel.kind.turns:
        wrapped = told.wrapped if told else None
        if wrapped is None:
            wrapped = _is_wrapped(unit * raw)
        channel = replace(channel, wrapped=wrapped)
    if channel.delay_s:
        instants = instants + channel.delay_s
    return Reading(channel, np.asarray(values), instants)


def _refuse_huge(columns: Columns, of: Channel | GapColumn, values: Array) -> None:
    """Refuse absurd readings [SI], whose place in a turn is lost. Raises CrankcheckError."""
    angle = isinstance(of, Channel) and of.kind.turns
    most = MOST_TURNS * math.tau if angle else MOST
    row = int(np.argmax(np.abs(values) > most))
    if not abs(values[row]) > most:
        return
    bound = f"{MOST_TURNS:g} turns" if angle else f"{MOST:g} {si(DIMENSION[of.unit])}"
    raise CrankcheckError(
        f"{columns.at(of.column, row)}: found {float(columns.raw[of.column][row]):.6g} "
        f"{of.unit}; readings are at most {bound}: correct the cell, or leave the column out "
        "([[channel]] ignore = true)"
    )


def _is_wrapped(angle_rad: Array) -> bool:
    """True if an angle, as logged, stays within a turn from -pi or from 0 on, and jumps by more
    than half of one; within another turn it may have lost one."""
    leaps = np.abs(np.diff(angle_rad)) > math.pi
    least, most = float(np.min(angle_rad)), float(np.max(angle_rad))
    within = (low - DIGITS <= least and most <= low + math.tau + DIGITS for low in (-math.pi, 0.0))
    return bool(leaps.any()) and any(within)


def gaps_told(columns: Columns, gaps: Iterable[GapColumn]) -> tuple[Gap, ...]:
    """Return the logged gaps. Raises CrankcheckError for two of one pin."""
    found: list[Gap] = []
    for gap in gaps:
        if gap.of in {each.of for each in found}:
            raise CrankcheckError(
                f"two columns for one quantity, the gap of {gap.of}; rename one, or ignore = true"
            )
        if DIMENSION[gap.unit] != "length":
            raise CrankcheckError(f"column {gap.column!r}: {gap.unit} is not a unit of length")
        opening = np.abs(columns.numbers(gap.column) * UNITS["length"][gap.unit])
        _refuse_huge(columns, gap, opening)
        found.append(Gap(**vars(gap), opening_m=opening))
    return tuple(found)
