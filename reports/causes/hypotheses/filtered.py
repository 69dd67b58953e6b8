"""Readings after one or more low-pass or mean filters: smooth, and late.

Both filters delay a signal as well as smooth it, where they look back. Where they remove little
besides, a delay explains the readings too, and the residual shows which it is.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account, fitted, later
from reports.causes.cause import CauseSize, Excerpt
from reports.causes.inquiry import Inquiry
from reports.output.numbers import duration

WIDEST = 0.25
"""Largest part of a stretch for the width of a mean."""
NEAR = 48
"""Largest width in samples up to which each is tried; wider means go in steps of a twentieth."""
TIME_CONSTANTS = np.logspace(-0.5, 3.0, 12)
"""Time constants, in samples, from which the fit of a low-pass starts."""
FEEDS = (0.0, 0.5, 1.0)
"""Weights of the previous sample beside the new one: backward, bilinear, forward."""
FARTHEST = 20.0
"""Largest magnitude of the logarithm of a time constant in samples."""
LEAST_ROWS = 16
PASSED = 0.1
"""Least part of a signal that a filter has to pass: less would leave no readings to explain."""


def filtered(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield each filter that explains a channel."""
    for column in inquiry.open:
        try:
            stretch = inquiry.stretch(column)
        except CrankcheckError:
            continue
        if stretch.rows < LEAST_ROWS:
            continue
        yield from (_low_pass(stretch, column), _mean(stretch, column))


def _low_pass(stretch: Inquiry, column: str) -> Account | None:
    """Return the account of a low-pass of first order that began with the first reading."""
    excerpt = stretch.excerpts[column]
    intervals = np.diff(excerpt.instants)
    step = float(np.median(intervals))
    if not step > 0.0 or np.any(intervals < 0.0):
        return None
    readings = excerpt.expected + excerpt.error

    def residual(log_constant: Array, feed: float) -> Array:
        constant = step * math.exp(min(max(float(log_constant[0]), -FARTHEST), FARTHEST))
        decay = np.exp(-intervals / constant)
        return readings - low_pass(excerpt.expected, readings[0], decay, feed)

    def left(log_constant: float, feed: float) -> float:
        rest = residual(np.array([log_constant]), feed)
        return float(rest @ rest)

    start = min(np.log(TIME_CONSTANTS), key=lambda each: left(each, 0.0))
    best: tuple[float, float, float] | None = None
    for feed in FEEDS:
        found = fitted(lambda p, feed=feed: residual(p, feed), [start], [1e-5])  # type: ignore[misc]
        if found is not None and abs(found[0]) < FARTHEST:
            each = (left(float(found[0]), feed), float(found[0]), feed)
            best = each if best is None else min(best, each)
    if best is None:
        return None
    _, log_constant, feed = best
    constant = step * math.exp(log_constant)
    if constant > (excerpt.instants[-1] - excerpt.instants[0]):
        return None  # the output would be constant
    phrase = (
        f"{{who}} went through a low-pass of first order, time constant {duration(constant)} "
        f"({constant / step:.3g} samples)"
    )
    return _told(stretch, column, "low-pass", residual(np.array([log_constant]), feed), phrase)


def _told(stretch: Inquiry, column: str, name: str, left: Array, phrase: str) -> Account | None:
    """Return the account of a filter; None if it passes next to nothing, or is a mere likeness."""
    excerpt = stretch.excerpts[column]
    passed = CauseSize.of_signal(excerpt.expected + excerpt.error - left).rms
    if passed < PASSED * CauseSize.of_signal(excerpt.expected).rms or not excerpt.told_apart(left):
        return None
    return stretch.account(name, CAUSE + NUMBER, {column: left}, phrase)


def low_pass(signal: Array, start: float, decay: Array, feed: float) -> Array:
    """Return signal (n,) as y[k] = a[k] y[k-1] + (1 - a[k]) x[k], where ``decay`` is a (n - 1,), y
    begins with ``start``, and x has the part ``feed`` of the sample before. In log2(n) rounds."""
    fed = (1.0 - feed) * signal[1:] + feed * signal[:-1]
    factor = np.concatenate([[0.0], decay])
    result = np.concatenate([[start], (1.0 - decay) * fed])
    reach = 1
    while reach < signal.size:  # each sample takes in as many before it as it has so far
        result[reach:] = result[reach:] + factor[reach:] * result[:-reach]
        factor[reach:] = factor[reach:] * factor[:-reach]
        reach *= 2
    return result


