"""Figures of free motion."""

from reports.figures.drawing import Drawing
from reports.figures.free_runs import courses, energy_change, phase_diagrams

FIGURES = {
    "let-go": Drawing(courses, drives=("let go",)),
    "energy": Drawing(energy_change, drives=("let go",)),
    "phase": Drawing(phase_diagrams, drives=("let go",)),
}
