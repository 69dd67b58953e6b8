"""An engine for tests, in a folder as every engine has one; it offers its adapter alone."""

from sim.registry import Declaration

DECLARATION = Declaration("numpy", extra=False)
