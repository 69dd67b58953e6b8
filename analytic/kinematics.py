"""The reference: position, velocity and acceleration of a whole mechanism, in closed form.

`solve` runs the driver's law through the mechanism's Assur groups in solving order, in chunks that
stay in cache, and writes what was asked for. With ``bound`` every number carries a bound of its own
error, propagated from group to group (`analytic.closure`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from analytic.chunk import Chunk
from analytic.dyads.parts import OpenError
from analytic.plane import (
    EPS,
    STEADY,
    AngleError,
    Array,
    BodyKinematics,
    Real,
    Vec,
    fixed_body,
    fixed_point,
)
from analytic.reach import Range, describe_reach, ranges
from analytic.result import Result, Wanted
from analytic.steps import Step, prepare
from analytic.structure import analyse
from models.errors import CrankcheckError, ReachError
from models.laws import ConstantSpeed, Law
from models.motion import Motion
from models.scene import GROUND, Scene

CHUNK = 12288
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
    steps = prepare(scene, analyse(scene))
    result = Result(Wanted.of(scene, links, points, sliders), time_s, steps, bound=bound)
    for first in range(0, len(time_s), CHUNK):
        span = slice(first, first + CHUNK)
        t = time_s[span]
        theta, omega, alpha = _law_at(law, t)
        error = None
        if bound:
            age = np.abs(t) * law.fastest_rad_s + abs(law.phase_rad)
            peak = law.peak_speed_rad_s
            error = AngleError(
                4 * EPS * (np.abs(theta) + law.offset_rad + peak * np.abs(t)),
                4 * EPS * peak * (1.0 + age),
                4 * EPS * peak * law.fastest_rad_s * (1.0 + age),
            )
        result.write(span, _advance(scene, steps, theta, omega, alpha, error))
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
    labels = np.zeros_like(theta) if time_s is None else np.asarray(time_s, dtype=np.float64)
    steps = prepare(scene, analyse(scene))
    result = Result(Wanted.of(scene, links, points, sliders), labels, steps, bound=bound)
    for first in range(0, len(theta), CHUNK):
        span = slice(first, first + CHUNK)
        error = AngleError(4 * EPS * np.abs(theta[span]), 0.0, 0.0) if bound else None
        chunk = _advance(scene, steps, theta[span], omega[span], alpha[span], error)
        result.write(span, chunk)
    return result.motion()


def reach(scene: Scene) -> list[Range]:
    """The driver angles, within a turn, in which the scene can be assembled (`analytic.reach`)."""
    steps = prepare(scene, analyse(scene))
    return ranges(lambda angles: stretched(scene, steps, angles))


def stretched(scene: Scene, steps: list[Step], theta: Array) -> Chunk:
    """The mechanism at driver angles that may be out of reach, its open dyads stretched in line."""
    zero = np.zeros_like(theta)
    chunk = _start(scene, theta, zero, zero, None, stretch=True)
    with np.errstate(all="ignore"):  # parallel lines cross at infinity
        for step in steps:
            step.advance(chunk)
    return chunk


def _law_at(law: Law, t: Array) -> tuple[Array, Real, Real]:
    """The law at times ``t``; what is constant as one number, which costs no arithmetic."""
    if isinstance(law, ConstantSpeed):
        return law.angle(t), law.speed_rad_s, STEADY
    return law.at(t)


def _samples(values: Array) -> Array:
    """The sample values as a finite array of shape (T,), T at least 1."""
    values = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if values.ndim != 1 or len(values) == 0:
        raise CrankcheckError(f"samples of shape {values.shape}; give one dimension, at least one")
    with np.errstate(invalid="ignore", over="ignore"):
        total = float(values.sum())  # finite sums are the quick way to see that all are
    if not math.isfinite(total) and not np.isfinite(values).all():
        index = int(np.flatnonzero(~np.isfinite(values))[0])
        raise CrankcheckError(f"sample {index} is {values[index]}; samples are finite numbers")
    return values


def _start(
    scene: Scene,
    theta: Array,
    omega: Real,
    alpha: Real,
    error: AngleError | None,
    *,
    stretch: bool = False,
) -> Chunk:
    """A chunk in which the ground and the driver are known."""
    pivot = scene.driver_pivot
    local = scene.links[scene.driver.link].points[pivot]
    anchor = fixed_point(scene.ground[pivot])
    driver = BodyKinematics(
        local, anchor, Vec(np.cos(theta), np.sin(theta)), omega, alpha, error, theta
    )
    certified = error is not None
    bodies = {GROUND: fixed_body(certified=certified), scene.driver.link: driver}
    return Chunk(scene, certified, stretch, bodies, points={pivot: anchor})


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # rates where there are none
def _advance(
    scene: Scene,
    steps: list[Step],
    theta: Array,
    omega: Real,
    alpha: Real,
    error: AngleError | None,
) -> Chunk:
    """One chunk through all steps. Raises ReachError."""
    chunk = _start(scene, theta, omega, alpha, error)
    for step in steps:
        try:
            step.advance(chunk)
        except OpenError as opened:
            index = int(np.argmax(opened.short_m))
            angle, short = math.degrees(theta[index]), float(opened.short_m[index])
            reach = describe_reach(scene, lambda angles: stretched(scene, steps, angles))
            raise ReachError(
                f"{scene.name}: {scene.driver.link} at {angle:.6g} deg: the loop cannot close at "
                f"{step.key}, it is open by {short:.3g} m. {reach}"
            ) from None
    return chunk
