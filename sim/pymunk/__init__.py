"""pymunk."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "pymunk",
    ("snippet", "knobs", "remedies", "spoiler", "force_recipe"),
    extra=False,
    formulation="constraint impulses",
)
