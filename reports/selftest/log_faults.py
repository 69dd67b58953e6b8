"""Faults of a log: of its clock, of its numbers, and of missing parts."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from models.array import Array
from models.scene import Scene
from reports.judge.cell import CellRunner
from reports.selftest import log_edits
from reports.selftest.fault import FOURBAR, Fault, Plant, in_log, switched
from sim.engine import Run
from sim.registry import engine
from sim.run import run
from sim.run.spoil import rounded


def late(size: float) -> CellRunner:
    """Shift every sample to so many samples later."""
    samples = round(size)

    def runner(*args: Any, steps: int, every: int, **options: Any) -> Run:
        longer = run(*args, steps=steps + samples * every, every=every, **options)
        kept = steps // every + 1
        return replace(log_edits.rows(longer, slice(samples, None), slice(kept)), steps=steps)

    return runner


def _other_step(share: float) -> CellRunner:
    """Lengthen the engine's step, and keep the stamps of the requested one."""

    def runner(*args: Any, dt_s: float, **options: Any) -> Run:
        done = run(*args, dt_s=dt_s * (1.0 + share), **options)
        return replace(log_edits.with_times(done, lambda t: t / (1.0 + share)), dt_s=dt_s)

    return runner


def _velocity_late(_: Scene, done: Run, steps: float) -> Run:
    assert done.velocity_time_s is not None
    return replace(done, velocity_time_s=done.velocity_time_s + steps * done.dt_s)


def _one_sided(scene: Scene, done: Run, steps: float) -> Run:
    """Take accelerations as backward differences of the logged velocities: half a step late."""
    omega = log_edits.output(scene, done).omega
    central = np.gradient(omega, done.dt_s * done.every, edge_order=2)
    backward = np.diff(omega, prepend=2.0 * omega[0] - omega[1]) / (done.dt_s * done.every)
    return log_edits.with_link(
        done, log_edits.last(scene), alpha=central + 2.0 * steps * (backward - central)
    )


def _stretched(_: Scene, done: Run, share: float) -> Run:
    return log_edits.with_times(done, lambda time_s: time_s * (1.0 + share))


def _in_float32(_: Scene, done: Run, size: float) -> Run:
    return log_edits.with_times(done, lambda time_s: rounded(time_s, size))


def _summed(_: Scene, done: Run) -> Run:
    """Take time as the sum of the steps, each rounded."""

    def summed(time_s: Any) -> Any:
        return time_s[0] + np.cumsum(np.r_[0.0, np.full(len(time_s) - 1, done.dt_s * done.every)])

    return log_edits.with_times(done, summed)


def _row_twice(_: Scene, done: Run) -> Run:
    """Replace one row by the row before."""
    order = np.arange(log_edits.moved(done).time_s.size)
    order[log_edits.WHEN] -= 1
    return log_edits.rows(done, order, slice(None))


def _half_the_rows(_: Scene, done: Run) -> Run:
    """Log every second row, twice."""
    order = np.arange(log_edits.moved(done).time_s.size) // 2 * 2
    return log_edits.rows(done, order, slice(None))


def _row_lost(_: Scene, done: Run) -> Run:
    keep = np.delete(np.arange(log_edits.moved(done).time_s.size), log_edits.WHEN)
    return log_edits.rows(done, keep, keep)


def _row_more(_: Scene, done: Run) -> Run:
    keep = np.insert(np.arange(log_edits.moved(done).time_s.size), log_edits.WHEN, log_edits.WHEN)
    return log_edits.rows(done, keep, keep)


def _cut(_: Scene, done: Run, samples: float) -> Run:
    keep = slice(max(log_edits.moved(done).time_s.size - round(samples), 1))
    return log_edits.rows(done, keep, keep)


def _only_one(_: Scene, done: Run) -> Run:
    return log_edits.rows(done, slice(1), slice(1))


_clock = partial(Fault, "clock")
CLOCK = (
    _clock("clock-late", "every sample is a later one", "CC102", late, 1.0, "sample", whole=True),
    _clock(
        "velocity-late",
        "velocities belong elsewhere",
        "CC106",
        in_log(_velocity_late),
        0.5,
        "steps",
    ),
    _clock(
        "acceleration-late",
        "accelerations differenced one-sidedly",
        "CC108",
        in_log(_one_sided),
        0.5,
        "steps",
        scenes=(FOURBAR,),  # half a step in the slider-crank is 0.6 of its limit
        needs=lambda name: engine(name).reports_accelerations,
    ),
    _clock("step-off", "the engine's step is too long", "CC102", _other_step, 1e-5, "dt"),
    _clock("stamps-off", "time stamps off the grid", "CC115", in_log(_stretched), 1e-9, "t"),
    _clock("stamps-float32", "time stamps in float32", "CC115", in_log(_in_float32), 2.0**-24, "t"),
    _clock("stamps-summed", "time stamps of a summed clock", "CC115", switched(_summed)),
    _clock("row-stale", "one row is the row before", "CC102", switched(_row_twice)),
    _clock("rows-half", "every second row is logged, twice", "CC102", switched(_half_the_rows)),
    _clock("row-lost", "one row is missing", "CC115", switched(_row_lost)),
    _clock("row-doubled", "one row is there twice", "CC115", switched(_row_more)),
    _clock("log-cut", "the log ends early", "CC115", in_log(_cut), 310.0, "samples", whole=True),
    _clock("log-of-one", "one sample is all that is logged", "CC115", switched(_only_one)),
)


Distortion = Callable[[Array, float], Array]
"""Change of a series by a size."""
AFTER = slice(log_edits.WHEN, None)
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""


