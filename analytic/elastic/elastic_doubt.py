"""How far a motion with elastic links is from others: what it may be off by, where these are finer.

Where the error at least halves from a description to the next finer one, it is at most twice that
change.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion


@dataclass(frozen=True)
class ElasticDoubt:
    """The largest distances from any of the others, (T,) each: ``middle_m`` and ``extension_m`` of
    each elastic link [m], ``theta_rad`` of each link [rad], and ``torque_n_m`` of the driver [N m],
    0 where nothing drives it."""

    middle_m: Mapping[str, Array]
    extension_m: Mapping[str, Array]
    theta_rad: Mapping[str, Array]
    torque_n_m: Array

    @staticmethod
    def between(motion: Motion, *others: Motion) -> ElasticDoubt:
        """Of a motion from others at the same instants."""
        shapes, links = motion.elastic, motion.links
        return ElasticDoubt(
            {
                n: _furthest(x.middle, (o.elastic[n].middle for o in others))
                for n, x in shapes.items()
            },
            {
                n: _furthest(x.extension, (o.elastic[n].extension for o in others))
                for n, x in shapes.items()
            },
            {n: _furthest(x.theta, (o.links[n].theta for o in others)) for n, x in links.items()},
            _furthest(_torque(motion), (_torque(other) for other in others)),
        )

    @property
    def so_far(self) -> ElasticDoubt:
        """The largest up to each instant: what has gone astray does not come back by itself."""
        return ElasticDoubt(
            _running(self.middle_m),
            _running(self.extension_m),
            _running(self.theta_rad),
            np.maximum.accumulate(self.torque_n_m),
        )


def _running(series: Mapping[str, Array]) -> Mapping[str, Array]:
    return {name: np.maximum.accumulate(each) for name, each in series.items()}


def _furthest(one: Array, others: Iterable[Array]) -> Array:
    return np.asarray(np.max([np.abs(one - other) for other in others], axis=0))


def _torque(motion: Motion) -> Array:
    return np.zeros(motion.time_s.size) if motion.forces is None else motion.forces.torque
