"""A column of a log with what it means, and its numbers beside what they should be."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene
from reports.compare.beside import Truth
from reports.logs.force_columns import LogForces
from reports.logs.kinds import Kind


@dataclass(frozen=True)
class Channel:
    """What a column says: a kind of reading ``of`` a link, point or slider, in ``unit``.

    A reading in SI is ``sign * (number + offset) * unit``. An angle may be ``wrapped`` into one
    turn, and be ``relative_to`` another link. A point that several bodies share may be that of the
    body ``on``. The numbers belong to ``delay_s`` after the time that the row is stamped with
    (or that stands in the column ``time`` of the same file, where it has several).
    """

    column: str
    kind: Kind
    of: str
    unit: str
    sign: int = 1
    offset: float = 0.0
    wrapped: bool = False
    relative_to: str = ""
    on: str = ""
    delay_s: float = 0.0
    time: str = ""

    @property
    def name(self) -> str:
        """What messages call it: the body and the kind."""
        against = f" relative to {self.relative_to}" if self.relative_to else ""
        on = f" on {self.on}" if self.on else ""
        return f"{self.kind.name} of {self.of}{on}{against}"

    def expected(self, reference: Motion) -> Array:
        """What the reference says (T,) [SI] of that kind, body and, if any, other link."""
        series = self.kind.of(reference, self.of)
        if self.relative_to:
            series = series - self.kind.of(reference, self.relative_to)
        return series

    def error(self, readings: Array, expected: Array) -> Array:
        """Readings less what was expected (T,) [SI]: of a wrapped angle less the nearest whole
        turns at every sample, of another angle less those of the first sample."""
        error = readings - expected
        if not self.kind.turns:
            return error
        turns = np.round((error if self.wrapped else error[:1]) / math.tau)
        return np.asarray(error - math.tau * turns)


@dataclass(frozen=True)
class Reading:
    """The numbers of a channel in SI (T,), and the instants [s] that they belong to (T,)."""

    channel: Channel
    values: Array
    instants: Array

    def first(self, rows: int) -> Reading:
        """That of the first rows alone."""
        return replace(self, values=self.values[:rows], instants=self.instants[:rows])

    def expected(self, truth: Truth) -> Array:
        """What the truth says of it at its instants (T,). Raises CrankcheckError."""
        return self.channel.expected(truth.at(self.instants))

    def error(self, truth: Truth) -> Array:
        """How far it is from that (T,) [SI]."""
        return self.channel.error(self.values, self.expected(truth))


@dataclass(frozen=True)
class Gap:
    """A column that says how far the bodies at a pin or slider are apart: in its ``unit``, and as
    ``opening_m`` (T,)."""

    column: str
    of: str
    unit: str
    opening_m: Array


@dataclass(frozen=True)
class OwnLog:
    """A user's log, as its columns were understood: instants (T,) [s] and one reading a channel.

    ``stamp`` is the column that the instants stand in, and its unit; ``zero_s`` is what was taken
    from its times [s].

    Several ``readings`` may be of one rate of a point, or of one link, each relative to another.
    ``copies`` are readings of a point's place as further bodies have it, which the gap is taken of;
    ``gaps`` are those that the log itself tells. ``unused`` names
    columns that nothing was made of, with the reason. ``forces`` are read where they are asked for.
    ``left_out`` rows after the last were cut off, as the truth of them is not known.
    """

    source: str
    scene: Scene
    time_s: Array
    readings: tuple[Reading, ...]
    stamp: tuple[str, str] = ("", "")
    zero_s: float = 0.0
    copies: tuple[Reading, ...] = ()
    gaps: tuple[Gap, ...] = ()
    unused: tuple[tuple[str, str], ...] = ()
    forces: LogForces | None = None
    left_out: int = 0

    def first(self, rows: int) -> OwnLog:
        """The log with its first rows alone; itself where these are all."""
        if rows >= self.time_s.size:
            return self
        return replace(
            self,
            time_s=self.time_s[:rows],
            readings=tuple(each.first(rows) for each in self.readings),
            copies=tuple(each.first(rows) for each in self.copies),
            gaps=tuple(replace(gap, opening_m=gap.opening_m[:rows]) for gap in self.gaps),
            forces=self.forces and self.forces.first(rows),
            left_out=self.left_out + self.time_s.size - rows,
        )
