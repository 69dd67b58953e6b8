"""Error series: the engine's log less the reference, and their sizes."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene
from reports.quantities import QUANTITIES
from reports.quantities.quantity import BodyKind
from sim.engine import Run


@dataclass(frozen=True)
class Track:
    """One quantity of one body over time.

    ``error`` is engine less reference [unit], (T,) or (T, 2); ``bound`` (T,) the uncertainty of the
    reference; ``truth`` the reference of the logged position or rate; ``scale`` makes a pure number
    of the error.
    """

    quantity: str
    body_kind: BodyKind
    body: str
    error: Array
    bound: Array
    truth: Array
    scale: float
    unit: str

    @property
    def magnitude(self) -> float:
        """The largest number of the reference, for relative rounding."""
        return float(np.max(np.abs(self.truth), initial=0.0))


def tracks(scene: Scene, run: Run, reference: Motion, quantities: Iterable[str]) -> Iterator[Track]:
    """Yield tracks of some quantities, of all bodies.

    The reference determines the bodies: a series that the engine's log lacks, or has with another
    number of samples, is an error that is NaN throughout.
    """
    for quantity in quantities:
        for measure in QUANTITIES[quantity].measures:
            logged, bounds = measure.logged(scene, run), measure.bound(scene, reference)
            scale, turns = measure.scale(scene, reference), measure.unit == "rad"
            for body, right in measure.truth(scene, reference).items():
                engine = fitting(logged.get(body), right)
                yield Track(
                    quantity=quantity,
                    body_kind=measure.body_kind,
                    body=body,
                    error=_error(engine, right, turns=turns),
                    bound=bounds[body] if body in bounds else _one(0.0, right.shape[:1]),
                    truth=right,
                    scale=scale,
                    unit=measure.unit,
                )


def _error(engine: Array, right: Array, *, turns: bool) -> Array:
    """Return engine less reference: where the engine has nothing, one NaN for all."""
    if np.isnan(engine[:1]).all() and np.isnan(engine).all():
        return _one(np.nan, right.shape)
    return angle_error(engine, right) if turns else engine - right


def _one(number: float, shape: tuple[int, ...]) -> Array:
    """Return a number as a series, which takes no memory: of a long log there are many."""
    return np.broadcast_to(np.float64(number), shape)


def fitting(series: Array | None, like: Array) -> Array:
    """Return the series, or NaN throughout where there is none of the shape of ``like``."""
    if series is None or series.shape != like.shape:
        return np.full_like(like, np.nan)
    return series


def lacking(motion: Motion, reference: Motion) -> list[str]:
    """Return the links, sliders and points of the reference that the engine's motion lacks."""
    return [
        f"{kind} {name}"
        for kind in ("link", "slider", "point")
        for name in getattr(reference, f"{kind}s")
        if name not in getattr(motion, f"{kind}s")
    ]


@dataclass(frozen=True)
class TrackSize:
    """Size of an error series, in the unit of the series.

    ``maximum`` is NaN as soon as one sample is not finite: a missing number is a failure, not a
    sample to leave out. ``index`` is the place of the maximum, or the first such sample.
    """

    maximum: float
    rms: float
    final: float
    index: int


def size(series: Array) -> TrackSize:
    """Return maximum, root mean square and last value of the magnitude of ``series`` (T,)."""
    magnitude = np.abs(series)
    index = int(np.argmax(magnitude))  # the first NaN, where there is one
    largest = float(magnitude[index])
    if not math.isfinite(largest):
        broken = int(np.flatnonzero(~np.isfinite(series))[0])
        return TrackSize(math.nan, math.nan, float(series[-1]), broken)
    # Squares of the pure ratio: no overflow for an engine that has run away.
    rms = largest * float(np.sqrt(np.mean((magnitude / largest) ** 2))) if largest > 0.0 else 0.0
    return TrackSize(largest, rms, float(magnitude[-1]), index)


def angle_error(engine: Array, reference: Array) -> Array:
    """Return the difference of two continuous angles [rad], less the whole turns at its start.

    The engine may count turns from elsewhere; after the first sample a whole turn is an error, even
    at one sample alone.
    """
    error = engine - reference
    first = float(error[0]) / math.tau if error.size else 0.0
    turns = float(np.round(first)) if math.isfinite(first) else 0.0
    return np.asarray(error - math.tau * turns)


def length(vectors: Array) -> Array:
    """Return the Euclidean length of each row of (T, 2); of a (T,) series its magnitude."""
    return np.hypot(vectors[:, 0], vectors[:, 1]) if vectors.ndim == 2 else np.abs(vectors)


def rate(error: Array, step_s: float) -> Array:
    """Return the first derivative by central differences; the two ends are dropped.

    The derivative of the *error* is the difference of the two differenced motions: the truncation
    of the formula, the same for engine and reference, cancels, and the engine's error remains.
    """
    return np.asarray((error[2:] - error[:-2]) / (2.0 * step_s))


def second_rate(error: Array, step_s: float) -> Array:
    """Return the second derivative by central differences; the two ends are dropped."""
    return np.asarray((error[2:] - 2.0 * error[1:-1] + error[:-2]) / step_s**2)
