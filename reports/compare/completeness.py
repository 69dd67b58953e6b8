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
    stamps = run.motion.time_s
    commanded = run.start_s + run.dt_s * (run.every * np.arange(run.steps // run.every + 1.0))
    if stamps.shape != commanded.shape:
        return (
            f"{stamps.size} samples, not the {commanded.size} of {run.steps} steps logged every "
            f"{run.every}"
        )
    off = np.abs(stamps - commanded)
    room = ROUNDINGS * EPSILON * float(np.max(np.abs(commanded)))
    bad = np.flatnonzero(~(off <= room))
    if bad.size:
        first = int(bad[0])
        return (
            f"sample {first} is stamped {stamps[first]:.9g} s, not {commanded[first]:.9g} s "
            f"({bad.size} of {stamps.size} are off the commanded times)"
        )
    return ""
