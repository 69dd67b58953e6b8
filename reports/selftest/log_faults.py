"""Faults of a log: of its clock, its numbers and missing parts; and the edits that plant them."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.motion import LinkMotion, Motion, PointMotion
from models.scene import Scene
from reports.selftest.fault import FOURBAR, Fault, Plant, in_log, planting, switched
from sim.engine import Energy, Run
from sim.registry import engine
from sim.run import run
from sim.run.spoil import rounded

Rows = slice | Array | NDArray[np.intp]
SEED = 20240229
WHEN = 100
"""Sample of single faults: well within the run, behind the start."""


def moved(done: Run) -> Motion:
    """Return the motion of a run that has one."""
    assert done.motion is not None
    return done.motion


def last(scene: Scene) -> str:
    """Return the link whose log is spoilt: the last one, which is not the driver."""
    return list(scene.links)[-1]


def output(scene: Scene, done: Run) -> LinkMotion:
    """Return the motion of the last link."""
    return moved(done).links[last(scene)]


def with_link(done: Run, name: str, **changed: Array) -> Run:
    """Return the run with other series of one link."""
    motion = moved(done)
    links = {**motion.links, name: replace(motion.links[name], **changed)}
    return replace(done, motion=replace(motion, links=links))


def of_output(
    series: str, change: Callable[[Array, float], Array], link: Callable[[Scene], str] = last
) -> Callable[[Scene, Run, float], Run]:
    """Change a series of the last link, or of another, by a size."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        own = getattr(moved(done).links[link(scene)], series)
        return with_link(done, link(scene), **{series: change(own, size)})

    return changed


def with_points(done: Run, change: Callable[[Array], Array]) -> Run:
    """Return the run with the positions, velocities and accelerations of all points changed."""
    motion = moved(done)
    points = {n: PointMotion(*map(change, vars(p).values())) for n, p in motion.points.items()}
    return replace(done, motion=replace(motion, points=points))


def taken(
    own: Motion,
    other: Motion,
    change: Callable[[Array, Array], Array] = lambda _, right: right,
    **series: Sequence[str],
) -> Motion:
    """Return a motion with some ``series`` of its links, points or sliders taken from another, or
    changed by those of it."""

    def body(kind: str, name: str, one: Any) -> Any:
        right = getattr(other, kind)[name]
        changed = {each: change(getattr(one, each), getattr(right, each)) for each in series[kind]}
        return replace(one, **changed)

    changed: dict[str, Any] = {
        kind: {name: body(kind, name, one) for name, one in getattr(own, kind).items()}
        for kind in series
    }
    return replace(own, **changed)


def spoilt(series: Array, at: int | slice, value: float) -> Array:
    """Return the series with a value added to one stretch."""
    wrong = series.copy()
    wrong[at] += value
    return wrong


def to_digits(series: Array, size: float) -> Array:
    """Round the series to multiples of a size."""
    return np.asarray(np.rint(series / size) * size if size else series)


def noisy(series: Array, size: float) -> Array:
    """Return the series with noise (normal), the same at every call."""
    noise = np.random.default_rng(SEED).standard_normal(series.shape)
    return np.asarray(series + size * noise)


def every_series(done: Run, change: Callable[[Array], Array]) -> Run:
    """Return the run with every logged series changed, but not their instants."""
    gaps = {name: change(gap) for name, gap in done.gaps.items()}
    return replace(done, motion=moved(done).each_series(change), gaps=gaps)


def with_times(done: Run, change: Callable[[Array], Array]) -> Run:
    """Return the run with all its time stamps changed."""
    assert done.velocity_time_s is not None
    assert done.acceleration_time_s is not None
    return replace(
        done,
        motion=replace(moved(done), time_s=change(moved(done).time_s)),
        velocity_time_s=change(done.velocity_time_s),
        acceleration_time_s=change(done.acceleration_time_s),
    )


def rows(done: Run, keep: Rows, stamps: Rows) -> Run:
    """Return the samples ``keep`` with the time stamps ``stamps``."""
    energy = done.energy and Energy(done.energy.kinetic_j[keep], done.energy.potential_j[keep])
    kept = replace(every_series(done, lambda series: series[keep]), energy=energy)
    return with_times(kept, lambda t: t[stamps])


Distortion = Callable[[Array, float], Array]
"""Change of a series by a size."""
Numbers = NDArray[np.intp]


@planting
def late(size: float, *args: Any, steps: int, every: int, **options: Any) -> Run:
    """Shift every sample to so many samples later."""
    samples = round(size)
    longer = run(*args, steps=steps + samples * every, every=every, **options)
    kept = steps // every + 1
    return replace(rows(longer, slice(samples, None), slice(kept)), steps=steps)


