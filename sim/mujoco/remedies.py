"""Remedies for a mechanism of unequal masses in MuJoCo: other closing pins, or stiffer ones.

A closure yields by its force over a stiffness that MuJoCo scales by the inverse masses of the two
bodies in the tree. `models.mjcf.tree` closes at heavy bodies, mostly the best pin; the best depends
on the forces.
"""

from itertools import islice

from models.mjcf.tree import closings
from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.registry.offers import Remedies

MOST_CLOSINGS = 8
STIFFER: tuple[Settings, ...] = ({"solref_timeconst_steps": 2}, {"solref_dampratio": 0.3})
"""Settings 6 and 4 times as stiff as profile tuned; RK4 does not resolve more than that."""


def mujoco_remedies(scene: Scene, state: State, settings: Settings) -> list[Settings]:
    """List closings, which cost nothing, then the settings that are stiffer than these."""
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
