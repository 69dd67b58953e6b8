"""Numbers spread evenly over a box, the same for the same seed."""

from __future__ import annotations

import numpy as np

from models.array import Array


def spread(count: int, dimensions: int, seed: int) -> Array:
    """So many points of the unit box, (count, dimensions): multiples of irrational numbers.

    Source: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018): powers of
    the root of x^(d+1) = x + 1; the seed moves all points by one random vector.
    """
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    steps = root ** -np.arange(1.0, dimensions + 1.0)
    start = np.random.default_rng(seed).random(dimensions)
    return np.asarray((start + np.arange(1, count + 1)[:, None] * steps) % 1.0)


def between(share: Array, bounds: tuple[tuple[float, float], ...]) -> Array:
    """Shares of a box (count, d) as numbers within bounds, (d, count)."""
    low, high = (np.array(side)[:, None] for side in zip(*bounds, strict=True))
    return np.asarray(low + (high - low) * share.T)
