"""The figures by name. To add one, add a file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

from matplotlib.figure import Figure

from reports.figures import convergence, mechanism, profile, work_precision
from reports.figures import error_parts as split
from reports.figures.free_runs import courses, energy_change, phase_diagrams
from reports.results.overview import Report

Drives = Literal["driven", "elastic", "let go"]


@dataclass(frozen=True)
class Drawing:
    """What a figure shows, of one scene and over all of them; None where it has no such form.

    Each gives None where a store has nothing to draw. Files are called ``name-scene`` and ``name``.
    ``drives`` says whether it shows what was driven, with rigid links or elastic ones, or what was
    let go.
    """

    of: Callable[[Report, str], Figure | None] | None = None
    over_all: Callable[[Report], Figure | None] | None = None
    drives: tuple[Drives, ...] = ("driven",)


BOTH: tuple[Drives, ...] = ("driven", "let go")
FIGURES: Mapping[str, Drawing] = {
    "work-precision": Drawing(work_precision.draw, work_precision.draw_all, ("driven", "elastic")),
    "convergence": Drawing(convergence.draw, convergence.draw_all, (*BOTH, "elastic")),
    "split": Drawing(split.draw),
    "mechanism": Drawing(mechanism.draw, drives=BOTH),
    "profile": Drawing(None, profile.draw_all),
    "let-go": Drawing(courses.draw, drives=("let go",)),
    "energy": Drawing(energy_change.draw, drives=("let go",)),
    "phase": Drawing(phase_diagrams.draw, drives=("let go",)),
}
