"""How far the motion of elastic links is to be trusted: what finer shapes and windows change it by.

Where the error at least halves from a description to the next finer one, it is at most twice that
change.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion


@dataclass(frozen=True)
class ElasticDoubt:
    """The largest changes over all samples: ``middle_m`` and ``extension_m`` of each elastic link
    [m], ``theta_rad`` of each link [rad], and ``torque_n_m`` of the driver [N m]."""

    middle_m: Mapping[str, float]
    extension_m: Mapping[str, float]
    theta_rad: Mapping[str, float]
    torque_n_m: float

    @staticmethod
    def between(motion: Motion, finer: Motion) -> ElasticDoubt:
        """Of two motions at the same instants, with their forces."""
        assert motion.forces is not None
        assert finer.forces is not None
        return ElasticDoubt(
            {
                name: _largest(own.middle - finer.elastic[name].middle)
                for name, own in motion.elastic.items()
            },
            {
                name: _largest(own.extension - finer.elastic[name].extension)
                for name, own in motion.elastic.items()
            },
            {
                name: _largest(own.theta - finer.links[name].theta)
                for name, own in motion.links.items()
            },
            _largest(motion.forces.torque - finer.forces.torque),
        )


def _largest(change: Array) -> float:
    return float(np.abs(change).max(initial=0.0))
