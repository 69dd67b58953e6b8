"""Where a mechanism is and how it moves: its coordinates, and what they make of all markers."""

from __future__ import annotations

from dataclasses import dataclass

from models.array import Array, Mask


@dataclass(frozen=True)
class Configuration:
    """Coordinates with their rates at T samples, (T, n), and what they make of K markers: places
    and velocities (T, K, 3), derivatives of places by coordinates (T, K, 3, n), and accelerations
    where the q'' are 0 (T, K, 3)."""

    q: Array
    rates: Array
    place: Array
    gradient: Array
    velocity: Array
    drift: Array

    def some(self, samples: Mask) -> Configuration:
        """Those of some of the samples."""
        return Configuration(*(own[samples] for own in vars(self).values()))
