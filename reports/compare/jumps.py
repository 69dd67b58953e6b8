"""Where the forces of the reference jump: friction turns with its joint, and a load acts on one
stroke of its slider alone. There an engine's own speed, which is off by what a step leaves out,
says which of two values it has."""

from __future__ import annotations

import numpy as np

from models.array import Array, Mask
from models.motion import Motion
from models.scene import Scene

NEAR = 3
"""Samples to both sides of a jump: MuJoCo's friction, a soft constraint, holds a joint that would
stand still within its time constant, which profile tuned has at three steps."""


def near_jumps(scene: Scene, reference: Motion) -> Mask:
    """The samples, (T,), beside those between which a force jumps, of a motion with its forces."""
    jumps = np.zeros(max(reference.time_s.size - 1, 0), dtype=np.bool_)
    friction = reference.forces.friction if reference.forces is not None else {}
    for series in friction.values():
        jumps |= _turns(series)
    for load in scene.loads.values():
        if load.stroke == "both" or load.slider is None:
            continue
        slid = reference.sliders[load.slider]
        turns = _turns(slid.speed)
        if load.over == "displacement":
            turns &= _acts(load.characteristic.at(slid.displacement))
        jumps |= turns
    near = np.zeros(reference.time_s.size, dtype=np.bool_)
    for by in range(min(NEAR, jumps.size)):
        near[: jumps.size - by] |= jumps[by:]  # so many samples before the jump
        near[1 + by :] |= jumps[: jumps.size - by]
    return near


def _turns(series: Array) -> Mask:
    """Whether a series changes its sign from a sample to the next, (T - 1,)."""
    sign = np.sign(np.nan_to_num(series))
    return np.asarray(sign[1:] != sign[:-1])


def _acts(magnitude: Array) -> Mask:
    """Whether a load is other than 0 at a sample or the next, (T - 1,)."""
    return np.asarray((magnitude[1:] != 0.0) | (magnitude[:-1] != 0.0))
