"""The time stamps of a log against those that were commanded."""

from __future__ import annotations

import numpy as np

from sim.engine import Run

ROUNDINGS = 4
"""Roundings of the largest time that a stamp may be off by: start + dt * k is two operations."""
EPSILON = float(np.finfo(np.float64).eps)


def incomplete(run: Run) -> str:
    """What the log lacks of the commanded samples, start + k * every * dt; "" where it is whole.

    A run that did not end well has a short log by its nature: its status says so already.
    """
    if run.motion is None:
        return "nothing was logged"
    found = run.motion.time_s
    wanted = run.start_s + run.dt_s * (run.every * np.arange(run.steps // run.every + 1.0))
    if found.shape != wanted.shape:
        return (
            f"{found.size} samples, not the {wanted.size} of {run.steps} steps logged every "
            f"{run.every}"
        )
    off = np.abs(found - wanted)
    room = ROUNDINGS * EPSILON * float(np.max(np.abs(wanted)))
    bad = np.flatnonzero(~(off <= room))
    if bad.size:
        first = int(bad[0])
        return (
            f"sample {first} is stamped {found[first]:.9g} s, not {wanted[first]:.9g} s "
            f"({bad.size} of {found.size} are off the commanded times)"
        )
    return ""
