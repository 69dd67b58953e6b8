"""Parts of an adapter for an engine of your own.

::

    import crankcheck.engine as cc

    ENGINE = cc.Engine("mine", profiles, version, check, open)

An adapter opens a session at a state, steps it, and reports its model, as `Facts`, and its motion,
as `Poses`; everything after that is crankcheck's. docs/how-to/add-an-engine.md shows an adapter
from top to bottom; ``crankcheck engines check package.module:ENGINE`` lists its remaining faults.

All names here are public. ``drive`` gives the command of the crank at each step,
``load_magnitudes`` the sizes of the loads of a scene meanwhile, and ``tree`` lays out a mechanism
for an engine with joint coordinates, whose motion `body_poses` turns into poses.
"""

from models.errors import EngineError
from models.mjcf import tree
from models.motion import Forces, SliderForces, State
from models.scene import GROUND, Point, Scene, Slider
from models.scene.elastic import Beam
from models.scene.joints import (
    Frame,
    Joints,
    Pin,
    Prism,
    Slot,
    block_name,
    blocks,
    bodies,
    carriers,
    centre_of,
    frames,
    joined_at,
    joints,
    line_ends,
    local_point,
    mass_of,
    sliding_angle,
    whole_turns,
)
from models.scene.loads import ConstantFriction, LineSpring, Load, PinSpring, SlideSpring, Spring
from models.scene.pairs import CamPair, Gear
from sim.engine import (
    Batches,
    BodyPose,
    Drive,
    Engine,
    Facts,
    ForceSession,
    ForcesOf,
    Log,
    Placing,
    Poses,
    Profile,
    Session,
    Setting,
    Settings,
    SettingValue,
    Unreported,
    drive,
    load_magnitudes,
)
from sim.engine.settings import SettingError, check_choices, check_ranges
from sim.engine.tree_poses import body_poses

__all__ = [
    "GROUND",
    "Batches",
    "Beam",
    "BodyPose",
    "CamPair",
    "ConstantFriction",
    "Drive",
    "Engine",
    "EngineError",
    "Facts",
    "ForceSession",
    "Forces",
    "ForcesOf",
    "Frame",
    "Gear",
    "Joints",
    "LineSpring",
    "Load",
    "Log",
    "Pin",
    "PinSpring",
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
    "SlideSpring",
    "Slider",
    "SliderForces",
    "Slot",
    "Spring",
    "State",
    "Unreported",
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
    "joined_at",
    "joints",
    "line_ends",
    "load_magnitudes",
    "local_point",
    "mass_of",
    "sliding_angle",
    "tree",
    "whole_turns",
]
