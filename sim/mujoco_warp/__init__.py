"""MuJoCo Warp: MuJoCo written anew in Warp, by its package mujoco-warp."""

from sim.registry import Declaration, Fewer

DECLARATION = Declaration(
    "mujoco_warp",
    ("gradient",),
    formulation="soft constraints",
    precision="single",
    tried="4.0.",
    pip_name="mujoco-warp",
    fewer=Fewer(batch_steps=20),
    needs=("warp", "mujoco"),
)
