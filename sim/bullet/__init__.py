"""Bullet, by the package pybullet."""

from sim.registry import Declaration

DECLARATION = Declaration(
    "pybullet",
    "pybullet",
    extra=True,
    formulation="constraint impulses",
    apart=True,
    tried="3.2.",
    wheels="Linux, Python up to 3.11",
)
