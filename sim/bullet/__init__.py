"""Bullet, by the package pybullet."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "pybullet",
    formulation="constraint impulses",
    apart=True,
    tried="3.2.",
    wheels="Linux, Python up to 3.11",
)
