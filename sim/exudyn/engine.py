"""exudyn: bodies in absolute coordinates, all joints constraints, solved for by implicit steps."""

from __future__ import annotations

from sim.engine import Engine
from sim.exudyn.library import VERSION
from sim.exudyn.session import ExudynSession
from sim.exudyn.settings import AS_SHIPPED, TUNED, checked, of_drive, of_rigid, placing

ENGINE = Engine(
    "exudyn",
    {"as-shipped": AS_SHIPPED, "tuned": TUNED},
    version=lambda: VERSION,
    check=checked,
    open=ExudynSession,
    holds=lambda settings, dt_s, drive: of_rigid(of_drive(settings, drive)),
    placing=placing,
    in_seconds=lambda settings: (),
    forces_of="states",
    applies_loads=True,
    applies_constant_friction=True,
    applies_springs=True,
    applies_beams=True,
)
