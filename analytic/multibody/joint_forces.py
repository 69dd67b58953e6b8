"""What multipliers mean: the forces in the joints."""

from __future__ import annotations

from collections.abc import Iterable

from models.array import Array
from models.forces import Forces, SliderForces
from models.scene import Scene


def joint_forces(
    scene: Scene,
    pin_pairs: Iterable[tuple[str, str, str]],
    time_s: Array,
    multipliers: Array,
    torque: Array,
) -> Forces:
    """The multipliers of the equations of joints, in their order (T, m), as forces;
    beside the driving torque (T,)."""
    pins: dict[str, dict[str, Array]] = {}
    row = 0
    for point, first, other in pin_pairs:
        push = multipliers[:, row : row + 2]
        held = pins.setdefault(point, {})
        held[first] = held.get(first, 0.0) + push
        held[other] = held.get(other, 0.0) - push
        row += 2
    sliders: dict[str, SliderForces] = {}
    for name in scene.sliders:
        sliders[name] = SliderForces(multipliers[:, row], multipliers[:, row + 1])
        row += 2
    return Forces(time_s, pins, sliders, torque)
