"""The reference: position, velocity and acceleration of a whole mechanism, in closed form.

`solve` runs the driver's law through the mechanism's Assur groups in solving order, in chunks that
stay in cache, and writes what was asked for. With ``bound`` every number carries a bound of its own
error, propagated from group to group (`analytic.closure`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.dyads.parts import OpenError
from analytic.plane import (
    EPS,
    EXACT_POINT,
    AngleError,
    Array,
    BodyKinematics,
    PointKinematics,
    Real,
    Vec,
    fixed_body,
)
from analytic.reach import describe_reach
from analytic.steps import Chunk, Step, prepare
from analytic.structure import analyse
from models.errors import CrankcheckError, ReachError
from models.motion import Bound, LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import GROUND, Scene

CHUNK = 4096
"""Samples solved at a time: their intermediate arrays fit the second-level cache."""


def solve(
    scene: Scene,
    time_s: Array,
    *,
    links: Iterable[str] | None = None,
    points: Iterable[str] | None = None,
    sliders: Iterable[str] | None = None,
    bound: bool = True,
) -> Motion:
    """The motion of a scene at the given times.

    Parameters
    ----------
    scene : Scene
        The mechanism with its driver's law.
    time_s : Array
        Times [s], shape (T,).
    links, points, sliders : Iterable[str] or None
        What to return; None is all, () is none.
    bound : bool
        Carry error bounds (about three times the work).

    Returns
    -------
    Motion
        Angles are continuous from the first sample on; sliders count from ``through_m``.

    Raises
    ------
    StructureError
        The scene has no closed form, or a mobility other than 1.
    ReachError
        The law leads to a driver angle in which the mechanism cannot be assembled; the message
        names the reachable range.
    """
    time_s = _samples(time_s)
    law = scene.driver.law
    wanted = _Wanted.of(scene, links, points, sliders)
    result = _Result(scene, wanted, time_s, bound)
    steps = prepare(scene, analyse(scene))
    for first in range(0, len(time_s), CHUNK):
        span = slice(first, first + CHUNK)
        t = time_s[span]
        theta, omega, alpha = law.at(t)
        error = None
        if bound:
            age, peak = np.abs(t) * law.fastest_rad_s, law.peak_speed_rad_s
            error = AngleError(
                4 * EPS * (np.abs(theta) + law.offset_rad + peak * np.abs(t)),
                4 * EPS * peak * (1.0 + age),
                4 * EPS * peak * law.fastest_rad_s * (1.0 + age),
            )
        result.write(span, steps, theta, omega, alpha, error)
    return result.motion()


def solve_driven(
    scene: Scene,
    theta: Array,
    omega: Array,
    alpha: Array,
    time_s: Array | None = None,
    *,
    links: Iterable[str] | None = None,
    points: Iterable[str] | None = None,
    sliders: Iterable[str] | None = None,
    bound: bool = True,
) -> Motion:
    """The motion of a scene whose driver has the given angles, rates and accelerations.

    As `solve`, but for driver angles [rad], rates [rad/s] and accelerations [rad/s^2], shape (T,),
    that are taken as exact: the geometry at the angle that an engine logged, say. ``time_s`` only
    labels the samples.
    """
    theta = _samples(theta)
    omega, alpha = np.broadcast_to(omega, theta.shape), np.broadcast_to(alpha, theta.shape)
    wanted = _Wanted.of(scene, links, points, sliders)
    labels = np.zeros_like(theta) if time_s is None else np.asarray(time_s, dtype=np.float64)
    result = _Result(scene, wanted, labels, bound)
    steps = prepare(scene, analyse(scene))
    for first in range(0, len(theta), CHUNK):
        span = slice(first, first + CHUNK)
        error = AngleError(4 * EPS * np.abs(theta[span]), 0.0, 0.0) if bound else None
        result.write(span, steps, theta[span], omega[span], alpha[span], error)
    return result.motion()


def stretched(scene: Scene, steps: list[Step], theta: Array) -> Chunk:
    """The mechanism at driver angles that may be out of reach, its open dyads stretched in line."""
    zero = np.zeros_like(theta)
    chunk = _start(scene, theta, zero, zero, None, stretch=True)
    for step in steps:
        step.advance(chunk)
    return chunk


def _samples(values: Array) -> Array:
    """The sample values as a finite array of shape (T,), T at least 1."""
    values = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if values.ndim != 1 or len(values) == 0:
        raise CrankcheckError(f"samples of shape {values.shape}; give one dimension, at least one")
    if not np.isfinite(values).all():
        index = int(np.flatnonzero(~np.isfinite(values))[0])
        raise CrankcheckError(f"sample {index} is {values[index]}; samples are finite numbers")
    return values


def _start(
    scene: Scene,
    theta: Array,
    omega: Array,
    alpha: Array,
    error: AngleError | None,
    *,
    stretch: bool = False,
) -> Chunk:
    """A chunk in which the ground and the driver are known."""
    pivot = scene.driver_pivot
    local = scene.links[scene.driver.link].points[pivot]
    anchor = fixed_body().point((0.0, 0.0))
    place = scene.ground[pivot]
    anchor = PointKinematics(Vec(*place), anchor.v, anchor.a, EXACT_POINT)
    driver = BodyKinematics(
        local, anchor, Vec(np.cos(theta), np.sin(theta)), omega, alpha, error, theta
    )
    bodies = {GROUND: fixed_body(), scene.driver.link: driver}
    return Chunk(scene, error is not None, stretch, bodies, points={pivot: anchor})


@dataclass(frozen=True)
class _Wanted:
    """The names that a caller asked for; a point goes with the body that carries it."""

    links: tuple[str, ...]
    points: Mapping[str, str]
    sliders: tuple[str, ...]

    @staticmethod
    def of(
        scene: Scene,
        links: Iterable[str] | None,
        points: Iterable[str] | None,
        sliders: Iterable[str] | None,
    ) -> _Wanted:
        carriers = {point: bodies[0] for point, bodies in scene.pins.items()}
        for slider in scene.sliders.values():
            carriers.setdefault(slider.point, f"block {slider.name}")
        return _Wanted(
            _chosen("link", links, scene.links),
            {p: carriers[p] for p in _chosen("point", points, carriers)},
            _chosen("slider", sliders, scene.sliders),
        )


def _chosen(
    what: str, names: Iterable[str] | None, known: Mapping[str, object]
) -> tuple[str, ...]:
    """The asked names, all of them for None. Raises CrankcheckError for one that is not there."""
    chosen = tuple(known) if names is None else tuple(names)
    for name in chosen:
        if name not in known:
            have = ", ".join(known) or "none"
            raise CrankcheckError(f"{what} {name!r} is not in the scene; it has {have}")
    return chosen


class _Result:
    """The arrays of a motion while they are filled."""

    def __init__(self, scene: Scene, wanted: _Wanted, time_s: Array, bound: bool) -> None:
        self.scene, self.wanted, self.time_s, self.certified = scene, wanted, time_s, bound
        n = len(time_s)
        self.links = {k: _Track(n) for k in wanted.links}
        self.points = {k: _Track(n, 2) for k in wanted.points}
        self.sliders = {k: _Track(n) for k in wanted.sliders}
        self.sines: dict[str, Array] = {}
        self.bounds = (
            {(kind, k): _Track(n) for kind, names in self._kinds() for k in names} if bound else {}
        )

    def _kinds(self) -> list[tuple[str, Iterable[str]]]:
        w = self.wanted
        return [("link", w.links), ("point", w.points), ("slider", w.sliders)]

    def write(
        self,
        span: slice,
        steps: list[Step],
        theta: Array,
        omega: Array,
        alpha: Array,
        error: AngleError | None,
    ) -> None:
        """Solve one chunk and store what was asked for."""
        chunk = _start(self.scene, theta, omega, alpha, error)
        for step in steps:
            try:
                step.advance(chunk)
            except OpenError as opened:
                raise ReachError(self._out_of_reach(steps, theta, opened, step.key)) from None
            sine = self.sines.setdefault(step.key, np.empty(len(self.time_s)))
            sine[span] = chunk.sines[step.key]
        for name, track in self.links.items():
            self._write_link(span, name, track, chunk.bodies[name])
        for name, track in self.points.items():
            self._write_point(span, name, track, chunk.point(self.wanted.points[name], name))
        for name, track in self.sliders.items():
            found = chunk.sliders[name]
            track.put(span, found.s, found.speed, found.acceleration)
            if found.error is not None:
                e = found.error
                self._bound("slider", name, span, e.displacement, e.speed, e.acceleration)

    def _write_link(self, span: slice, name: str, track: _Track, body: BodyKinematics) -> None:
        known = body.theta is not None
        theta = body.theta if known else np.arctan2(body.turn.y, body.turn.x)
        track.put(span, theta, body.omega, body.alpha)
        if not known:
            _continue_angle(track.value, span)
        if body.error is not None:
            e = body.error
            rounding = 2 * EPS * (np.abs(track.value[span]) + math.pi)
            self._bound("link", name, span, e.theta + rounding, e.omega, e.alpha)

    def _write_point(self, span: slice, name: str, track: _Track, at: PointKinematics) -> None:
        for axis, (p, v, a) in enumerate(
            ((at.p.x, at.v.x, at.a.x), (at.p.y, at.v.y, at.a.y))
        ):
            track.value[span, axis], track.rate[span, axis], track.second[span, axis] = p, v, a
        if at.error is not None and self.certified:
            e = at.error
            self._bound("point", name, span, e.position, e.velocity, e.acceleration)

    def _bound(self, kind: str, name: str, span: slice, a: Real, b: Real, c: Real) -> None:
        if self.certified:
            self.bounds[kind, name].put(span, a, b, c)

    def _out_of_reach(
        self, steps: list[Step], theta: Array, opened: OpenError, key: str
    ) -> str:
        """What was asked, by how much it fails, and the range that works."""
        index = int(np.argmax(opened.short_m > 0.0))
        angle, short = float(theta[index]), float(opened.short_m[index])
        scene = self.scene
        return (
            f"{scene.name}: {scene.driver.link} at {math.degrees(angle):.6g} deg: the loop cannot "
            f"close at {key}, it is open by {short:.3g} m. "
            + describe_reach(scene, lambda angles: stretched(scene, steps, angles))
        )

    def motion(self) -> Motion:
        """The filled arrays as a motion."""
        bound = None
        if self.certified:
            b = self.bounds
            bound = Bound(
                {k: LinkMotion(*b["link", k].arrays) for k in self.links},
                {k: PointMotion(*b["point", k].arrays) for k in self.points},
                {k: SliderMotion(*b["slider", k].arrays) for k in self.sliders},
            )
        return Motion(
            self.time_s,
            {k: LinkMotion(*track.arrays) for k, track in self.links.items()},
            {k: PointMotion(*track.arrays) for k, track in self.points.items()},
            {k: SliderMotion(*track.arrays) for k, track in self.sliders.items()},
            self.sines,
            bound,
        )


class _Track:
    """A quantity with its first and second derivative, components contiguous in time."""

    def __init__(self, samples: int, components: int = 1) -> None:
        shape = (samples,) if components == 1 else (components, samples)
        self.value, self.rate, self.second = (np.empty(shape).T for _ in range(3))

    @property
    def arrays(self) -> tuple[Array, Array, Array]:
        return self.value, self.rate, self.second

    def put(self, span: slice, value: Real, rate: Real, second: Real) -> None:
        self.value[span], self.rate[span], self.second[span] = value, rate, second


def _continue_angle(theta: Array, span: slice) -> None:
    """Take whole turns off the samples of ``span`` so that they follow on from those before."""
    start = max(span.start - 1, 0)
    part = theta[start : span.stop]
    step = np.diff(part)
    if np.max(np.abs(step), initial=0.0) > math.pi:
        part[1:] -= math.tau * np.cumsum(np.round(step / math.tau))
