"""Faults of the logged numbers: a trajectory that is whole, and wrong."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from models.array import Array
from models.scene import Scene
from reports.selftest.fault import Fault, Plant, in_log
from reports.selftest.logs import (
    WHEN,
    every_series,
    last,
    moved,
    noisy,
    output,
    spoilt,
    to_digits,
    with_link,
)
from sim.engine import Run
from sim.spoil import rounded

Distortion = Callable[[Array, float], Array]
"""A series, changed by a size."""
AFTER = slice(WHEN, None)
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""


def _angle(change: Distortion, link: Callable[[Scene], str] = last) -> Plant:
    """A change of the angle of the last link, or of another."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        name = link(scene)
        return with_link(done, name, theta=change(moved(done).links[name].theta, size))

    return in_log(changed)


def _crank(scene: Scene) -> str:
    return scene.driver.link


def _omega(change: Distortion) -> Plant:
    """A change of the last link's angular velocity, by a multiple of the driver's speed."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        by_rad_s = size * scene.pace_rad_s
        return with_link(done, last(scene), omega=change(output(scene, done).omega, by_rad_s))

    return in_log(changed)


def _wild(scene: Scene, done: Run, size: float) -> Run:
    omega = spoilt(output(scene, done).omega, START, 1e6 * size)
    return with_link(done, last(scene), omega=omega)


def _float32(_: Scene, done: Run, size: float) -> Run:
    return every_series(done, lambda series: rounded(series, size))


def _all_of(change: Callable[[Array], Array]) -> Distortion:
    """The whole series is changed, or is not."""
    return lambda series, size: change(series) if size else series


def _at(samples: int | slice) -> Distortion:
    """The size is added to some samples."""
    return lambda series, size: spoilt(series, samples, size)


def _turn_more(theta: Array, size: float) -> Array:
    return spoilt(theta, WHEN, 2 * np.pi * size)


def _ramp(theta: Array, size: float) -> Array:
    return theta + size * np.linspace(0.0, 1.0, len(theta))


def _wrapped(theta: Array) -> Array:
    return np.asarray(np.remainder(theta + np.pi, 2 * np.pi) - np.pi)


def _rpm(omega: Array) -> Array:
    return omega * 30.0 / np.pi


_fault = partial(Fault, "log")
FAULTS = (
    _fault("sign-flipped", "an angle has the other sign", "CC103", _angle(_all_of(np.negative))),
    _fault("degrees", "an angle in degrees", "CC103", _angle(_all_of(np.degrees))),
    _fault("whole-turn", "a whole turn more at one sample", "CC103", _angle(_turn_more)),
    _fault("crank-whole-turn", "the same, of the crank", "CC102", _angle(_turn_more, _crank)),
    _fault(
        "crank-wrapped",
        "the crank's angle within +-180 deg",
        "CC102",
        _angle(_all_of(_wrapped), _crank),
    ),
    _fault(
        "float32-log",
        "every number of the log in float32",
        "CC102",
        in_log(_float32),
        2.0**-24,
        "of it",
    ),
    _fault("rounded-log", "an angle of few digits", "CC114", _angle(to_digits), 1e-5, "rad"),
    _fault("noise", "noise on an angle (normal)", "CC114", _angle(noisy), 1e-5, "rad"),
    _fault("drift", "an angle drifts off", "CC103", _angle(_ramp), 1e-3, "rad"),
    _fault(
        "slow-drift",
        "the same, within this step's limit",
        "CC110",
        _angle(_ramp),
        1.5e-4,
        "rad",
        finer=True,
    ),
    _fault("spike", "an angle is off at one sample", "CC114", _angle(_at(WHEN)), 1e-5, "rad"),
    _fault("jump", "an angle jumps, and stays", "CC107", _angle(_at(AFTER)), 1e-4, "rad"),
    _fault(
        "velocity-spike", "a velocity is off at one sample", "CC106", _omega(_at(WHEN)), 1e-2, "w"
    ),
    _fault("rpm", "a velocity in revolutions a minute", "CC106", _omega(_all_of(_rpm))),
    _fault("wrong-start", "a velocity is off at the start", "CC116", _omega(_at(START)), 5e-2, "w"),
    _fault("wild-start", "a velocity of 1e6 rad/s at the start", "CC116", in_log(_wild)),
)
