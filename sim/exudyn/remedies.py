"""What may help in exudyn at the same step: joints closed in their places, or more exactly."""

from __future__ import annotations

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.remedies import Remedies

CLOSER: Settings = {"relative_tolerance": 1e-11}
IN_PLACES: Settings = {"integrator": "GeneralizedAlpha", "spectral_radius": 0.6}
"""The radius at which what an ill start shakes has gone after a few steps."""


def exudyn_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """Those that the settings have not, whatever the scene."""
    found = []
    if settings["integrator"] != IN_PLACES["integrator"]:
        found.append(IN_PLACES)
    if float(settings["relative_tolerance"]) > float(CLOSER["relative_tolerance"]):
        found.append(CLOSER)
    return found


REMEDIES: Remedies = exudyn_remedies
