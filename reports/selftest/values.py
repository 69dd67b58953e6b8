"""Faults of the logged numbers: a trajectory that is whole, and wrong."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from models.array import Array
from models.scene import Scene
from reports.selftest.fault import Fault, Plant, in_log
from reports.selftest.logs import WHEN, every_series, last, moved, output, spoilt, with_link
from sim.engine import Run
from sim.spoil import rounded

Distortion = Callable[[Array, float], Array]
"""A series, changed by a size."""
SEED = 20240229
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""


def _angle(change: Distortion) -> Plant:
    """A change of the last link's angle, of the angle and the size."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        theta = change(output(scene, done).theta, size)
        return with_link(done, last(scene), theta=theta)

    return in_log(changed)


def _omega(change: Callable[[Array, float, float], Array]) -> Plant:
    """A change of the last link's angular velocity, of that, the size and the driver's speed."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        speed = scene.driver.law.peak_speed_rad_s
        omega = change(output(scene, done).omega, size, speed)
        return with_link(done, last(scene), omega=omega)

    return in_log(changed)


def _crank(change: Distortion) -> Plant:
    """A change of the driver's angle."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        name = scene.driver.link
        return with_link(done, name, theta=change(moved(done).links[name].theta, size))

    return in_log(changed)


def _ramp(theta: Array, size: float) -> Array:
    return theta + size * np.linspace(0.0, 1.0, len(theta))


def _wrapped(theta: Array, size: float) -> Array:
    return np.asarray(np.remainder(theta + np.pi, 2 * np.pi) - np.pi) if size else theta


def _noisy(theta: Array, size: float) -> Array:
    return theta + size * np.random.default_rng(SEED).standard_normal(len(theta))


def _to_digits(theta: Array, size: float) -> Array:
    return np.rint(theta / size) * size if size else theta


FAULTS = (
    Fault(
        "sign-flipped",
        "log",
        "an angle has the other sign",
        "CC103",
        _angle(lambda theta, size: -theta if size else theta),
    ),
    Fault(
        "degrees",
        "log",
        "an angle in degrees",
        "CC103",
        _angle(lambda theta, size: np.degrees(theta) if size else theta),
    ),
    Fault(
        "whole-turn",
        "log",
        "a whole turn more at one sample",
        "CC103",
        _angle(lambda theta, size: spoilt(theta, WHEN, 2 * np.pi * size) if size else theta),
    ),
    Fault(
        "crank-whole-turn",
        "log",
        "the same, of the crank",
        "CC102",
        _crank(lambda theta, size: spoilt(theta, WHEN, 2 * np.pi * size) if size else theta),
    ),
    Fault("crank-wrapped", "log", "the crank's angle within +-180 deg", "CC102", _crank(_wrapped)),
    Fault(
        "float32-log",
        "log",
        "every number of the log in float32",
        "CC102",
        in_log(lambda _, done, size: every_series(done, lambda a: rounded(a, size))),
        2.0**-24,
        "of it",
    ),
    Fault("rounded-log", "log", "an angle of few digits", "CC114", _angle(_to_digits), 1e-5, "rad"),
    Fault("noise", "log", "noise on an angle (normal)", "CC114", _angle(_noisy), 1e-5, "rad"),
    Fault("drift", "log", "an angle drifts off", "CC103", _angle(_ramp), 1e-3, "rad"),
    Fault(
        "slow-drift",
        "log",
        "the same, within this step's limit",
        "CC110",
        _angle(_ramp),
        1.5e-4,
        "rad",
    ),
    Fault(
        "spike",
        "log",
        "an angle is off at one sample",
        "CC114",
        _angle(lambda theta, size: spoilt(theta, WHEN, size)),
        1e-5,
        "rad",
    ),
    Fault(
        "jump",
        "log",
        "an angle jumps, and stays",
        "CC107",
        _angle(lambda theta, size: spoilt(theta, slice(WHEN, None), size)),
        1e-4,
        "rad",
    ),
    Fault(
        "velocity-spike",
        "log",
        "a velocity is off at one sample",
        "CC106",
        _omega(lambda omega, size, w: spoilt(omega, WHEN, size * w)),
        1e-2,
        "w",
    ),
    Fault(
        "rpm",
        "log",
        "a velocity in revolutions a minute",
        "CC106",
        _omega(lambda omega, size, _: omega * 30.0 / np.pi if size else omega),
    ),
    Fault(
        "wrong-start",
        "log",
        "a velocity is off at the start",
        "CC116",
        _omega(lambda omega, size, w: spoilt(omega, START, size * w)),
        5e-2,
        "w",
    ),
    Fault(
        "wild-start",
        "log",
        "a velocity of 1e6 rad/s at the start",
        "CC116",
        _omega(lambda omega, size, _: spoilt(omega, START, 1e6 * size) if size else omega),
    ),
)
