"""pymunk."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "pymunk",
    "pymunk",
    ("snippet", "knobs", "remedies", "spoiler", "force_recipe"),
    formulation="constraint impulses",
)
