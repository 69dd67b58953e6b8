"""How far a motion with elastic links is to be trusted: what the next finer description of its
links changes, and what the linear theory leaves out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from analytic.elastic.discretisation import Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.array import Array
from models.motion import Motion
from reports.output.numbers import error_text

SAMPLES = 73
"""Instants of a motion that are compared."""


@dataclass(frozen=True)
class Differences:
    """The largest differences of two motions: of a deflection over the largest of its link (the
    worst link counts), of an angle [rad], of the torque over its largest."""

    deflection: float
    angle_rad: float
    torque: float

    @staticmethod
    def of(one: Motion, other: Motion) -> Differences:
        """Between motions at the same instants."""
        bent = [
            _over(shape.middle, other.elastic[name].middle) for name, shape in one.elastic.items()
        ]
        turned = [
            float(np.max(np.abs(link.theta - other.links[name].theta)))
            for name, link in one.links.items()
        ]
        torques = (each.forces.torque for each in (one, other) if each.forces is not None)
        return Differences(max(bent, default=0.0), max(turned, default=0.0), _over(*torques))


def _over(one: Array, other: Array) -> float:
    largest = float(np.nanmax(np.abs(other), initial=0.0))
    return float(np.nanmax(np.abs(one - other), initial=0.0)) / (largest or 1.0)


def certainty(motion: DrivenElasticMotion) -> list[str]:
    """What a motion may be off by, in sentences. Raises CrankcheckError where a finer one can not
    be had."""
    if isinstance(motion.by, Segments):
        return []  # it is what an engine has, and not the beam
    time_s = np.linspace(0.0, motion.until_s, SAMPLES)
    own = motion.at(time_s)
    finer = Differences.of(own, replace(motion, by=motion.by.finer).at(time_s))
    notes = [
        f"As the next finer description has it, deflections are off by about "
        f"{error_text(finer.deflection)} of the largest, angles by {error_text(finer.angle_rad)} "
        f"rad, the torque by {error_text(finer.torque)} of its largest."
    ]
    if not motion.stiffened:
        short = Differences.of(own, replace(motion, stiffened=True).at(time_s))
        notes.append(
            "What the linear theory leaves out, the shortening of bent links, changes deflections "
            f"by {100.0 * short.deflection:.3g} % of the largest; engines are held to the motion "
            "with it."
        )
    return notes
