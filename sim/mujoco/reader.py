"""Reads an MJCF file that somebody else wrote."""

from __future__ import annotations

from sim.mujoco.own_model.read import read_model
from sim.own_models import Reader

READER: Reader = read_model
