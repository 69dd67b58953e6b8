"""What may help in pymunk, whose joints take more iterations the more the masses differ."""

from __future__ import annotations

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.remedies import Remedies

ITERATIONS = (300, 700, 2000)


def pymunk_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """More iterations than there were, whatever the scene."""
    return [{"iterations": count} for count in ITERATIONS if count > int(settings["iterations"])]


REMEDIES: Remedies = pymunk_remedies
