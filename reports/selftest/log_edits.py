"""Change one part of a log, and leave the rest."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.motion import LinkMotion, Motion, PointMotion
from models.scene import Scene
from sim.engine import Energy, Run

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
