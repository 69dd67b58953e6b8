"""Figures of free motion."""

from reports.figures.drawing import Drawing
from reports.figures.free_runs import courses, energy_change, phase_diagrams

FIGURES = {
    "free-motion": Drawing(courses, drives=("free",)),
    "energy": Drawing(energy_change, drives=("free",)),
    "phase": Drawing(phase_diagrams, drives=("free",)),
}
