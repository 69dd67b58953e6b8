"""MuJoCo."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "mujoco",
    ("snippet", "knobs", "remedies", "spoiler", "viewer", "reader", "force_recipe", "gradient"),
    extra=False,
    formulation="soft constraints",
)
