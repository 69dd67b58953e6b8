"""Which rows of a long log a page draws: of each stretch the smallest and the largest, so that no
spike is lost."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from models.array import Array

Rows = NDArray[np.intp]


def extreme_rows(series: Sequence[Array], most: int) -> Rows:
    """The rows to be drawn of series that belong together, about ``most`` of them: all where there
    are no more, else the first, the last, and those at which a series is smallest or largest in a
    stretch. All series are of shape (T,)."""
    number = series[0].size
    if number <= most:
        return np.arange(number)
    length = math.ceil(number * 2 * len(series) / most)
    picked = [np.array([0, number - 1])]
    for each in series:
        missing = np.isnan(each)
        picked.append(_lowest(np.where(missing, np.inf, each), length))
        picked.append(_lowest(np.where(missing, np.inf, -each), length))
    return np.unique(np.concatenate(picked))


def _lowest(series: Array, length: int) -> Rows:
    """The row of the smallest number in each stretch of so many rows."""
    spare = -series.size % length
    stretches = np.pad(series, (0, spare), mode="edge").reshape(-1, length)
    rows: Rows = np.argmin(stretches, axis=1) + length * np.arange(len(stretches))
    return rows.clip(max=series.size - 1)
