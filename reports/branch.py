"""Whether a run stayed on its branch: the other assembly of a closed loop is closed as well."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from models.scene import Scene
from reports.errors import Departure
from reports.series import Array
from reports.tracks import Track
from sim.engine import Run

AWAY_RAD = 0.5
"""A link that is off by so much, in a loop that is closed, stands in the other assembly."""
CLOSED = 0.05
"""A loop whose pins are open by less, over the longest link, is closed."""
HERE_RAD = 0.02
"""A link that is off by less is still on its branch."""


def departure(
    scene: Scene, run: Run, placed: Iterable[Track], driver_rad: Array
) -> Departure | None:
    """Where the first link left the branch of the scene while its loop stayed closed.

    Parameters
    ----------
    placed : Iterable[Track]
        The tracks of place of the run.
    driver_rad : Array
        The commanded angle of the driver [rad], (T,).
    """
    closed = np.ones(driver_rad.shape, dtype=bool)
    for gap in run.gaps.values():
        closed &= np.abs(gap) < CLOSED * scene.longest_m
    left: list[tuple[int, str]] = []
    for track in placed:
        if track.quantity != "angle":
            continue
        off = np.abs(track.error)
        away = np.flatnonzero(closed & (off > AWAY_RAD))
        if away.size:
            here = np.flatnonzero(off[: away[0]] < HERE_RAD)
            left.append((int(here[-1]) if here.size else 0, track.body))
    if not left or run.motion is None:
        return None
    index, link = min(left)
    return Departure(link, float(run.motion.time_s[index]), float(driver_rad[index]))
