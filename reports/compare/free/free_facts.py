"""What there is to know of a free run beside its errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from models.array import Array
from reports.compare.errors import Errors, MotionFacts
from reports.quantities import named
from reports.quantities.limits import FREE
from reports.quantities.quantity import Tolerance

MOST_GROWTH = 1e3
"""A sensitivity of free motion from which on errors of phase cancel and add up as they like, and
say nothing of an order."""
FREE_MOTION = (
    "Let go: largest errors at the same time over the sensitivity, by how much a small change of "
    "the start has grown; geometry at the logged angle of the driver; L longest link, w driver's "
    "peak speed."
)
OVER_G = (
    "let go, angles, places and rates are over G, by how much a small change of the start has grown"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeFacts(MotionFacts):
    """How far a run that was let go was followed, and what its errors were divided by.

    ``sensitivity`` is by how much a small change of the start has grown by ``until_s``, the last
    instant that is judged; ``left_out`` samples after it are not, as the truth is not known well
    enough there. ``time_s``, ``raw`` and ``judged`` are the largest error of phase and place up to
    some instants, as pure numbers: as it is, and over the sensitivity of its time.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = FREE
    closing: ClassVar[Sequence[str]] = ("phase", "geometry", *named("place", "closure"))
    cancels: ClassVar[bool] = True
    solved: ClassVar[float] = 3e-4
    """Where joints are nearly dependent an engine's solver leaves as much at any step."""
    least_order: ClassVar[int] = 4
    """An engine's loops need not give way, and all of its errors may be those of its steps: of
    MuJoCo's RK4."""
    step_option: ClassVar[str] = "--dt"
    over_g: ClassVar[Sequence[str]] = (OVER_G,)
    sensitivity: float
    until_s: float
    left_out: int
    time_s: Array
    raw: Array
    judged: Array
    passages: int = 0

    @staticmethod
    def of(errors: Errors | None) -> FreeFacts | None:
        """Those of a free run, None of others."""
        facts = errors.of_motion if errors else None
        return facts if isinstance(facts, FreeFacts) else None

    @property
    def has_order(self) -> bool:
        return not self.sensitivity > MOST_GROWTH

    def rounding(self, explained: float, summed_rad: float, bound: float) -> float:
        """An integrated truth is off by more than rounding."""
        return max(explained, summed_rad, bound)

    def compared_with(self, moved: str) -> str:
        return FREE_MOTION

    # Two runs are never the same for their facts alone, whose course is of arrays.
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def horizon_s(self, raw: float) -> float:
        """The time to which the error as it is stays within a number [s]."""
        return self._held(self.raw, raw)

    def judged_horizon_s(self, limit: float) -> float:
        """The time to which the error over the sensitivity stays within a number [s]."""
        return self._held(self.judged, limit)

    def _held(self, largest: Array, limit: float) -> float:
        broken = np.flatnonzero(~(largest <= limit))
        return float(self.time_s[max(broken[0] - 1, 0)] if broken.size else self.time_s[-1])
