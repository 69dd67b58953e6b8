"""MuJoCo."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "mujoco",
    ("snippet", "knobs", "remedies", "spoiler", "viewer", "reader", "force_recipe"),
    extra=False,
    formulation="soft constraints",
)
