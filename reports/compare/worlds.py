"""Runs of one batch: worlds that hold the motion of others, and differences from runs alone."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion, each_array
from models.scene import Scene
from sim.engine import Run

MOST_ALONE = 16
"""Most worlds of a batch that are also run alone."""
LOOKS = 40
"""Samples at which a world is compared with the references of all others."""


@dataclass(frozen=True)
class Batch:
    """Worlds of a batch, which are numbered from 0.

    ``worst`` is the world with the largest part of a limit; ``error`` is the largest one of place,
    pure, in world ``error_in``. Of ``lost`` worlds there is no log; ``holds`` has the worlds with
    the motion of another, by that of each. ``alone`` are those that were run alone too, and
    ``difference`` is the largest of place from these, in rad or over the longest link, in world
    ``at``; ``exact`` if all series are the same to the bit. It is at most ``bound``, because of
    ``why``; "" for an engine whose worlds are to be the same. Costs are of a step of a world
    [microseconds], logged: in the batch, and median of those alone.
    """

    count: int
    worst: int
    error: float
    error_in: int
    lost: int
    holds: Mapping[int, int]
    alone: tuple[int, ...]
    difference: float
    at: int
    exact: bool
    bound: float
    why: str
    us_per_step: float
    us_alone: float


def evenly(count: int) -> tuple[int, ...]:
    """Return the worlds that are run alone too: evenly spread, the first and the last of them."""
    number = min(count, MOST_ALONE)
    return tuple(round(k) for k in np.linspace(0, count - 1, number).tolist())


def placed(motion: Motion, size: float) -> Array:
    """Return the places of all links, points and sliders, (T, n): directions of links, and others
    over ``size`` [m]."""
    angles = [link.theta for link in motion.links.values()]
    columns = [turn(each) for each in angles for turn in (np.cos, np.sin)]
    columns += [each for point in motion.points.values() for each in point.position.T / size]
    columns += [slider.displacement / size for slider in motion.sliders.values()]
    return np.column_stack(columns)


def holders(scene: Scene, runs: Sequence[Run]) -> dict[int, int]:
    """Return the worlds that hold the motion of another, by that of each.

    Such a run is nearer to the reference of another world than half the distance of that from its
    own reference, so that it is nearer to it than to its own.
    """
    size, first = scene.longest_m, runs[0]
    looks = np.unique(np.linspace(0, first.steps // first.every, LOOKS).astype(int))
    starts = np.array([run.start_s for run in runs])
    times = starts[:, None] + first.dt_s * first.every * looks
    truth = placed(solve(scene, times.ravel(), bound=False), size).reshape(*times.shape, -1)
    found = {}
    for world, run in enumerate(runs):
        seen = looks[looks < (0 if run.motion is None else run.motion.time_s.size)]
        if run.motion is None or not seen.size:
            continue
        there = truth[:, : seen.size]
        apart = np.abs(there - placed(run.motion, size)[seen]).max(axis=(1, 2))
        near = int(np.argmin(np.nan_to_num(apart, nan=np.inf)))
        if 2.0 * apart[near] < np.abs(there[near] - there[world]).max():
            found[world] = near
    return found


def difference(scene: Scene, run: Run, alone: Run) -> tuple[float, bool]:
    """Return the largest difference of place of two runs, and if all their series are the same to
    the bit; infinite where one is shorter."""
    if run.motion is None or alone.motion is None:
        return np.inf, False
    same, size = list[bool](), scene.longest_m

    def compare(one: Array, other: Array) -> Array:
        same.append(np.array_equal(one, other, equal_nan=True))
        return one

    for name in ("links", "points", "sliders"):
        each_array(compare, getattr(run.motion, name), getattr(alone.motion, name))
    one, other = placed(run.motion, size), placed(alone.motion, size)
    if one.shape != other.shape:
        return np.inf, False
    apart = np.nan_to_num(np.abs(one - other), nan=np.inf)
    return float(apart.max()), all(same)
