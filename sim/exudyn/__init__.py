"""exudyn."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "exudyn", "'crankcheck[exudyn]'", ("snippet", "knobs", "remedies", "force_recipe"), True
)
