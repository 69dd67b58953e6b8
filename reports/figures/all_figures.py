"""The figures by name. To add one, add a file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from matplotlib.figure import Figure

from reports.figures import convergence, mechanism, profile, work_precision
from reports.figures import error_parts as split
from reports.results.overview import Report


@dataclass(frozen=True)
class Drawing:
    """What a figure shows, of one scene and over all of them; None where it has no such form.

    Each gives None where a store has nothing to draw. Files are called ``name-scene`` and ``name``.
    """

    of: Callable[[Report, str], Figure | None] | None = None
    over_all: Callable[[Report], Figure | None] | None = None


FIGURES: Mapping[str, Drawing] = {
    "work-precision": Drawing(work_precision.draw, work_precision.draw_all),
    "convergence": Drawing(convergence.draw, convergence.draw_all),
    "split": Drawing(split.draw),
    "mechanism": Drawing(mechanism.draw),
    "profile": Drawing(None, profile.draw_all),
}
