"""DART, by the package dartpy."""

from sim.registry import Declaration

DECLARATION = Declaration("dartpy", "'crankcheck[dart]'", (), True)
