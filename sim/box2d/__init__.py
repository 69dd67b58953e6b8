"""Box2D, in its third version, by the package pyb2d3."""

from sim.registry import Declaration

DECLARATION = Declaration("pyb2d3", "'crankcheck[box2d]'", ("knobs",), True)
