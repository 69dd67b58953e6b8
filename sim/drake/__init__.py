"""Drake, by its own package, with its solver of convex problems (SAP) in steps of fixed size."""

from sim.registry import Declaration

DECLARATION = Declaration("pydrake", "'crankcheck[drake]'", (), True)
