"""MuJoCo."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "mujoco",
    "mujoco",
    ("snippet", "knobs", "remedies", "spoiler", "viewer", "reader", "force_recipe"),
    formulation="soft constraints",
)
