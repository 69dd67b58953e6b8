"""Derivatives of MuJoCo Warp: there are none, as its kernels have no adjoints."""

from collections.abc import Iterator, Sequence

from sim.engine import Settings
from sim.engine.gradient import PoseGradient, Variation
from sim.mujoco_warp.engine import mjw, wp


def gradient(
    variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> Iterator[PoseGradient]:
    """Refuse, by the option with which its kernels are compiled."""
    compiled = wp.get_module(mjw.step.__module__).options["enable_backward"]
    reason = "is not offered by crankcheck" if compiled else "its kernels have no adjoints"
    yield PoseGradient("tape", refusal=reason)


GRADIENT = gradient
