"""Rapier, by its official package rapier3d, held in the plane."""

from sim.registry import Declaration

DECLARATION = Declaration("rapier3d", "'crankcheck[rapier]'", ("knobs",), True)
"""Rapier: free bodies, joints solved by impulses in sub-steps, in single precision."""
