"""Remedies in pymunk, whose joints take more iterations the more the masses differ."""

from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.pymunk.convergence import held_by_iterations, iterations
from sim.pymunk.settings import RANGES
from sim.pymunk.space import build
from sim.registry.offers import Remedies

ITERATIONS = (300, 700, 2000)
"""Numbers of iterations to try."""
TIMES = (2, 5)
"""Multiples of the iterations that a chain of segments has anyway."""


def pymunk_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """List more iterations; none for a chain that needs too many (`iterations`)."""
    if not held_by_iterations(scene, settings):
        asked = int(settings["iterations"])
        return [{"iterations": count} for count in ITERATIONS if count > asked]
    try:
        held = iterations(settings, build(scene, state))
    except EngineError:
        return []
    _, most = RANGES["iterations"]
    return [{"iterations": times * held} for times in TIMES if times * held <= most]


REMEDIES: Remedies = pymunk_remedies
