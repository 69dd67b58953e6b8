"""The numbers of columns in SI: of a channel, and of the gaps that a log tells itself."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.laws import MOST_TURNS
from reports.logs.channel import Channel, Gap, Reading
from reports.logs.column_meaning import GapColumn
from reports.logs.columns import Columns
from reports.logs.map_file import ChannelTable
from reports.logs.spelling import DIMENSION
from reports.logs.units import UNITS, si

MOST = 1e15
"""The most of a reading [SI] that is no angle."""
DIGITS = 2e-3
"""What rounding may add to half a turn [rad]: that to 3.142."""


@dataclass(frozen=True)
class Reader:
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


def _refuse_huge(columns: Columns, of: Channel | GapColumn, values: Array) -> None:
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


def gaps_told(columns: Columns, gaps: Iterable[GapColumn]) -> tuple[Gap, ...]:
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
