"""A motion with elastic links at many instants: a few at a time, as each takes the places of every
link with it; and how links are bent over their whole length."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.released import ReleasedElasticMotion
from analytic.multibody.energy_balance import EnergyBalance
from models.array import Array
from models.motion import Motion

ElasticHistory = DrivenElasticMotion | ReleasedElasticMotion
"""What follows a law, and what is let go."""
TOGETHER = 2000
"""Instants: some 100 MB."""


def sampled(motion: ElasticHistory, time_s: Array) -> Motion:
    """The motion at times [s], (T,), in any order."""
    order = np.argsort(time_s, kind="stable")
    whole = Motion.joined([motion.at(time_s[part]) for part in _parts(order)])
    if np.array_equal(order, np.arange(order.size)):
        return whole
    back = np.argsort(order)
    asked = replace(whole, time_s=time_s, forces=None).each_series(lambda series: series[back])
    return replace(asked, forces=whole.forces and whole.forces.stretch(back))


def bent(motion: ElasticHistory, time_s: Array, shares: Array) -> dict[str, Array]:
    """How far elastic links are from the line between their pins, by name [m], (T, K), at times [s]
    (T,) in ascending order, and at shares (K,) of the length from the first pin to the second."""
    found: dict[str, list[Array]] = {}
    for part in _parts(np.arange(time_s.size)):
        q = motion.coordinates_at(time_s[part])
        for name, (body, own) in motion.assembly.elastic.items():
            places = body.deflections(q[:, own], shares * body.length_m)
            found.setdefault(name, []).append(places)
    return {name: np.concatenate(each) for name, each in found.items()}


def energies(motion: ReleasedElasticMotion, time_s: Array) -> EnergyBalance:
    """Of what is let go, at times [s], (T,) in ascending order."""
    parts = [motion.energy(time_s[part]) for part in _parts(np.arange(time_s.size))]
    return EnergyBalance.joined(parts)


def _parts(order: NDArray[np.intp]) -> Iterator[NDArray[np.intp]]:
    yield from np.array_split(order, max(1, -(-order.size // TOGETHER)))
