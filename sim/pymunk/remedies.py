"""What may help in pymunk, whose joints take more iterations the more the masses differ."""

from __future__ import annotations

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.pymunk.chain_springs import chain_springs
from sim.pymunk.convergence import iterations
from sim.pymunk.space import build
from sim.remedies import Remedies

ITERATIONS = (300, 700, 2000)
"""Iterations that are tried."""
TIMES = (2, 5)
"""As many times those that a chain of segments has anyway."""


def pymunk_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """More iterations than there were."""
    if chain_springs(scene):
        held = iterations(scene, settings, build(scene, state))
        return [{"iterations": times * held} for times in TIMES]
    return [{"iterations": count} for count in ITERATIONS if count > int(settings["iterations"])]


REMEDIES: Remedies = pymunk_remedies