@planting
def _other_step(share: float, *args: Any, dt_s: float, **options: Any) -> Run:
    """Lengthen the engine's step, and keep the stamps of the requested one."""
    done = run(*args, dt_s=dt_s * (1.0 + share), **options)
    return replace(with_times(done, lambda t: t / (1.0 + share)), dt_s=dt_s)


def _velocity_late(_: Scene, done: Run, steps: float) -> Run:
    assert done.velocity_time_s is not None
    return replace(done, velocity_time_s=done.velocity_time_s + steps * done.dt_s)


def _one_sided(scene: Scene, done: Run, steps: float) -> Run:
    """Take accelerations as backward differences of the logged velocities: half a step late."""
    omega = output(scene, done).omega
    central = np.gradient(omega, done.dt_s * done.every, edge_order=2)
    backward = np.diff(omega, prepend=2.0 * omega[0] - omega[1]) / (done.dt_s * done.every)
    return with_link(done, last(scene), alpha=central + 2.0 * steps * (backward - central))


def _times(change: Distortion) -> Plant:
    return in_log(lambda _, done, size: with_times(done, lambda time_s: change(time_s, size)))


def _summed(_: Scene, done: Run) -> Run:
    """Take time as the sum of the steps, each rounded."""

    def summed(time_s: Any) -> Any:
        return time_s[0] + np.cumsum(np.r_[0.0, np.full(len(time_s) - 1, done.dt_s * done.every)])

    return with_times(done, summed)


def _rows(keep: Callable[[Numbers], Numbers], *, stamped: bool) -> Plant:
    """Keep some of the numbered rows, ``stamped`` as they were, or as the rows in their places."""

    def changed(_: Scene, done: Run) -> Run:
        kept = keep(np.arange(moved(done).time_s.size))
        return rows(done, kept, kept if stamped else slice(None))

    return switched(changed)


def _cut(_: Scene, done: Run, samples: float) -> Run:
    keep = slice(max(moved(done).time_s.size - round(samples), 1))
    return rows(done, keep, keep)


