"""How far a motion with elastic links is to be trusted: what the next finer description of its
links changes, and what the linear theory leaves out."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from analytic.elastic.discretisation import Discretisation, ElasticDoubt, Elements, Segments
from analytic.elastic.elastic_motion import ElasticHistory
from analytic.elastic.released import ReleasedElasticMotion
from models.array import Array
from models.motion import Motion
from reports.describe.elastic_words import described
from reports.output.numbers import error_text

ROUNDING = 1e-13
"""To which joints are closed, and equations met: differences are no less."""
SAMPLES = 73
"""Instants of a motion that are compared."""


class Shares(NamedTuple):
    """The largest distances of a motion from another: of a deflection over the largest of its link
    in that one (the worst link counts), of an angle [rad], of the torque over its largest."""

    deflection: float
    angle_rad: float
    torque: float


def _shares(one: Motion, other: Motion) -> Shares:
    """Of motions at the same instants; none is less than rounding."""
    apart = ElasticDoubt.between(one, other)
    bent = [_over(off, other.elastic[name].middle) for name, off in apart.middle_m.items()]
    turned = [float(off.max()) for off in apart.theta_rad.values()]
    acting = other.forces.torque if other.forces is not None else np.zeros(0)
    every = max(bent, default=0.0), max(turned, default=0.0), _over(apart.torque_n_m, acting)
    return Shares(*(max(ROUNDING, each) for each in every))


def _over(off: Array, series: Array) -> float:
    largest = float(np.nanmax(np.abs(series), initial=0.0))
    return float(np.nanmax(off, initial=0.0)) / (largest or 1.0)


def certainty(motion: ElasticHistory) -> list[str]:
    """What a motion may be off by, in sentences. Raises CrankcheckError where another one can not
    be had."""
    if isinstance(motion.by, Segments):
        return []  # it is what an engine has, and not the beam
    time_s = np.linspace(0.0, motion.until_s, SAMPLES)
    own = motion.at(time_s)
    notes = [_by_other_shapes(motion, time_s, own)]
    if not motion.stiffened:
        short = _shares(own, replace(motion, stiffened=True).at(time_s))
        notes.append(
            "What the linear theory leaves out, the shortening of bent links, changes deflections "
            f"by {100.0 * short.deflection:.3g} % of the largest; engines are held to the motion "
            "with it."
        )
    return notes


def _by_other_shapes(motion: ElasticHistory, time_s: Array, own: Motion) -> str:
    """By the next finer description; of elements, and of what is let go, which take long, by one of
    fewer shapes, whose error is the larger one, if there are any fewer."""
    fewer = coarser(motion.by)
    slow = isinstance(motion, ReleasedElasticMotion) or isinstance(motion.by, Elements)
    if not slow or described(motion.scene, fewer) == described(motion.scene, motion.by):
        found = _shares(own, motion.finer.at(time_s))
        told = [
            f"deflections are off by about {error_text(found.deflection)} of the largest",
            f"angles by {error_text(found.angle_rad)} rad",
        ]
        if own.forces is not None and own.forces.torque.any():
            told.append(f"the torque by {error_text(found.torque)} of its largest")
        return f"As the next finer description has it, {', '.join(told)}."
    found = _shares(replace(motion, by=fewer).at(time_s), own)
    return (
        f"By {described(motion.scene, fewer)} deflections are off this by "
        f"{error_text(found.deflection)} of the largest, angles by {error_text(found.angle_rad)} "
        "rad; this is off by less."
    )


def coarser(by: Discretisation) -> Discretisation:
    """About half as many shapes of each kind, and at least one."""
    if isinstance(by, Elements | Segments):
        return replace(by, count=max(1, by.count // 2))
    return replace(by, across=max(1, (by.across + 1) // 2), along=max(1, by.along // 2))