def _mean(stretch: Inquiry, column: str) -> Account | None:
    """Return the account of a mean over the last samples, or over as many on both sides."""
    excerpt = stretch.excerpts[column]
    rows = excerpt.rows.size
    _, coarse, _ = min(_means(excerpt, _widths(rows)))
    near = range(int(0.95 * coarse), min(int(1.05 * coarse), int(WIDEST * rows)) + 1)
    _, width, ahead = min(_means(excerpt, [coarse, *near]))
    first, left = _left_by_mean(excerpt, width, ahead)
    where = f"{width // 2} on both sides" if ahead else "the last ones"
    phrase = f"{{who}} {{is}} a mean over {width} samples, {where}"
    part = stretch.part(np.arange(first, first + left.size))
    return _told(part, column, "mean", left, phrase)


def _means(excerpt: Excerpt, widths: Iterable[int]) -> Iterator[tuple[float, int, int]]:
    """Yield the mean square that each mean leaves, its width in samples, and its samples ahead."""
    for width in widths:
        for ahead in (0, width // 2) if width % 2 else (0,):
            if width > 1:
                _, left = _left_by_mean(excerpt, width, ahead)
                yield float(left @ left) / left.size, width, ahead


def _left_by_mean(excerpt: Excerpt, width: int, ahead: int) -> tuple[int, Array]:
    """Return the first row that has all samples of its mean, and the residual from there on."""
    sums = np.concatenate([[0.0], np.cumsum(excerpt.expected)])
    means = (sums[width:] - sums[:-width]) / width
    first = width - 1 - ahead
    readings = excerpt.expected + excerpt.error
    return first, readings[first : first + means.size] - means


def _widths(rows: int) -> list[int]:
    """Return the widths in samples that are tried; wide ones are odd, to have a middle."""
    widest = int(WIDEST * rows)
    wide = {int(each) | 1 for each in np.geomspace(NEAR, max(widest, NEAR), 60)}
    return [*range(2, min(NEAR, widest)), *(each for each in sorted(wide) if each <= widest)]


ORDERS = (1, 2, 3, 4, 0)
"""Orders of Butterworth's low-pass; 0 for the mean with weights that fade from row to row."""
ENDS = 8
"""Part of the rows at each end, as 1 over it, that may depend on how a filter began there."""
CUTOFFS = np.geomspace(2e-3, 0.9, 24)[:, None]
"""Cutoffs, over half the sampling rate, from which a fit starts."""
MOST_FITS = 3
"""Channels whose filter is tried on all channels."""


def forth_and_back(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield low-pass filters that ran forth and back, and so have no delay, each fitted to one
    channel and tried on all."""
    few = [column for column in inquiry.unexplained if inquiry.rows >= LEAST_ROWS]
    parts = {column: inquiry.stretch(column).excerpts[column] for column in inquiry.open if few}
    fits = (_fit(parts[column], order) for column in few for order in ORDERS)
    for _, order, cutoff in sorted(filter(None, fits))[:MOST_FITS]:
        kind = f"order {order}" if order else "one pole"
        phrase = (
            f"{{who}} {{is}} smoothed without delay, as by a low-pass of {kind} forth and back, "
        )
        phrase += f"cutoff {0.5 * cutoff / inquiry.step_s:.3g} Hz"
        errors, there = {}, {}
        for column, excerpt in parts.items():
            left = _left_forth_and_back(excerpt, order, cutoff)
            ends = 0 if excerpt.told_apart(left) else left.size // ENDS
            kept = np.arange(ends, left.size - ends)
            part = excerpt.part(kept)
            passed = CauseSize.of_signal((excerpt.expected + excerpt.error - left)[kept]).rms
            if part.told_apart(left[kept]) and passed > PASSED * part.size.rms:
                there[column], errors[column] = part, left[kept]
        middle = replace(inquiry, excerpts=there, open=tuple(there))
        yield middle.account("zero phase", CAUSE + NUMBER + CHOICE, errors, phrase)


def _fit(excerpt: Excerpt, order: int) -> tuple[float, int, float] | None:
    """Return what a filter with the best cutoff leaves of the middle, its order and its cutoff."""
    ends = excerpt.rows.size // ENDS

    def near(cutoff: Array) -> float:
        return float(np.clip(cutoff[0], CUTOFFS[0, 0], CUTOFFS[-1, 0]))

    def left(cutoff: Array) -> Array:
        return _left_forth_and_back(excerpt, order, near(cutoff))[ends:-ends]

    found = fitted(
        left, min(CUTOFFS, key=lambda each: float(np.sum(left(np.array(each)) ** 2))), [1e-6]
    )
    return None if found is None else (float(np.sum(left(found) ** 2)), order, near(found))


def _left_forth_and_back(excerpt: Excerpt, order: int, cutoff: float) -> Array:
    """Return the readings (n,) less the reference after a filter with that cutoff over half the
    sampling rate, forth and back (Gustafsson, IEEE Trans. Signal Process. 44, 1996)."""
    from scipy.signal import filtfilt  # type: ignore[import-untyped]  # ships no stubs

    there = filtfilt(*_coefficients(order, cutoff), excerpt.expected)
    return np.asarray(excerpt.expected + excerpt.error - there)


@lru_cache(maxsize=1024)
def _coefficients(order: int, cutoff: float) -> tuple[Sequence[float], Sequence[float]]:
    """Return the coefficients (b, a) of a filter; every channel starts from the same cutoffs."""
    from scipy.signal import butter

    fade = math.exp(-math.pi * cutoff)
    return butter(order, cutoff) if order else ([1.0 - fade], [1.0, -fade])


NODES, WEIGHTS = np.polynomial.hermite_e.hermegauss(7)
LEAST = 1.5
"""Least width in samples of any smoothing."""


def smoothed(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of smoothing, even or delayed, for channels without a good explanation."""
    for column in inquiry.unexplained:
        for delayed in (False, True):
            yield _smoothing_account(inquiry, column, delayed=delayed)


def _smoothing_account(inquiry: Inquiry, column: str, *, delayed: bool) -> Account | None:
    period = inquiry.period_s
    excerpt = inquiry.thin.excerpts[column]

    def residual(numbers: Array) -> Array:
        by_s = float(numbers[1]) if delayed else 0.0
        return excerpt.beside(_smooth(inquiry, excerpt, abs(float(numbers[0])), by_s))

    start, delta = [0.02 * period, 0.0], [1e-5 * period, 1e-6 * period]
    count = 2 if delayed else 1
    found = fitted(residual, start[:count], delta[:count])
    if found is None or not abs(found[0]) < period:
        return None
    spread, by_s = abs(float(found[0])), float(found[1]) if delayed else 0.0
    whole = inquiry.excerpts[column]
    errors = {column: whole.beside(_smooth(inquiry, whole, spread, by_s))}
    width = math.sqrt(12.0) * spread
    if width < LEAST * inquiry.step_s:
        return None
    phrase = (
        f"{{who}} {{is}} smoothed as by a mean over {duration(width)} "
        f"({width / inquiry.step_s:.3g} samples)"
    )
    if delayed:
        phrase += f", and {{belongs}} {later(by_s, inquiry.step_s)}"
    return inquiry.account("smoothed", CAUSE + NUMBER * count, errors, phrase)


def _smooth(inquiry: Inquiry, excerpt: Excerpt, spread_s: float, by_s: float) -> Array:
    """Return the reference ``by_s`` later, averaged over a bell curve of that spread. Raises
    CrankcheckError where there is no mechanism."""
    instants = excerpt.instants + (by_s + spread_s * NODES)[:, None]
    motion = inquiry.world.at(instants.ravel(), [excerpt.channel])
    expected = excerpt.channel.expected(motion).reshape(instants.shape)
    return np.asarray(WEIGHTS @ expected / WEIGHTS.sum())
