"""Bullet, by the package pybullet."""

from sim.registry import Declaration

DECLARATION = Declaration("pybullet", "'crankcheck[bullet]'", (), True)
