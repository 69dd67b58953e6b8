"""Where what acts on a machine is not smooth: over time, and over where and how fast it moves.

Between two kinks every load follows one formula. Those over time are known beforehand; all others
are told apart by `cells`: numbers that change where a load, a stroke or friction goes over to
another formula.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from analytic.free.machine import Machine
from models.array import Array
from models.characteristics import Characteristic, Tabulated
from models.loads import Load
from models.scene import Scene

MOST = 100_000
"""Kinks over time that are integrated from one to the next."""


def time_kinks(scene: Scene, until_s: float) -> list[float]:
    """The instants after 0 and before ``until_s`` at which a load over time has a kink."""
    found: set[float] = set()
    for load in scene.loads.values():
        if load.over == "time" and load.characteristic.kinks:
            found.update(_repeated(load.characteristic, until_s))
    return sorted(found)


def _repeated(characteristic: Characteristic, until_s: float) -> Iterator[float]:
    """The kinks of a characteristic in (0, until_s), in all its periods."""
    period = _period(characteristic)
    for kink in characteristic.kinks:
        if period is None:
            if 0.0 < kink < until_s:
                yield kink
            continue
        first = math.floor(-kink / period) + 1
        last = min(math.ceil((until_s - kink) / period), first + MOST)
        for turn in range(first, last):
            if 0.0 < kink + turn * period < until_s:
                yield kink + turn * period


def _period(characteristic: Characteristic) -> float | None:
    return characteristic.period if isinstance(characteristic, Tabulated) else None


def heeds_direction(scene: Scene) -> bool:
    """Whether anything asks which way the machine moves: friction, or a load on one stroke."""
    return bool(scene.friction) or any(load.stroke != "both" for load in scene.loads.values())


def is_kinked(scene: Scene) -> bool:
    """Whether anything has kinks over where or how fast the machine moves."""
    loads = scene.loads.values()
    return heeds_direction(scene) or any(
        load.over != "time" and load.characteristic.kinks for load in loads
    )


def cells(machine: Machine, u: Array, v: Array) -> Array:
    """For each kinked formula of the scene the number of its piece at coordinates and rates (T,),
    as rows (K, T)."""
    unit = machine.chart.unit(u)
    chunk = machine.moving(u, v, unit)
    rows = [np.sign(v)] if heeds_direction(machine.scene) else []
    rows += [np.sign(rate) for _, rate in machine.rubbing(unit)]
    for load in machine.scene.loads.values():
        sliding = None if load.slider is None else chunk.sliders[load.slider]
        if load.stroke != "both" and sliding is not None:
            rows.append(np.sign(sliding.speed))
        if load.over == "time" or not load.characteristic.kinks:
            continue
        if load.over == "angle":
            x = chunk.theta
        elif load.over == "omega":
            x = chunk.bodies[load.body].omega
        else:
            assert sliding is not None
            x = sliding.s if load.over == "displacement" else sliding.speed
        rows.append(_piece(load, np.broadcast_to(np.asarray(x, dtype=np.float64), u.shape)))
    return np.array([np.broadcast_to(row, u.shape) for row in rows]).reshape(len(rows), len(u))


def _piece(load: Load, x: Array) -> Array:
    """The number of the piece of a load's characteristic at ``x``."""
    kinks, period = np.array(load.characteristic.kinks), _period(load.characteristic)
    if period is None:
        return np.searchsorted(kinks, x, side="right").astype(np.float64)
    turns = np.floor((x - kinks[0]) / period)
    within = np.searchsorted(kinks, x - turns * period, side="right")
    closes = kinks[-1] - kinks[0] > period * (1.0 - 1e-9)  # the last row is the next first one
    return np.asarray(turns * len(kinks) + np.minimum(within, len(kinks) - closes))
