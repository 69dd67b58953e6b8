"""What is said of stored cells of a kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

TARGETS = (1e-2, 1e-3, 1e-4, 1e-6)
"""Errors of place [rad, or of the longest link]."""


@dataclass(frozen=True)
class ResultKind:
    """Words and targets of stored cells.

    ``unit`` is that of the error that they are compared by, ``axis`` its name on diagrams and
    ``promise`` in a recommendation; ``targets`` are those of recommendations, ``kept`` what keeps
    one, ``head`` its column, and ``notes`` stand over settings to be copied. ``error`` explains the
    error on a page, in the place ``stands`` among other kinds;
    where several are drawn together the axis is that of the kind that ``leads``, the lowest.
    """

    error: str
    stands: int
    leads: int
    axis: str
    promise: str
    unit: str = "rad"
    targets: Sequence[float] = TARGETS
    kept: str = "scene within a target"
    head: str = "target\nrad"
    notes: Sequence[str] = ()
