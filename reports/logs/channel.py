"""A column of a log with its meaning, and its numbers beside the reference."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from models.array import Array
from models.motion import ElasticMotion, LinkMotion, Motion, Order, PointMotion, SliderMotion
from models.scene import Scene
from reports.compare.compare import Truth
from reports.logs.force_columns import LogForces
from reports.logs.kinds import Kind

Moved = TypeVar("Moved", LinkMotion, PointMotion, SliderMotion, ElasticMotion)


@dataclass(frozen=True)
class Channel:
    """Meaning of a column: a kind of reading ``of`` a link, point or slider, in ``unit``.

    A reading in SI is ``sign * (number + offset) * unit``. An angle may be ``wrapped`` into one
    turn, and be ``relative_to`` another link. A point that several bodies share may be read ``on``
    one of them. The numbers belong to ``delay_s`` after the time stamp of the row (or the time in
    the column ``time`` of the same file, where it has several).
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
        """Name in messages: the kind and the body."""
        against = f" relative to {self.relative_to}" if self.relative_to else ""
        on = f" on {self.on}" if self.on else ""
        return f"{self.kind.name} of {self.of}{on}{against}"

    def expected(self, reference: Motion) -> Array:
        """Return the reference (T,) [SI] of that kind and body, less the other link's if any."""
        series = self.kind.of(reference, self.of)
        if self.relative_to:
            series = series - self.kind.of(reference, self.relative_to)
        return series

    def error(self, readings: Array, expected: Array) -> Array:
        """Return readings less reference (T,) [SI]: for a wrapped angle less the nearest whole
        turns at every sample, for another angle less those of the first sample."""
        error = readings - expected
        if not self.kind.turns:
            return error
        turns = np.round((error if self.wrapped else error[:1]) / math.tau)
        return np.asarray(error - math.tau * turns)


def is_driver(channel: Channel, scene: Scene) -> bool:
    """True for the angle of the driven link itself."""
    return channel.of == scene.driver.link and channel.kind.turns and not channel.relative_to


@dataclass(frozen=True)
class Reading:
    """The numbers of a channel in SI (T,), and their instants [s] (T,)."""

    channel: Channel
    values: Array
    instants: Array

    def first(self, rows: int) -> Reading:
        """Return the reading with its first rows alone."""
        return replace(self, values=self.values[:rows], instants=self.instants[:rows])

    def expected(self, truth: Truth) -> Array:
        """Return the reference of it at its instants (T,). Raises CrankcheckError."""
        return self.channel.expected(truth.at(self.instants))

    def error(self, truth: Truth) -> Array:
        """Return its error (T,) [SI]."""
        return self.channel.error(self.values, self.expected(truth))


@dataclass(frozen=True)
class GapColumn:
    """A column with the distance of the bodies at a pin or slider, in its ``unit``."""

    column: str
    of: str
    unit: str


@dataclass(frozen=True)
class Gap(GapColumn):
    """Such a column with its numbers (T,) [m]."""

    opening_m: Array


@dataclass(frozen=True)
class OwnLog:
    """A user's log, as its columns were understood: instants (T,) [s] and one reading a channel.

    ``stamp`` is the column of the instants, and its unit; ``zero_s`` was subtracted from its times
    [s]. A table over the driver's angle is not ``timed``: its instants are those of a driver that
    turns from row to row at its peak speed.

    Several ``readings`` may be of one rate of a point, or of one link, each relative to another.
    ``copies`` are readings of a point's position on further bodies, for the gap; ``gaps`` are
    logged ones; ``still`` are readings of points of the ground. ``unused`` names columns without a
    meaning, with the reason; ``unjudged`` those of them with numbers that name a body or a known
    quantity, and are not to be passed over; ``besides``, (T,), are lengths of forces and friction.
    ``forces`` are read on request. ``left_out`` rows after the last were cut off, as their
    reference is not known.
    """

    source: str
    scene: Scene
    time_s: Array
    readings: tuple[Reading, ...]
    stamp: tuple[str, str] = ("", "")
    zero_s: float = 0.0
    copies: tuple[Reading, ...] = ()
    gaps: tuple[Gap, ...] = ()
    still: tuple[Reading, ...] = ()
    unused: tuple[tuple[str, str], ...] = ()
    unjudged: tuple[tuple[str, str], ...] = ()
    besides: Mapping[str, Array] = field(default_factory=dict)
    forces: LogForces | None = None
    left_out: int = 0
    timed: bool = True

    def first(self, rows: int) -> OwnLog:
        """Return the log with its first rows alone; itself where these are all."""
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
    log: OwnLog, truth_of: Callable[[Order], Motion], error_of: Callable[[Reading], Array]
) -> Motion:
    """Return the positions and rates of a log as a motion; the rest is NaN.
    ``truth_of`` gives the reference at the instants of an order, ``error_of`` the error of a
    reading: a coordinate of a point that the log lacks equals the reference."""
    bodies: dict[str, dict[str, dict[str, Array]]]
    bodies = {"links": {}, "points": {}, "sliders": {}, "elastic": {}}
    # One each, but several for rates of a point on several bodies, and for angles of a link that
    # are also relative to others.
    slots: dict[tuple[Kind, str], list[Reading]] = {}
    for reading in log.readings:
        slots.setdefault((reading.channel.kind, reading.channel.of), []).append(reading)
    for (kind, body), several in sorted(slots.items(), key=lambda slot: slot[0][0].is_size):
        right = kind.of(truth_of(kind.order), body)
        wrong = _largest([error_of(reading) for reading in several], kind.order)
        fields = bodies[kind.bodies].setdefault(body, {})
        if kind.body_kind != "point":
            fields[kind.field] = right + wrong
            continue
        vectors = getattr(truth_of(kind.order).points[body], kind.field)
        fields.setdefault(kind.field, vectors.copy())
        if kind.is_size:
            fields[kind.field] = _of_size(fields[kind.field], vectors, right, wrong)
        else:
            fields[kind.field][:, kind.axis] += wrong
    return _as_motion(log.time_s, bodies)


def _of_size(logged: Array, vectors: Array, size: Array, error: Array) -> Array:
    """Return the logged rate of a point (T, 2), off by the error of its size where that is more
    than the error of its components; along the reference, or x where that is 0."""
    along = np.divide(vectors, size[:, None], out=np.zeros_like(vectors), where=size[:, None] > 0.0)
    along[size == 0.0, 0] = 1.0
    more = np.abs(error) > np.hypot(*(logged - vectors).T)
    return np.where(more[:, None], vectors + error[:, None] * along, logged)


def _largest(errors: Sequence[Array], order: Order) -> Array:
    """Return the error of a position or rate with several readings, so that no right one hides a
    wrong one: for rates the largest at every sample; for positions, which are differenced and must
    not jump from one to another, that of the reading with the largest error."""
    if len(errors) == 1:
        return errors[0]
    if order == 0:
        return max(errors, key=lambda error: float(np.max(np.abs(error))))
    every = np.stack(errors)
    return np.asarray(every[np.argmax(np.abs(every), axis=0), np.arange(every.shape[1])])


def _as_motion(time_s: Array, bodies: Mapping[str, Mapping[str, Mapping[str, Array]]]) -> Motion:
    """Return the known series of bodies as a motion; the rest is NaN."""
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
