"""Figures of free motion."""

from reports.figures.drawing import Drawing
from reports.figures.free_runs import courses, energy_change, phase_diagrams

FIGURES = {
    "let-go": Drawing(courses.draw, drives=("let go",)),
    "energy": Drawing(energy_change.draw, drives=("let go",)),
    "phase": Drawing(phase_diagrams.draw, drives=("let go",)),
}
