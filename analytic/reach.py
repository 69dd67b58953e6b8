"""The driver's reachable range: the angles in which every dyad closes.

Found by the shortage of closure over a turn of the driver, its sign changes refined by bisection.
Source: rotatability of a driver, e.g. Norton, Design of Machinery, section 4.10 (limit positions);
for the four-bar `analytic.mechanism.fourbar` has the closed form, and a test holds this one to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.driven import driver_scale, told
from models.array import Array, Mask
from models.scene import Scene

SCAN = 1440
"""Angles of the first look at a turn; where it is nearest to closing, or to opening, between two of
them, it is looked at closer."""
NARROW = 20 * math.tau / SCAN
"""A range of fewer looks [rad] is looked at anew."""
ZOOMS, FINER = 5, 33
"""How often the smallest shortage between looks is looked for closer, and in how many places."""

Range = tuple[float, float]
Stretched = Callable[[Array], Chunk]


def shortage(stretched: Stretched, theta: Array) -> Array:
    """By how much the mechanism fails to close at driver angles ``theta`` (T,) [m]; <= 0 closes."""
    chunk = stretched(theta)
    short = np.full(theta.shape, -np.inf)
    for value in chunk.shortage.values():
        short = np.maximum(short, np.nan_to_num(value, nan=np.inf))
    return short


def ranges(stretched: Stretched, turns: int = 1) -> list[Range]:
    """The reachable driver angles within a turn, as (from, to) [rad] in increasing order.

    [(-pi, pi)] where the driver turns fully; [] where the mechanism cannot be assembled at all.
    A range may run beyond pi where it holds that angle. What is followed along the driver may go
    on for more than a turn and end all the same: it is looked at over so many ``turns`` both ways,
    and told as it is where it is not alike in each.
    """
    if turns > 1 and (found := _over_turns(stretched, turns)) is not None:
        return found
    looks = np.linspace(-math.pi, math.pi, SCAN + 1)
    grid = with_valleys(lambda theta: shortage(stretched, theta), looks)
    closes = shortage(stretched, grid) <= 0.0
    if closes.all():
        return [(-math.pi, math.pi)]
    edges = np.flatnonzero(closes[1:] != closes[:-1])
    if not len(edges):
        return []
    borders = _bisect(stretched, grid[edges], grid[edges + 1], closes[edges])
    opens = [float(a) for a, was in zip(borders, closes[edges], strict=True) if not was]
    ends = [float(a) for a, was in zip(borders, closes[edges], strict=True) if was]
    if closes[0]:  # the range that holds the angle pi: its end is a turn after the first
        ends = [*ends[1:], ends[0] + math.tau]
    wholes = zip(opens, ends, strict=True)
    return [part for whole in wholes for part in _closer(stretched, whole)]


def _closer(stretched: Stretched, whole: Range) -> list[Range]:
    """A range that is so narrow that few looks fell into it, looked at anew: it may have gaps."""
    low, high = whole
    if high - low > NARROW:
        return [whole]
    grid = np.linspace(low, high, SCAN + 1)
    closes = shortage(stretched, grid) <= 0.0
    closes[[0, -1]] = True
    edges = np.flatnonzero(closes[1:] != closes[:-1])
    borders = _bisect(stretched, grid[edges], grid[edges + 1], closes[edges]).tolist()
    ends: list[float] = [low, *borders, high]
    return list(zip(ends[::2], ends[1::2], strict=True))


def with_valleys(shortage_at: Callable[[Array], Array], theta: Array) -> Array:
    """The looks, and closer ones where a mechanism is nearest to closing, or to opening, between
    two of them, so that no narrow part is passed over, nor one of two beside a look."""
    short = shortage_at(theta)
    size = np.abs(short[1:-1])
    near = (size <= np.abs(short[:-2])) & (size <= np.abs(short[2:]))
    places = np.flatnonzero(near) + 1
    if not places.size:
        return theta
    low, high, sign = theta[places - 1], theta[places + 1], np.sign(short[places])
    share, first = np.linspace(0.0, 1.0, FINER), np.zeros(0)
    for _ in range(ZOOMS):
        looks = low[:, None] + (high - low)[:, None] * share
        first = first if first.size else looks.ravel()
        value = shortage_at(looks.ravel()).reshape(looks.shape) * sign[:, None]
        best = np.clip(np.argmin(value, axis=1), 1, FINER - 2)
        rows = np.arange(len(best))
        low, high, tip = looks[rows, best - 1], looks[rows, best + 1], looks[rows, best]
    return np.unique(np.concatenate([theta, first, tip]))


def _over_turns(stretched: Stretched, turns: int) -> list[Range] | None:
    """The ranges over several turns both ways; None where each turn is like the next."""
    grid = np.linspace(-turns * math.tau, turns * math.tau, 2 * turns * SCAN + 1)
    closes = shortage(stretched, grid) <= 0.0
    unlike = np.count_nonzero(closes[SCAN:] != closes[:-SCAN])
    if unlike <= 2 * turns:  # looks beside an end, by rounding
        return None
    edges = np.flatnonzero(closes[1:] != closes[:-1])
    borders = _bisect(stretched, grid[edges], grid[edges + 1], closes[edges]).tolist()
    ends = [float(grid[0])] * bool(closes[0]) + borders + [float(grid[-1])] * bool(closes[-1])
    return list(zip(ends[::2], ends[1::2], strict=True))


def _bisect(stretched: Stretched, low: Array, high: Array, closes_low: Mask) -> Array:
    """The angles at which closing begins or ends, each on the side that closes."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        same = (shortage(stretched, middle) <= 0.0) == closes_low
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.where(closes_low, low, high)


def describe_reach(scene: Scene, stretched: Stretched, turns: int = 1) -> str:
    """The reachable range in words, for a message; ``turns`` as of `ranges`."""
    reachable, driver = ranges(stretched, turns), scene.driver
    if not reachable:
        grid = np.linspace(-math.pi, math.pi, SCAN + 1)
        short = shortage(stretched, grid)
        best = int(np.argmin(short))
        where = "angle" if driver.slider is None else "place"
        return (
            f"It cannot be assembled at any {where} of {driver.joint}: it comes nearest at "
            f"{told(scene, grid[best])}, open by {short[best]:.3g} m; change a length."
        )
    slides, scale = driver.slider is not None, driver_scale(scene)
    unit, by = ("m", scale) if slides else ("deg", math.degrees(1.0))
    spans = " and ".join(f"{a * by:.6g} to {b * by:.6g} {unit}" for a, b in reachable)
    more_than_one = any(high - low > math.tau for low, high in reachable)
    from_there = "" if slides or more_than_one else " (and whole turns from there)"
    return f"{driver.joint} can stand at {spans}{from_there}."