def _angle(change: Distortion, link: Callable[[Scene], str] = log_edits.last) -> Plant:
    """Change the angle of the last link, or of another."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        name = link(scene)
        return log_edits.with_link(
            done, name, theta=change(log_edits.moved(done).links[name].theta, size)
        )

    return in_log(changed)


def _crank(scene: Scene) -> str:
    return scene.driver.link


def _omega(change: Distortion) -> Plant:
    """Change the last link's angular velocity, by a multiple of the driver's speed."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        by_rad_s = size * scene.pace_rad_s
        return log_edits.with_link(
            done, log_edits.last(scene), omega=change(log_edits.output(scene, done).omega, by_rad_s)
        )

    return in_log(changed)


def _wild(scene: Scene, done: Run, size: float) -> Run:
    omega = log_edits.spoilt(log_edits.output(scene, done).omega, START, 1e6 * size)
    return log_edits.with_link(done, log_edits.last(scene), omega=omega)


def _float32(_: Scene, done: Run, size: float) -> Run:
    return log_edits.every_series(done, lambda series: rounded(series, size))


def _all_of(change: Callable[[Array], Array]) -> Distortion:
    """Change the whole series, or leave it for a size of 0."""
    return lambda series, size: change(series) if size else series


def _at(samples: int | slice) -> Distortion:
    """Add the size to some samples."""
    return lambda series, size: log_edits.spoilt(series, samples, size)


def _turn_more(theta: Array, size: float) -> Array:
    return log_edits.spoilt(theta, log_edits.WHEN, 2 * np.pi * size)


def _ramp(theta: Array, size: float) -> Array:
    return theta + size * np.linspace(0.0, 1.0, len(theta))


def _wrapped(theta: Array) -> Array:
    return np.asarray(np.remainder(theta + np.pi, 2 * np.pi) - np.pi)


def _rpm(omega: Array) -> Array:
    return omega * 30.0 / np.pi


_value = partial(Fault, "log")
VALUES = (
    _value("sign-flipped", "an angle has the other sign", "CC103", _angle(_all_of(np.negative))),
    _value("degrees", "an angle in degrees", "CC103", _angle(_all_of(np.degrees))),
    _value("whole-turn", "a whole turn more at one sample", "CC103", _angle(_turn_more)),
    _value("crank-whole-turn", "the same, of the crank", "CC102", _angle(_turn_more, _crank)),
    _value(
        "crank-wrapped",
        "the crank's angle within +-180 deg",
        "CC102",
        _angle(_all_of(_wrapped), _crank),
    ),
    _value(
        "float32-log",
        "every number of the log in float32",
        "CC102",
        in_log(_float32),
        2.0**-24,
        "of it",
    ),
    _value(
        "rounded-log", "an angle of few digits", "CC114", _angle(log_edits.to_digits), 1e-5, "rad"
    ),
    _value("noise", "noise on an angle (normal)", "CC114", _angle(log_edits.noisy), 1e-5, "rad"),
    _value("drift", "an angle drifts off", "CC103", _angle(_ramp), 1e-3, "rad"),
    _value(
        "slow-drift",
        "the same, within this step's limit",
        "CC110",
        _angle(_ramp),
        1.5e-4,
        "rad",
        finer=True,
    ),
    _value(
        "spike", "an angle is off at one sample", "CC114", _angle(_at(log_edits.WHEN)), 1e-5, "rad"
    ),
    _value("jump", "an angle jumps, and stays", "CC107", _angle(_at(AFTER)), 1e-4, "rad"),
    _value(
        "velocity-spike",
        "a velocity is off at one sample",
        "CC106",
        _omega(_at(log_edits.WHEN)),
        1e-2,
        "w",
    ),
    _value("rpm", "a velocity in revolutions a minute", "CC106", _omega(_all_of(_rpm))),
    _value("wrong-start", "a velocity is off at the start", "CC116", _omega(_at(START)), 5e-2, "w"),
    _value("wild-start", "a velocity of 1e6 rad/s at the start", "CC116", in_log(_wild)),
)


def _end_missing(scene: Scene, done: Run) -> Run:
    return log_edits.with_link(
        done,
        log_edits.last(scene),
        theta=log_edits.spoilt(log_edits.output(scene, done).theta, -1, np.nan),
    )


def _infinite(scene: Scene, done: Run) -> Run:
    return log_edits.with_link(
        done,
        log_edits.last(scene),
        omega=log_edits.spoilt(log_edits.output(scene, done).omega, log_edits.WHEN, np.inf),
    )


def _without_link(scene: Scene, done: Run) -> Run:
    motion = log_edits.moved(done)
    links = {name: part for name, part in motion.links.items() if name != log_edits.last(scene)}
    return replace(done, motion=replace(motion, links=links))


def _without_point(_: Scene, done: Run) -> Run:
    motion = log_edits.moved(done)
    points = {name: part for name, part in motion.points.items() if name != "C"}
    return replace(done, motion=replace(motion, points=points))


def _silent(scene: Scene, done: Run) -> Run:
    """Report accelerations, of one link NaN throughout."""
    alpha = np.full_like(log_edits.output(scene, done).alpha, np.nan)
    return replace(
        log_edits.with_link(done, log_edits.last(scene), alpha=alpha), reports_accelerations=True
    )


MISSING = tuple(
    Fault("missing", name, what, "CC109", switched(change))
    for name, what, change in (
        ("nan-at-end", "the last angle is NaN", _end_missing),
        ("infinity", "one velocity is infinite", _infinite),
        ("link-absent", "a link is not in the log", _without_link),
        ("point-absent", "a point is not in the log", _without_point),
        ("gaps-absent", "no pin's gap is in the log", lambda _, done: replace(done, gaps={})),
        ("acceleration-nan", "accelerations of one link are NaN", _silent),
    )
)