_clock = partial(Fault, "clock")
CLOCK = (
    _clock("clock-late", "every sample is a later one", "CC102", late, 1.0, "sample", whole=True),
    _clock("velocity-late", "velocities belong elsewhere", "CC106", in_log(_velocity_late),
           0.5, "steps"),
    _clock("acceleration-late", "accelerations differenced one-sidedly", "CC108",
           in_log(_one_sided), 0.5, "steps",
           scenes=(FOURBAR,),  # half a step in the slider-crank is 0.6 of its limit
           needs=lambda name: engine(name).reports_accelerations),
    _clock("step-off", "the engine's step is too long", "CC102", _other_step, 1e-5, "dt"),
    _clock("stamps-off", "time stamps off the grid", "CC115",
           _times(lambda time_s, share: time_s * (1.0 + share)), 1e-9, "t"),
    _clock("stamps-float32", "time stamps in float32", "CC115", _times(rounded), 2.0**-24, "t"),
    _clock("stamps-summed", "time stamps of a summed clock", "CC115", switched(_summed)),
    _clock("row-stale", "one row is the row before", "CC102",
           _rows(lambda n: n - (n == WHEN), stamped=False)),
    _clock("rows-half", "every second row is logged, twice", "CC102",
           _rows(lambda n: n // 2 * 2, stamped=False)),
    _clock("row-lost", "one row is missing", "CC115",
           _rows(lambda n: np.delete(n, WHEN), stamped=True)),
    _clock("row-doubled", "one row is there twice", "CC115",
           _rows(lambda n: np.insert(n, WHEN, WHEN), stamped=True)),
    _clock("log-cut", "the log ends early", "CC115", in_log(_cut), 310.0, "samples", whole=True),
    _clock("log-of-one", "one sample is all that is logged", "CC115",
           _rows(lambda n: n[:1], stamped=True)),
)  # fmt: skip


AFTER = slice(WHEN, None)
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""


def _angle(change: Distortion, link: Callable[[Scene], str] = last) -> Plant:
    return in_log(of_output("theta", change, link))


def _crank(scene: Scene) -> str:
    return scene.driver.link


def _omega(change: Distortion) -> Plant:
    """Change the last link's angular velocity, by a multiple of the driver's speed."""
    own = of_output("omega", change)
    return in_log(lambda scene, done, size: own(scene, done, size * scene.pace_rad_s))


def _all_of(change: Callable[[Array], Array]) -> Distortion:
    return lambda series, size: change(series) if size else series


def _at(samples: int | slice) -> Distortion:
    return lambda series, size: spoilt(series, samples, size)


def _turn_more(theta: Array, size: float) -> Array:
    return spoilt(theta, WHEN, 2 * np.pi * size)


def _ramp(theta: Array, size: float) -> Array:
    return theta + size * np.linspace(0.0, 1.0, len(theta))


def _wrapped(theta: Array) -> Array:
    return np.asarray(np.remainder(theta + np.pi, 2 * np.pi) - np.pi)


def _parted(scene: Scene, done: Run, size: float) -> Run:
    """Open every pin more and more, up to a share of the longest link."""
    wider = size * scene.longest_m * np.linspace(0.0, 1.0, len(moved(done).time_s))
    return replace(done, gaps={name: gap + wider for name, gap in done.gaps.items()})


_value = partial(Fault, "log")
VALUES = (
    _value("sign-flipped", "an angle has the other sign", "CC103", _angle(_all_of(np.negative))),
    _value("degrees", "an angle in degrees", "CC103", _angle(_all_of(np.degrees))),
    _value("whole-turn", "a whole turn more at one sample", "CC103", _angle(_turn_more)),
    _value("crank-whole-turn", "the same, of the crank", "CC102", _angle(_turn_more, _crank)),
    _value("crank-wrapped", "the crank's angle within +-180 deg", "CC102",
           _angle(_all_of(_wrapped), _crank)),
    _value("float32-log", "every number of the log in float32", "CC102",
           in_log(lambda _, done, size: every_series(done, lambda x: rounded(x, size))),
           2.0**-24, "of it"),
    _value("rounded-log", "an angle of few digits", "CC114", _angle(to_digits), 1e-5, "rad"),
    _value("noise", "noise on an angle (normal)", "CC114", _angle(noisy), 1e-5, "rad"),
    _value("drift", "an angle drifts off", "CC103", _angle(_ramp), 1e-3, "rad"),
    _value("slow-drift", "the same, within this step's limit", "CC110", _angle(_ramp),
           1.5e-4, "rad", finer=True),
    _value("spike", "an angle is off at one sample", "CC114", _angle(_at(WHEN)), 1e-5, "rad"),
    _value("jump", "an angle jumps, and stays", "CC107", _angle(_at(AFTER)), 1e-4, "rad"),
    _value("velocity-spike", "a velocity is off at one sample", "CC106", _omega(_at(WHEN)),
           1e-2, "w"),
    _value("rpm", "a velocity in revolutions a minute", "CC106",
           _omega(_all_of(lambda omega: omega * 30.0 / np.pi))),
    _value("wrong-start", "a velocity is off at the start", "CC116", _omega(_at(START)), 5e-2, "w"),
    _value("wild-start", "a velocity of 1e6 rad/s at the start", "CC116",
           in_log(of_output("omega", lambda x, size: spoilt(x, START, 1e6 * size)))),
    _value("loop-opens", "the pins come apart", "CC135", in_log(_parted), 0.1, "L"),
)  # fmt: skip


def _with(series: str, at: int, value: float) -> Callable[[Scene, Run], Run]:
    change = of_output(series, lambda own, _: spoilt(own, at, value))
    return lambda scene, done: change(scene, done, 1.0)


def _without(bodies: str, name: Callable[[Scene], str]) -> Callable[[Scene, Run], Run]:
    def changed(scene: Scene, done: Run) -> Run:
        kept: dict[str, Any] = {bodies: dict(getattr(moved(done), bodies))}
        kept[bodies].pop(name(scene), None)
        return replace(done, motion=replace(moved(done), **kept))

    return changed


def _silent(scene: Scene, done: Run) -> Run:
    """Report accelerations, of one link NaN throughout."""
    alpha = np.full_like(output(scene, done).alpha, np.nan)
    return replace(with_link(done, last(scene), alpha=alpha), reports_accelerations=True)


MISSING = tuple(
    Fault("missing", name, what, "CC109", switched(change))
    for name, what, change in (
        ("nan-at-end", "the last angle is NaN", _with("theta", -1, np.nan)),
        ("infinity", "one velocity is infinite", _with("omega", WHEN, np.inf)),
        ("link-absent", "a link is not in the log", _without("links", last)),
        ("point-absent", "a point is not in the log", _without("points", lambda _: "C")),
        ("gaps-absent", "no pin's gap is in the log", lambda _, done: replace(done, gaps={})),
        ("acceleration-nan", "accelerations of one link are NaN", _silent),
    )
)
