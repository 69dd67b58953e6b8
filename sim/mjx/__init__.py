"""MJX: MuJoCo's own port to JAX, by its package mujoco-mjx."""

from sim.registry import Declaration, Fewer

DECLARATION = Declaration(
    "mujoco.mjx",
    ("gradient",),
    formulation="soft constraints",
    tried="3.17.",
    pip_name="mujoco-mjx",
    fewer=Fewer(),
    needs=("jax",),
)
