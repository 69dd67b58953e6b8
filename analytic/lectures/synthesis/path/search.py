"""Path generation: four-bars whose coupler curves go nearest to given points.

Starts come from tens of thousands of four-bars: with timing by their residuals, without it by the
shapes of their curves. Least squares then goes on from the best ones, in rounds that take more of
the points, fewer of the starts, and longer. The results are sorted out, given their cognates, and
examined by the reference: a mechanism with a defect is not returned.

Of P_j = O + G a exp(i phi_j) + Q u(phi_j) the first two terms span the same plane for all
four-bars, as the angles phi_j are given but for their start. With the residuals of the points, y,
and of the coupler's direction, w, the least sum of squares is |y|^2 - |w* y|^2 / |w|^2. It takes
one product for a shape and a start of the crank, so that tens of thousands can be compared.
"""

import itertools
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.examine import Examined, examine
from analytic.lectures.synthesis.path.atlas import between, closed_starts, open_starts, spread
from analytic.lectures.synthesis.path.candidate import FourBarCandidate, candidates, proposed
from analytic.lectures.synthesis.path.fit import (
    LARGEST,
    Fitted,
    Progress,
    SearchClock,
    fitted,
    placed,
)
from analytic.lectures.synthesis.path.task import (
    BOUNDS,
    FULL,
    Complexes,
    Family,
    PathTask,
    UnitPath,
    direction,
    lengths,
)
from models.array import Array
from models.errors import CrankcheckError

LOOKS = 16000
"""Number of shapes, each with a start of the crank, of a family and an assembly."""
BLOCK = 4000
"""Number of shapes that are computed together."""
APART = 0.12
"""Distance in the box of shapes and starts, below which starts mostly lead to the same fit."""


def timed_starts(path: UnitPath, count: int, seed: int, *, limited: bool) -> list[Fitted]:
    """Return the best shapes of either assembly for points with timing, the best first; with
    ``limited`` also those whose crank does not turn fully."""
    families = (*FULL, "limited") if limited else FULL
    found = [
        each
        for mirrored in (False, True)
        for family in families
        for each in _best(path.mirrored if mirrored else path, family, count, seed, mirrored)
    ]
    found.sort(key=lambda each: each.cost)
    return found[:count]


def _best(path: UnitPath, family: Family, count: int, seed: int, mirrored: bool) -> list[Fitted]:
    """Return those of one family, spread over its box."""
    share = spread(LOOKS, 4, seed)
    x, start = between(share[:, :3], BOUNDS[family]), math.tau * share[:, 3]
    blocks = [slice(k, k + BLOCK) for k in range(0, LOOKS, BLOCK)]
    cost = np.concatenate([_costs(path, family, x[:, own], start[own]) for own in blocks])
    kept: list[int] = []
    for k in np.argsort(cost, kind="stable")[: 20 * count].tolist():
        off = np.abs(share[kept] - share[k])
        off[:, 3] = np.minimum(off[:, 3], 1.0 - off[:, 3])  # the start of a crank is an angle
        if np.isfinite(cost[k]) and not np.any(np.max(off, axis=1) < APART):
            kept.append(k)
        if len(kept) == count:
            break
    assert path.turned is not None
    found = []
    for k in kept:
        phi = float(start[k]) + path.turned
        placing = placed(lengths(family, x[:, k]), phi, path.points)
        found.append(Fitted(family, x[:, k], placing, phi, float(cost[k]), mirrored))
    return found


def _costs(path: UnitPath, family: Family, x: Array, start: Array) -> Array:
    """Return the least sums of squares, inf where the mechanism is too large or does not close."""
    assert path.turned is not None
    crank = np.exp(1j * path.turned)
    common, triangle = np.linalg.qr(np.stack([np.ones_like(crank), crank], axis=1))
    a, b, c = (each[:, None] for each in lengths(family, x))
    u, cosine = direction((a, b, c), start[:, None] + path.turned)
    y, w = _left(path.points[None], common)[0], _left(u, common)
    square = np.sum(np.abs(w) ** 2, axis=1)
    product = w.conj() @ y
    arm = product / np.maximum(square, 1e-12)
    cost = np.sum(np.abs(y) ** 2) - np.abs(product) ** 2 / np.maximum(square, 1e-12)
    ground = ((path.points - arm[:, None] * u) @ common[:, 1].conj()) / (triangle[1, 1] * a[:, 0])
    large = (np.abs(arm) > LARGEST) | (np.abs(ground) > LARGEST)
    return np.where(large | (np.max(np.abs(cosine), axis=1) >= 1.0), np.inf, cost)


def _left(rows: Complexes, common: Complexes) -> Complexes:
    """Return the residuals of rows (E, N) outside the plane of two columns (N, 2)."""
    return np.asarray(rows - (rows @ common.conj()) @ common.T)


STARTS = 48
SOURCE = "Crankcheck: path generation by least squares"
STRAYED = 0.12
"""Largest distance of strayed starts from their entries, in the box of shapes."""
MOST_TRANSMISSION, MARGIN = math.radians(60.0), math.radians(1.0)
"""Largest least transmission angle, which few four-bars exceed, and the margin required in least
squares, which gives way a little."""
OWN = 0.7
"""Share of starts without timing that are entries themselves; the others stray from them."""


