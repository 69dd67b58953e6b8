"""The Coriolis component: what a slider's acceleration has because its guide turns."""

from __future__ import annotations

from collections.abc import Mapping

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene


def coriolis(scene: Scene, motion: Motion) -> Mapping[str, Array]:
    """2 omega v [m/s^2], (T,), of every slider on a moving guide: omega of the guide, v along it.

    Positive to the left of the slider's line, a quarter turn counter-clockwise from its direction:
    v turned in the sense of omega. The guides must be among the motion's links. Its rounding is
    that of the two factors (``motion.bound``).
    """
    return {
        name: 2.0 * motion.links[slider.on].omega * motion.sliders[name].speed
        for name, slider in scene.sliders.items()
        if slider.on != GROUND
    }
