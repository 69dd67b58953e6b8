"""MuJoCo: hinges and slides as joint coordinates, loops closed by soft `connect` constraints."""

from __future__ import annotations

from sim.engine import Engine
from sim.mujoco.session import MujocoSession
from sim.mujoco.settings import AS_SHIPPED, TUNED, checked, holds, in_seconds
from sim.mujoco.stepped import VERSION

ENGINE = Engine(
    "mujoco",
    {"as-shipped": AS_SHIPPED, "tuned": TUNED},
    version=lambda: VERSION,
    check=checked,
    open=MujocoSession,
    holds=holds,
    in_seconds=in_seconds,
    forces_of="states",
    applies_loads=True,
    applies_constant_friction=True,
    applies_springs=True,
)