@dataclass(frozen=True)
class PathFit(FourBarCandidate):
    """Four-bar of a path, with its examination by the reference."""

    examined: Examined

    @property
    def proposal(self) -> Proposal:
        """The same as a proposal."""
        return self.examined.proposal


@dataclass(frozen=True)
class PathSearch:
    """Mechanisms of a search, the nearest to the points first; ``complete`` if it ended in time."""

    fits: tuple[PathFit, ...]
    complete: bool


def generate(
    task: PathTask,
    *,
    name: str = "path",
    count: int = 5,
    starts: int = STARTS,
    seed: int = 0,
    time_s: float = math.inf,
    progress: Progress | None = None,
    least_transmission_rad: float = 0.0,
) -> PathSearch:
    """Find four-bars whose coupler point goes through the points of a task, or as near as possible.

    Parameters
    ----------
    task
        The points [m], and the crank's angles if given.
    name
        Name of the scenes; a number is added.
    count
        The largest number of mechanisms.
    starts
        Number of starts of least squares. The same starts and seed give the same answer.
    seed
        Seed of the starts.
    time_s
        Time after which no further fit is begun [s]; the results by then are returned.
    progress
        Callback after each fit, with the finished share and the least RMS distance by then [m].
    least_transmission_rad
        The least transmission angle of a mechanism over its way [rad]. Without one, the nearest
        mechanisms to a path that none follows well are often near a dead centre.

    Returns
    -------
    PathSearch
        Distinct four-bars without a branch, circuit or order defect, cognates among them; by their
        RMS distance from the points, and for equal ones by transmission angle.

    Raises
    ------
    CrankcheckError
        No start, or no mechanism requested; no mechanism found that leads through the points.
    """
    if starts < 1 or count < 1:
        raise CrankcheckError(
            f"{count} mechanisms from {starts} starts were requested; give at least one of each"
        )
    if not 0.0 <= least_transmission_rad <= MOST_TRANSMISSION:
        raise CrankcheckError(
            f"a transmission angle of {math.degrees(least_transmission_rad):g} deg, at least, "
            f"was requested; give 0 to {math.degrees(MOST_TRANSMISSION):g} deg"
        )
    strict = least_transmission_rad + MARGIN * (least_transmission_rad > 0.0)
    clock = SearchClock(starts, time.monotonic() + time_s, task.radius_m, progress)
    fits = fitted(list(_starts(task, starts, seed)), task.unit, clock, strict)
    sound: list[PathFit] = []
    refused: list[str] = []
    least_sine = math.sin(least_transmission_rad)
    for candidate in candidates(fits, task):
        if len(sound) == count:
            break
        if candidate.least_sine < least_sine:
            refused.append("its transmission angle is smaller than requested")
            continue
        one = _examined(f"{name}-{len(sound) + 1}", candidate, task)
        if isinstance(one, PathFit):
            sound.append(one)
        else:
            refused.append(one)
    if not sound:
        nearest = f"; of the nearest one: {refused[0]}" if refused else ""
        raise CrankcheckError(
            f"no four-bar was found that leads through the {len(task.points)} points in their "
            f"order ({len(fits)} fits from {starts} starts{nearest}); take more starts or time, "
            "points that lie more evenly, or leave the crank's angles free"
        )
    clock.tell(1.0)
    return PathSearch(tuple(sound), clock.complete)


def _starts(task: PathTask, count: int, seed: int) -> Iterator[Fitted]:
    """Yield the starts of least squares, the most promising first."""
    if task.is_timed:
        yield from timed_starts(task.unit, count, seed, limited=not task.closed)
        return
    entries = (closed_starts if task.closed else open_starts)(task.unit, count)
    own = max(1, math.ceil(OWN * count))
    rng = np.random.default_rng(seed)
    strayed = (_strayed(entry, task.unit, rng) for entry in entries)
    yield from itertools.chain(entries[:own], itertools.islice(strayed, count - own))


def _strayed(entry: Fitted, path: UnitPath, rng: np.random.Generator) -> Fitted:
    """Return a start beside an entry: another shape, put over the points again."""
    low, high = np.array(BOUNDS[entry.family]).T
    off = STRAYED * (high - low) * rng.uniform(-1.0, 1.0, 3)
    x = np.clip(entry.x + off, low, high)
    own = path.mirrored if entry.mirrored else path
    return replace(entry, x=x, placing=placed(lengths(entry.family, x), entry.phi, own.points))


def _examined(name: str, candidate: FourBarCandidate, task: PathTask) -> PathFit | str:
    """Return a candidate without a defect by the reference, or the text of its defects."""
    try:
        examined = examine(proposed(name, SOURCE, candidate, task))
    except CrankcheckError as error:
        return str(error)  # such as a point on a pin, or a change point
    if examined.defects:
        return ", ".join(examined.defects)
    return PathFit(candidate.four_bar, candidate.crank_rad, candidate.off_m, examined)
