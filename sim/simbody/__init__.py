"""Simbody, the multibody engine of OpenSim, by the package opensim."""

from sim.registry import Declaration

DECLARATION = Declaration("opensim", "'crankcheck[simbody]'", (), True)
