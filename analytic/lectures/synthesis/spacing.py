"""Where a function is met exactly: Chebyshev's spacing of precision points."""

from __future__ import annotations

import numpy as np

from models.array import Array


def chebyshev_spacing(count: int, low: float, high: float) -> Array:
    """So many precision points between two ends, in order, (count,).

    They are the roots of Chebyshev's polynomial: the structural error of a function that they
    interpolate by a polynomial is then as even over the range as its next derivative is.

    Source: lecture "Tong hop co cau" (synthesis), "Chebyshev spacing"; R. L. Norton, Design of
    Machinery, section 5.13.
    """
    j = np.arange(1, count + 1, dtype=np.float64)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    return np.asarray(middle - half * np.cos((2.0 * j - 1.0) * np.pi / (2.0 * count)))
