"""Where what acts on a machine is not smooth: over time, and over where and how fast it moves.

Between two kinks every load follows one formula. Those over time are known beforehand; all others
are told apart by the number of their piece, which changes where a load, a stroke or friction goes
over to another formula (`Kinked`). So does the pull of a spring where its two points pass one
another: it turns over.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.forces.springs import spring_lengths
from analytic.free.machine import Machine
from models.array import Array
from models.scene import Scene
from models.springs import LineSpring, Spring


def heeds_direction(scene: Scene) -> bool:
    """Whether anything asks which way the machine moves: friction, or a load on one stroke."""
    return bool(scene.friction) or any(load.stroke != "both" for load in scene.loads.values())


def is_kinked(scene: Scene) -> bool:
    """Whether anything has kinks over where or how fast the machine moves."""
    loads = scene.loads.values()
    return (
        heeds_direction(scene)
        or any(load.over != "time" and load.characteristic.kinks for load in loads)
        or any(_turns_over(spring) for spring in scene.springs.values())
    )


@dataclass(frozen=True)
class Kinked:
    """What a formula of the scene goes over, ``x`` (T,), with its kinks there; a ``sign`` alone has
    one, at 0, and is a piece of its own in it."""

    x: Array
    kinks: Array
    period: float | None = None
    sign: bool = False

    @property
    def pieces(self) -> Array:
        """The number of its piece at each sample."""
        if self.sign:
            return np.sign(self.x)
        kinks, period, x = self.kinks, self.period, self.x
        if period is None:
            return np.searchsorted(kinks, x, side="right").astype(np.float64)
        turns = np.floor((x - kinks[0]) / period)
        within = np.searchsorted(kinks, x - turns * period, side="right")
        closes = kinks[-1] - kinks[0] > period * (1.0 - 1e-9)  # the last row is the next first one
        return np.asarray(turns * len(kinks) + np.minimum(within, len(kinks) - closes))

    def border(self, k: int) -> float:
        """The kink that is passed on the way from the sample before ``k``: the nearest to that."""
        before, after, kinks = float(self.x[k - 1]), float(self.x[k]), self.kinks
        if self.period is not None:
            turn = math.floor((before - kinks[0]) / self.period)
            kinks = np.concatenate([kinks + (turn + n) * self.period for n in (-1, 0, 1)])
        low, high = min(before, after), max(before, after)
        passed = kinks[(low <= kinks) & (kinks <= high)]
        if not passed.size:
            return 0.5 * (before + after)
        return float(passed.min() if after > before else passed.max())


def kinked(machine: Machine, u: Array, v: Array) -> list[Kinked]:
    """All formulas of the scene that have kinks, at coordinates and rates (T,)."""
    zero = np.zeros(1)

    @cache  # loads over the angle ask for no more than the driver
    def unit() -> Chunk:
        return machine.chart.unit(u)

    def whole(x: object) -> Array:
        return np.broadcast_to(np.asarray(x, dtype=np.float64), u.shape)

    rows = [Kinked(v, zero, sign=True)] if heeds_direction(machine.scene) else []
    if machine.scene.friction:
        rows += [Kinked(whole(rate), zero, sign=True) for _, rate in machine.rubbing(unit())]
    for load in machine.scene.loads.values():
        if load.stroke != "both" and load.slider is not None:
            rows.append(Kinked(whole(unit().sliders[load.slider].speed * v), zero, sign=True))
        if load.over == "time" or not load.characteristic.kinks:
            continue
        if load.over == "angle":
            x = machine.chart.driver(u)[0]
        elif load.over == "omega":
            x = unit().bodies[load.body].omega * v
        else:
            assert load.slider is not None
            sliding = unit().sliders[load.slider]
            x = sliding.s if load.over == "displacement" else sliding.speed * v
        kinks = np.array(load.characteristic.kinks)
        rows.append(Kinked(whole(x), kinks, load.characteristic.repeats_after))
    if any(_turns_over(spring) for spring in machine.scene.springs.values()):
        rows += _turning_over(machine.scene, unit(), u)
    return rows


def _turns_over(spring: Spring) -> bool:
    """Whether it pulls with something where it has no length."""
    return isinstance(spring, LineSpring) and spring.rate * spring.free != 0.0


def _turning_over(scene: Scene, unit: Chunk, u: Array) -> Iterator[Kinked]:
    """Springs whose two points may come to one place between the samples: the way between these,
    times its own derivative, goes through 0 there, as it does where they are nearest."""
    with np.errstate(all="ignore"):  # of no length it has no rate
        stretched = [*spring_lengths(scene, unit)]
    for spring, length, rate in stretched:
        reach = np.nanmax(np.abs(rate), initial=0.0) * np.abs(np.diff(u)).max(initial=0.0)
        if _turns_over(spring) and not length.min() > reach:
            yield Kinked(np.nan_to_num(length * rate), np.zeros(1), sign=True)
