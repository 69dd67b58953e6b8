"""Rapier, by its official package rapier3d, held in the plane."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "rapier3d",
    "rapier3d",
    ("knobs",),
    extra=True,
    formulation="constraint impulses",
    precision="single",
    apart=True,
    tried="0.36.",
)
