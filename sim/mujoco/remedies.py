"""What may help a mechanism of unequal masses in MuJoCo: other pins, or stiffer ones.

A closure gives way by what its force is over a stiffness that MuJoCo scales by the inverse masses
of the two bodies as they hang in the tree. `models.mjcf.tree` closes where these are heavy, which
is the best pin mostly; which one it is depends on the forces.
"""

from itertools import islice

from models.mjcf.tree import closings
from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.registry.offers import Remedies

MOST_CLOSINGS = 8
STIFFER: tuple[Settings, ...] = ({"solref_timeconst_steps": 2}, {"solref_dampratio": 0.3})
"""6 and 4 times as stiff as profile tuned; more than that RK4 does not resolve."""


def mujoco_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """Closings first: they cost nothing. What is as stiff already is left out."""
    elsewhere = islice(closings(scene, state), MOST_CLOSINGS)
    stiffer = [
        each
        for each in STIFFER
        if all(float(value) < float(settings[name]) for name, value in each.items())
    ]
    closed = str(settings["close"])
    other = ("+".join(pins) for pins in elsewhere)
    return [*({"close": pins} for pins in other if pins != closed), *stiffer]


REMEDIES: Remedies = mujoco_remedies
