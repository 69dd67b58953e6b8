"""How a free run went from its start to its end, at a few instants: its phase, its speed, its
energy, and what they are to be seen over."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.array import Array
from reports.compare.free.free_beside import FreeBeside

SAMPLES = 720
"""Over a whole run: some fifty in a swing of a mechanism that lasts ten seconds."""


def free_series(beside: FreeBeside) -> Mapping[str, Array]:
    """Series by name, (T,) each, of a run that was thinned out to the instants that are kept.

    ``phase`` [rad] is what the driver is off by at the same time, ``growth`` the sensitivity,
    ``omega`` the driver's logged angular velocity [rad/s]. Where the engine has an energy,
    ``energy`` [J] is that, less the work of loads and dampers as the reference has it, and less its
    value at the start; ``kinetic`` the true kinetic energy [J].
    """
    run = beside.run
    series = {"phase": beside.drive, "growth": beside.growth}
    if driver := beside.motion.links.get(beside.scene.driver.link):
        series["omega"] = driver.omega
    if run.energy is not None and run.velocity_time_s is not None:
        known = beside.free.energy(np.clip(run.velocity_time_s, 0.0, beside.free.until_s))
        own = run.energy.total_j - known.work
        series |= {"energy": own - own[0], "kinetic": known.kinetic}
    return series
