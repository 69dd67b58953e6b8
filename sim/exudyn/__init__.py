"""exudyn."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "exudyn", ("snippet", "knobs", "remedies", "force_recipe"), formulation="constraint equations"
)
