"""Faults of time: what is logged belongs to another instant than it says."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from models.scene import Scene
from reports.judge.cell import CellRunner
from reports.selftest.fault import FOURBAR, Fault, in_log, switched
from reports.selftest.logs import WHEN, last, moved, output, rows, with_link, with_times
from sim.engine import Run
from sim.registry import engine
from sim.run import run
from sim.spoil import rounded


def late(size: float) -> CellRunner:
    """Every sample is that of so many samples later."""
    samples = round(size)

    def runner(*args: Any, steps: int, every: int, **options: Any) -> Run:
        longer = run(*args, steps=steps + samples * every, every=every, **options)
        kept = steps // every + 1
        return replace(rows(longer, slice(samples, None), slice(kept)), steps=steps)

    return runner


def _other_step(share: float) -> CellRunner:
    """The engine's step is longer than it was told, and the stamps know nothing of it."""

    def runner(*args: Any, dt_s: float, **options: Any) -> Run:
        done = run(*args, dt_s=dt_s * (1.0 + share), **options)
        return replace(with_times(done, lambda t: t / (1.0 + share)), dt_s=dt_s)

    return runner


def _velocity_late(_: Scene, done: Run, steps: float) -> Run:
    assert done.velocity_time_s is not None
    return replace(done, velocity_time_s=done.velocity_time_s + steps * done.dt_s)


def _one_sided(scene: Scene, done: Run, steps: float) -> Run:
    """Accelerations as backward differences of the logged velocities: half a step late."""
    omega = output(scene, done).omega
    central = np.gradient(omega, done.dt_s * done.every, edge_order=2)
    backward = np.diff(omega, prepend=2.0 * omega[0] - omega[1]) / (done.dt_s * done.every)
    return with_link(done, last(scene), alpha=central + 2.0 * steps * (backward - central))


def _stretched(_: Scene, done: Run, share: float) -> Run:
    return with_times(done, lambda time_s: time_s * (1.0 + share))


def _in_float32(_: Scene, done: Run, size: float) -> Run:
    return with_times(done, lambda time_s: rounded(time_s, size))


def _summed(_: Scene, done: Run) -> Run:
    """Time as the sum of the steps, each rounded."""

    def summed(time_s: Any) -> Any:
        return time_s[0] + np.cumsum(np.r_[0.0, np.full(len(time_s) - 1, done.dt_s * done.every)])

    return with_times(done, summed)


def _row_twice(_: Scene, done: Run) -> Run:
    """The row before stands in the place of one."""
    order = np.arange(moved(done).time_s.size)
    order[WHEN] -= 1
    return rows(done, order, slice(None))


def _half_the_rows(_: Scene, done: Run) -> Run:
    """Every second row is logged, twice."""
    order = np.arange(moved(done).time_s.size) // 2 * 2
    return rows(done, order, slice(None))


def _row_lost(_: Scene, done: Run) -> Run:
    keep = np.delete(np.arange(moved(done).time_s.size), WHEN)
    return rows(done, keep, keep)


def _row_more(_: Scene, done: Run) -> Run:
    keep = np.insert(np.arange(moved(done).time_s.size), WHEN, WHEN)
    return rows(done, keep, keep)


def _cut(_: Scene, done: Run, samples: float) -> Run:
    keep = slice(max(moved(done).time_s.size - round(samples), 1))
    return rows(done, keep, keep)


def _only_one(_: Scene, done: Run) -> Run:
    return rows(done, slice(1), slice(1))


_fault = partial(Fault, "clock")
FAULTS = (
    _fault("clock-late", "every sample is a later one", "CC102", late, 1.0, "sample", whole=True),
    _fault(
        "velocity-late",
        "velocities belong elsewhere",
        "CC106",
        in_log(_velocity_late),
        0.5,
        "steps",
    ),
    _fault(
        "acceleration-late",
        "accelerations differenced one-sidedly",
        "CC108",
        in_log(_one_sided),
        0.5,
        "steps",
        scenes=(FOURBAR,),  # half a step in the slider-crank is 0.6 of its limit
        needs=lambda name: engine(name).reports_accelerations,
    ),
    _fault("step-off", "the engine's step is too long", "CC102", _other_step, 1e-5, "dt"),
    _fault("stamps-off", "time stamps off the grid", "CC115", in_log(_stretched), 1e-9, "t"),
    _fault("stamps-float32", "time stamps in float32", "CC115", in_log(_in_float32), 2.0**-24, "t"),
    _fault("stamps-summed", "time stamps of a summed clock", "CC115", switched(_summed)),
    _fault("row-stale", "one row is the row before", "CC102", switched(_row_twice)),
    _fault("rows-half", "every second row is logged, twice", "CC102", switched(_half_the_rows)),
    _fault("row-lost", "one row is missing", "CC115", switched(_row_lost)),
    _fault("row-doubled", "one row is there twice", "CC115", switched(_row_more)),
    _fault("log-cut", "the log ends early", "CC115", in_log(_cut), 310.0, "samples", whole=True),
    _fault("log-of-one", "one sample is all that is logged", "CC115", switched(_only_one)),
)
