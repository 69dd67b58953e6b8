"""Pair what an engine logged with the reference: one track per body and quantity."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene
from reports.compare.series import angle_error
from reports.quantities import QUANTITIES
from reports.quantities.quantity import BodyKind
from sim.engine import Run


@dataclass(frozen=True)
class Track:
    """One quantity of one body over time.

    ``error`` is engine less reference [unit], (T,) or (T, 2); ``bound`` (T,) what the reference
    may be wrong by; ``truth`` the reference of the place or rate that was logged; ``scale`` makes
    a pure number of the error.
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
        """The largest number of the truth, which rounding is relative to."""
        return float(np.max(np.abs(self.truth), initial=0.0))


def tracks(scene: Scene, run: Run, reference: Motion, quantities: Iterable[str]) -> Iterator[Track]:
    """Tracks of some quantities, of all bodies.

    It is the reference that says which there are: what the engine's log lacks, or has another
    number of samples of, is an error that is NaN throughout.
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
    """Engine less reference: where the engine has nothing, one NaN for all."""
    if np.isnan(engine[:1]).all() and np.isnan(engine).all():
        return _one(np.nan, right.shape)
    return angle_error(engine, right) if turns else engine - right


def _one(number: float, shape: tuple[int, ...]) -> Array:
    """A number as a series, which takes no memory: of a long log there are many."""
    return np.broadcast_to(np.float64(number), shape)


def fitting(series: Array | None, like: Array) -> Array:
    """The series, or NaN throughout where there is none of the shape of ``like``."""
    if series is None or series.shape != like.shape:
        return np.full_like(like, np.nan)
    return series


def lacking(motion: Motion, reference: Motion) -> list[str]:
    """The links, sliders and points of the reference that the engine's motion has not got."""
    pairs: tuple[tuple[str, Mapping[str, object], Mapping[str, object]], ...] = (
        ("link", motion.links, reference.links),
        ("slider", motion.sliders, reference.sliders),
        ("point", motion.points, reference.points),
    )
    return [
        f"{kind} {name}" for kind, moved, wanted in pairs for name in wanted if name not in moved
    ]
