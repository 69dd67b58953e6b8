"""Arrays of a motion: the requested series, filled chunk by chunk."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from analytic.change_points.turns import SURE
from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS, BodyKinematics, PointKinematics, Real
from analytic.dyads.steps import Step
from models.array import Array
from models.errors import CrankcheckError
from models.files.inputs import names_in
from models.motion import Bound, LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import Scene


class Counting(Protocol):
    """Counter of the whole turns of links over the written samples."""

    def count(self, name: str, angle: Array) -> None:
        """Add the missing whole turns to the angles of a link [rad], (T,)."""


@dataclass(frozen=True)
class Selection:
    """Requested names; each point with the body that carries it."""

    links: tuple[str, ...]
    points: Mapping[str, str]
    sliders: tuple[str, ...]

    @staticmethod
    def of(
        scene: Scene,
        links: str | Iterable[str] | None,
        points: str | Iterable[str] | None,
        sliders: str | Iterable[str] | None,
    ) -> Selection:
        """Choose the names, all of a kind for None. Raises CrankcheckError for an unknown one."""
        carriers = {point: bodies[0] for point, bodies in scene.pins.items()}
        for slider in scene.sliders.values():
            carriers.setdefault(slider.point, f"block {slider.name}")
        return Selection(
            _chosen("link", links, scene.links),
            {p: carriers[p] for p in _chosen("point", points, carriers)},
            _chosen("slider", sliders, scene.sliders),
        )


def _chosen(
    what: str, names: str | Iterable[str] | None, known: Mapping[str, object]
) -> tuple[str, ...]:
    chosen = tuple(known) if names is None else names_in(names, f"{what}s")
    for name in chosen:
        if name not in known:
            have = ", ".join(known) or "none"
            raise CrankcheckError(f"{what} {name!r} is not in the scene; it has {have}")
    return chosen


class Derivatives(NamedTuple):
    """Quantity with its first and second derivative, each (T,) or (T, 2)."""

    value: Array
    rate: Array
    second: Array

    def put(self, span: slice, value: Real, rate: Real, second: Real) -> None:
        self.value[span], self.rate[span], self.second[span] = value, rate, second

    def put_bounds(self, span: slice, *bounds: Real) -> None:
        for array, bound in zip(self, bounds, strict=True):
            put_bound(array[span], bound)


def put_bound(array: Array, bound: Real) -> None:
    """Store a bound, infinite where it is undefined (0 times infinity)."""
    np.copyto(array, np.where(np.isnan(bound), np.inf, bound))


class _Block:
    """One allocation for all arrays: far fewer page faults than one each."""

    def __init__(self, rows: int, samples: int) -> None:
        self._rows = np.empty((rows, samples))
        self._next = 0

    def row(self) -> Array:
        self._next += 1
        row: Array = self._rows[self._next - 1]
        return row

    def pair(self) -> Array:
        """Return an array of shape (T, 2), each component contiguous in time."""
        self._next += 2
        return self._rows[self._next - 2 : self._next].T

    def track(self) -> Derivatives:
        return Derivatives(self.row(), self.row(), self.row())

    def track_of_pairs(self) -> Derivatives:
        return Derivatives(self.pair(), self.pair(), self.pair())


class MotionArrays:
    """Arrays of a motion while they are filled."""

    def __init__(
        self, wanted: Selection, time_s: Array, steps: Sequence[Step], *, bound: bool
    ) -> None:
        self.wanted, self.time_s, self.certified = wanted, time_s, bound
        scalars, pairs = len(wanted.links) + len(wanted.sliders), len(wanted.points)
        rows = 3 * (scalars + 2 * pairs) + 3 * bound * (scalars + pairs) + len(steps)
        block = _Block(rows, len(time_s))
        self.links = {k: block.track() for k in wanted.links}
        self.points = {k: block.track_of_pairs() for k in wanted.points}
        self.sliders = {k: block.track() for k in wanted.sliders}
        self.sines = {step.key: block.row() for step in steps}
        if bound:
            self.link_bounds = {k: block.track() for k in wanted.links}
            self.point_bounds = {k: block.track() for k in wanted.points}
            self.slider_bounds = {k: block.track() for k in wanted.sliders}

    @np.errstate(divide="ignore", invalid="ignore", over="ignore")  # rates where there are none
    def write(self, span: slice, chunk: Chunk, counter: Counting | None) -> None:
        """Store the requested series of a solved chunk; without a counter no turns are counted."""
        for key, row in self.sines.items():
            row[span] = chunk.sines[key]
        for name in self.links:
            self._write_link(span, name, chunk.bodies[name], counter)
        for name, body in self.wanted.points.items():
            self._write_point(span, name, chunk.point(body, name))
        for name, track in self.sliders.items():
            sliding = chunk.sliders[name]
            track.put(span, sliding.s, sliding.speed, sliding.acceleration)
            if self.certified and sliding.error is not None:
                self.slider_bounds[name].put_bounds(span, *sliding.error)

    def _write_link(
        self, span: slice, name: str, body: BodyKinematics, counter: Counting | None
    ) -> None:
        track = self.links[name]
        if body.theta is not None:
            track.put(span, body.theta, body.omega, body.alpha)
        else:
            np.arctan2(body.turn.y, body.turn.x, out=track.value[span])
            track.rate[span], track.second[span] = body.omega, body.alpha
            if counter is not None:
                counter.count(name, track.value[span])
        if self.certified and body.error is not None:
            e = body.error
            limit = e.theta + 2 * EPS * (np.abs(track.value[span]) + 2.0)
            # Where the angle is uncertain, the count of its turns is uncertain too.
            limit = np.where(e.theta > SURE, math.tau, limit)
            self.link_bounds[name].put_bounds(span, limit, e.omega, e.alpha)

    def _write_point(self, span: slice, name: str, at: PointKinematics) -> None:
        track = self.points[name]
        for array, vec in zip(track, (at.p, at.v, at.a), strict=True):
            array[span, 0], array[span, 1] = vec.x, vec.y
        if self.certified and at.error is not None:
            self.point_bounds[name].put_bounds(span, *at.error)

    def motion(self) -> Motion:
        """Return the filled arrays as a motion."""
        bound = None
        if self.certified:
            bounds = (self.link_bounds, self.point_bounds, self.slider_bounds)
            bound = Bound(*_by_name(*bounds))
        series = _by_name(self.links, self.points, self.sliders)
        return Motion(self.time_s, *series, self.sines, bound)


Tracks = Mapping[str, Derivatives]


def _by_name(
    links: Tracks, points: Tracks, sliders: Tracks
) -> tuple[dict[str, LinkMotion], dict[str, PointMotion], dict[str, SliderMotion]]:
    return (
        {k: LinkMotion(*track) for k, track in links.items()},
        {k: PointMotion(*track) for k, track in points.items()},
        {k: SliderMotion(*track) for k, track in sliders.items()},
    )
