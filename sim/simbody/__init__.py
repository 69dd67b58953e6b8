"""Simbody, the multibody engine of OpenSim, by the package opensim."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "opensim",
    formulation="constraint equations",
    apart=True,
    tried="4.6",
    wheels="Python 3.11 to 3.13, not Linux on arm64",
)
