"""Arrays that are passed about, and the numbers that a caller hands in."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.errors import CrankcheckError, cut

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


NO_NUMBERS = {"b": "truths", "c": "complex numbers", "m": "durations", "M": "dates", "V": "records"}
"""Kinds of arrays that numpy would convert to numbers, or would halve; a duration becomes the count
of its own unit."""


def numbers(values: ArrayLike, what: str) -> Array:
    """Return the values as floats, in a new array that later changes by the caller do not reach.

    Raises CrankcheckError for a masked array, whose numbers do not all count; text that is no
    number; lists of different lengths; durations, dates and anything else that is no number.
    """
    if isinstance(values, np.ma.MaskedArray):
        raise _no_numbers(what, "a masked array", "give those that count: values.compressed()")
    try:
        raw = np.asarray(values)
        if raw.dtype.kind in NO_NUMBERS:
            found = f"{NO_NUMBERS[raw.dtype.kind]} ({raw.dtype})"
            raise _no_numbers(what, found, "give floats, such as seconds")
        if raw.dtype.kind == "O":  # each by itself: numpy would take None for NaN
            raw = np.reshape([float(each) for each in raw.ravel()], raw.shape)
        return np.array(raw, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        found = f"values that are no numbers ({cut(str(error), 200)})"
        raise _no_numbers(what, found, "give floats") from None


def samples(values: ArrayLike, what: str = "samples") -> Array:
    """Return `numbers` as shape (T,), all finite, T at least 1; a single number is one sample.
    Raises CrankcheckError."""
    found = np.atleast_1d(numbers(values, what))
    if found.ndim != 1 or len(found) == 0:
        raise CrankcheckError(f"{what} of shape {found.shape}; give one dimension, at least one")
    finite = np.isfinite(found)
    if not finite.all():
        index = int(np.flatnonzero(~finite)[0])
        raise CrankcheckError(f"{what}: sample {index} is {found[index]}; give finite numbers")
    return found


def beside(values: ArrayLike, like: Array, what: str, beside_what: str) -> Array:
    """Return `numbers` in the shape of ``like``, a single one repeated. Raises CrankcheckError."""
    found = numbers(values, what)
    if found.size == 1:
        found = found.reshape(())
    elif found.shape != like.shape:
        raise CrankcheckError(
            f"{what} of shape {found.shape}, {beside_what} of {like.shape}; give as many of them, "
            "or a single one"
        )
    return np.broadcast_to(found, like.shape)


def _no_numbers(what: str, found: str, cure: str) -> CrankcheckError:
    return CrankcheckError(f"{what}: found {found}; {cure}")


def from_end(time_s: Array, until_s: float) -> tuple[float, Array, float]:
    """Return the end, 0 or ``until_s``, that all times are beyond [s]; the times after it (T,); and
    the step back into the interval between that is as long as the farthest of them."""
    end_s = until_s if time_s.min() > until_s else 0.0
    later = time_s - end_s
    return end_s, later, -float(later[np.argmax(np.abs(later))])
