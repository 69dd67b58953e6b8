"""The energies of a mechanism that is let go, whatever integrated it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True)
class EnergyBalance:
    """Energies [J], (T,): of motion; of weights, over the ground's origin, and springs; and the
    ``work`` since time 0 of all that does not keep it: loads, dampers, friction."""

    kinetic: Array
    potential: Array
    work: Array

    @property
    def balance(self) -> Array:
        """What stays as it is but for errors: energy less the work that was put in [J], (T,)."""
        return np.asarray(self.kinetic + self.potential - self.work)

    @staticmethod
    def joined(parts: Sequence[EnergyBalance]) -> EnergyBalance:
        """Those of some instants after the other."""
        each = zip(*(vars(part).values() for part in parts), strict=True)
        return EnergyBalance(*(np.concatenate(own) for own in each))
