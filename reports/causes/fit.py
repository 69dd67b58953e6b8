"""Numbers that leave the least sum of squares, by Gauss-Newton steps."""

from collections.abc import Callable, Sequence

import numpy as np

from models.array import Array
from models.errors import CrankcheckError

ROUNDS = 30
HALVINGS = 5
SETTLED = 1e-4
"""A round that takes less of what is left than this part of it is the last one."""

Residual = Callable[[Array], Array]
"""Of parameters (p,) the residuals (n,); it raises CrankcheckError where there are none."""


def fitted(
    residual: Residual, start: Sequence[float], delta: Sequence[float], rounds: int = ROUNDS
) -> Array | None:
    """The parameters (p,) near ``start`` that leave the least, with differences of ``delta``, after
    at most so many rounds; a step that leaves more is halved. None where there are no residuals at
    the start."""
    at = np.array(start, dtype=float)
    left = _at(residual, at)
    if left is None:
        return None
    for _ in range(rounds):
        slopes = _slopes(residual, at, left, delta)
        if slopes is None:
            break
        step = np.linalg.lstsq(slopes, -left, rcond=None)[0]
        size, better = float(left @ left), None
        for _ in range(HALVINGS):
            better = _at(residual, at + step)
            if better is not None and float(better @ better) < size:
                break
            step, better = 0.5 * step, None
        if better is None:
            break
        at, left = at + step, better
        if float(left @ left) > (1.0 - SETTLED) * size:
            break
    return at


def _slopes(residual: Residual, at: Array, left: Array, delta: Sequence[float]) -> Array | None:
    """The change of the residuals (n, p) with each parameter."""
    columns = []
    for number, each in enumerate(delta):
        moved = at.copy()
        moved[number] += each
        found = _at(residual, moved)
        if found is None:
            return None
        columns.append((found - left) / each)
    return np.stack(columns, axis=1)


def _at(residual: Residual, parameters: Array) -> Array | None:
    """The residuals; None where there are none, or numbers that are none."""
    try:
        found = residual(parameters)
    except CrankcheckError:
        return None
    return found if np.all(np.isfinite(found)) else None
