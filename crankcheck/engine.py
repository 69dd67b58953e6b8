"""For an engine of your own: all that an adapter is made of.

::

    import crankcheck.engine as cc

    ENGINE = cc.Engine("mine", profiles, version, check, open)

An adapter opens a session at a state, steps it, and says what it holds and what has moved, as
`Poses`; everything after that is crankcheck's. docs/own-engine.md shows one from top to bottom;
``crankcheck engines check package.module:ENGINE`` says what one still does wrong.

What stands here is public. ``drive`` says what the crank is to be told at each step, and ``tree``
lays out a mechanism for an engine with joint coordinates, whose motion `body_poses` turns into
poses.
"""

from models import tree
from models.errors import EngineError
from models.joints import (
    Joints,
    Pin,
    Prism,
    Slot,
    block_name,
    blocks,
    bodies,
    carriers,
    joints,
    local_point,
    sliding_angle,
)
from models.motion import State
from models.poses import Frame, centre_of, frames, mass_of
from models.scene import GROUND, Point, Scene, Slider
from sim import drive
from sim.engine import (
    BodyPose,
    Drive,
    Engine,
    Facts,
    Log,
    Placing,
    Poses,
    Profile,
    Session,
    Setting,
    Settings,
    SettingValue,
)
from sim.settings import SettingError, check_choices, check_ranges
from sim.tree_poses import body_poses

__all__ = [
    "GROUND",
    "BodyPose",
    "Drive",
    "Engine",
    "EngineError",
    "Facts",
    "Frame",
    "Joints",
    "Log",
    "Pin",
    "Placing",
    "Point",
    "Poses",
    "Prism",
    "Profile",
    "Scene",
    "Session",
    "Setting",
    "SettingError",
    "SettingValue",
    "Settings",
    "Slider",
    "Slot",
    "State",
    "block_name",
    "blocks",
    "bodies",
    "body_poses",
    "carriers",
    "centre_of",
    "check_choices",
    "check_ranges",
    "drive",
    "frames",
    "joints",
    "local_point",
    "mass_of",
    "sliding_angle",
    "tree",
]
