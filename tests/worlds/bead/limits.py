"""What a bead may be off by: as free motion, in its phase, places and velocities."""

from reports.quantities.limits import FREE

LIMITS = {name: FREE[name] for name in ("phase", "angle", "position", "gap", "velocity")}
