"""A column of a log with what it means, and its numbers beside what they should be."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from models.array import Array
from models.motion import ElasticMotion, LinkMotion, Motion, Order, PointMotion, SliderMotion
from models.scene import Scene
from reports.compare.beside import Truth
from reports.logs.force_columns import LogForces
from reports.logs.kinds import Kind

Moved = TypeVar("Moved", LinkMotion, PointMotion, SliderMotion, ElasticMotion)


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


def logged_motion(
    log: OwnLog,
    truth_of: Callable[[Order], Motion],
    error_of: Callable[[Reading], Array],
    orders: Sequence[Order] = (0, 1, 2),
) -> Motion:
    """What a log says of places, or of rates of some ``orders``, as a motion; the rest is NaN.

    ``truth_of`` gives the truth at the instants of an order, ``error_of`` what a reading is off by
    it: of a point of which the log has one coordinate, the other is right.
    """
    bodies: dict[str, dict[str, dict[str, Array]]]
    bodies = {"links": {}, "points": {}, "sliders": {}, "elastic": {}}
    for (kind, body), several in _slots(log).items():
        if kind.order not in orders:
            continue
        right = kind.of(truth_of(kind.order), body)
        wrong = _largest([error_of(reading) for reading in several], kind.order)
        fields = bodies[kind.bodies].setdefault(body, {})
        if kind.axis is None:
            fields[kind.field] = right + wrong
            continue
        if kind.field not in fields:
            motion = truth_of(kind.order).points[body]
            fields[kind.field] = getattr(motion, kind.field).copy()
        fields[kind.field][:, kind.axis] += wrong
    return _as_motion(log.time_s, bodies)


def _slots(log: OwnLog) -> dict[tuple[Kind, str], list[Reading]]:
    """The readings by what of a motion they are of: one, but for rates of a point on several
    bodies, and for angles of a link that are relative to others as well."""
    slots: dict[tuple[Kind, str], list[Reading]] = {}
    for reading in log.readings:
        slots.setdefault((reading.channel.kind, reading.channel.of), []).append(reading)
    return slots


def _largest(errors: Sequence[Array], order: Order) -> Array:
    """What a place or rate is off by, of which there are several readings, so that no right one
    hides a wrong one: of rates the largest at every sample; of places, which are differenced and
    must not jump from one to another, those of the reading whose largest is."""
    if len(errors) == 1:
        return errors[0]
    if order == 0:
        return max(errors, key=lambda error: float(np.max(np.abs(error))))
    every = np.stack(errors)
    return np.asarray(every[np.argmax(np.abs(every), axis=0), np.arange(every.shape[1])])


def _as_motion(time_s: Array, bodies: Mapping[str, Mapping[str, Mapping[str, Array]]]) -> Motion:
    """What is known of bodies, as a motion; the rest is NaN."""
    nothing = np.full(time_s.shape, np.nan)
    nowhere = np.full((time_s.size, 2), np.nan)

    def made(kind: str, moved: type[Moved], fields: str, lacking: Array) -> dict[str, Moved]:
        return {
            name: moved(*(each.get(field, lacking) for field in fields.split()))
            for name, each in bodies[kind].items()
        }

    return Motion(
        time_s,
        made("links", LinkMotion, "theta omega alpha", nothing),
        made("points", PointMotion, "position velocity acceleration", nowhere),
        made("sliders", SliderMotion, "displacement speed acceleration", nothing),
        elastic=made("elastic", ElasticMotion, "middle extension", nothing),
    )
