"""What the motion asks of the joints and of the drive, over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from models.array import Array


@dataclass(frozen=True)
class SliderForces:
    """What the guide of a slider exerts on what slides: ``normal`` [N], the force along the line's
    direction turned by +90 deg, at the slider's point; ``moment`` [N m] about that point; (T,)."""

    normal: Array
    moment: Array


@dataclass(frozen=True)
class ForceBound:
    """What forces may be wrong by: the same keys, arrays of shape (T,), never negative.

    For pins the bound holds for the length of the error vector. Infinite where rounding leaves
    nothing certain.
    """

    pins: Mapping[str, Mapping[str, Array]]
    sliders: Mapping[str, SliderForces]
    torque: Array


@dataclass(frozen=True)
class Forces:
    """Reactions and driving torque, sampled at ``time_s`` (T,).

    ``pins`` holds, by point and body, the force of the pin on the body [N], (T, 2), in the ground's
    frame. Bodies stand in the order of the pin, the ground first, then links, then slider blocks:
    where two meet, the force on the second is what the first exerts on it. All forces of a pin add
    up to 0. ``torque`` [N m], (T,), is what the drive exerts on the driver. ``undetermined`` says
    why there are no reactions where the equations of statics leave them open.
    """

    time_s: Array
    pins: Mapping[str, Mapping[str, Array]]
    sliders: Mapping[str, SliderForces]
    torque: Array
    bound: ForceBound | None = None
    undetermined: str = ""
