"""exudyn."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "exudyn",
    "exudyn",
    ("snippet", "knobs", "remedies", "force_recipe"),
    extra=True,
    formulation="constraint equations",
)
