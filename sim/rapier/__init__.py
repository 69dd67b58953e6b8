"""Rapier, by its official package rapier3d, held in the plane."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "rapier3d",
    ("knobs",),
    formulation="constraint impulses",
    precision="single",
    apart=True,
    tried="0.36.",
)
