"""Remedies in exudyn at the same step."""

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.registry.offers import Remedies

CHOICES: tuple[Settings, ...] = (
    {"jacobian": "each-iteration"},
    {"relative_tolerance": 1e-11, "absolute_tolerance": 1e-13},
    {"integrator": "TrapezoidalIndex2"},
)
"""A matrix that is never old, for steps that do not converge; more exact positions; and joints
closed in their rates, whose accelerations need no settling at the start."""


def exudyn_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """List the choices that the settings lack, for any scene."""
    return [choice for choice in CHOICES if any(settings[n] != v for n, v in choice.items())]


REMEDIES: Remedies = exudyn_remedies
