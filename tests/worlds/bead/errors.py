"""The errors of a bead: phase and places at the same time, and the time of its swing."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from reports.compare.compare import Beside
from reports.compare.error_rows import instants_of, whole_row
from reports.compare.errors import Error, Errors, MotionFacts
from reports.compare.whole_errors import ComparedParts, force_rows, whole_errors
from reports.quantities import named
from reports.quantities.quantity import Tolerance
from tests.worlds.bead.limits import LIMITS
from tests.worlds.bead.swing import swing_of


@dataclass(frozen=True, kw_only=True)
class BeadFacts(MotionFacts):
    """How far the bead swings [rad], and by how much its time is off, as a share."""

    limits: ClassVar[Mapping[str, Tolerance]] = LIMITS
    step_option: ClassVar[str] = "--dt"
    swing_rad: float
    period_off: float

    def compared_with(self, moved: str) -> str:
        return "Largest errors against the swing in elliptic functions."


def compared(beside: Beside, errors: Errors | None) -> Errors:
    """The errors of a run; there are none before."""
    swing = swing_of(beside.scene)
    time_s, angle = beside.motion.time_s, beside.crank - swing.down_rad
    own_s = _between_passages(time_s, angle)
    facts = BeadFacts(
        swing_rad=abs(swing.high_rad),
        period_off=2.0 * own_s / swing.period_s - 1.0,
    )
    at = instants_of(beside, time_s, beside.reference)
    parts = ComparedParts(
        placed=places(beside),
        notes=(),
        borne=force_rows(beside),
        departure=None,
        conditioning=1.0,
        summed_rad=0.0,
        far={},
        motion=facts,
    )
    return whole_errors(beside, at, parts)


def places(beside: Beside) -> list[Error]:
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    tracks = beside.tracks(("phase", *named("place")), beside.reference)
    return [whole_row(track, at) for track in tracks]


def _between_passages(time_s: np.ndarray, angle: np.ndarray) -> float:
    """The time from one passage of the lowest place to the next [s]; NaN without two."""
    at = np.flatnonzero(angle[:-1] * angle[1:] < 0.0)[:2]
    if at.size < 2:
        return math.nan
    first, second = (
        float(np.interp(0.0, sorted(angle[i : i + 2]), [time_s[i], time_s[i + 1]]))
        if angle[i + 1] > angle[i]
        else float(np.interp(0.0, angle[i : i + 2][::-1], time_s[i : i + 2][::-1]))
        for i in at
    )
    return second - first
