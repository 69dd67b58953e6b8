"""The scene of a cam: cam, follower on a guide or a pivot, and closing spring or weight."""

import math

import numpy as np

from analytic.cams.cam_design import ExaminedCam
from analytic.cams.contact_force import FollowerLoad
from models.scene import GROUND, Driver, Link, Scene, Slider
from models.scene.cams import OscillatingFollower
from models.scene.characteristics import Constant
from models.scene.laws import ConstantSpeed
from models.scene.loads import Load, PinSpring, SlideSpring, Spring
from models.scene.pairs import CamPair


def cam_scene(name: str, source: str, found: ExaminedCam) -> Scene:
    """Return the scene of a cam in the frame of `models.scene.cams`.

    Without a load its follower has 1 kg, or 1 kg m^2 about its pivot, and nothing closes it.
    The weight of an oscillating follower acts as it does at lift 0.
    """
    cam, load, origin = found.cam, found.load or FollowerLoad(1.0), (0.0, 0.0)
    ground, sliders = {"O": origin}, {}
    disc = Link("cam", {"O": origin, "Q": (cam.base_m, 0.0)}, 1.0, origin, cam.base_m**2)
    if isinstance(cam.follower, OscillatingFollower):
        ground["P"] = (cam.follower.pivot_m, 0.0)
        points = {"P": origin, "R": (cam.follower.arm_m or cam.follower.pivot_m, 0.0)}
        # Of a rod about its end, with its centre in the pivot: the weight is a load.
        own = Link("follower", points, 1.0, origin, load.inertia)
        pair = CamPair("cam", "cam", "follower", GROUND, cam, tip="R")
    else:
        line = (cam.follower.offset_m, 0.0)
        sliders["guide"] = Slider("guide", "R", GROUND, line, 0.5 * math.pi, "follower")
        points = {"R": origin, "T": (cam.base_m, 0.0)}
        own = Link("follower", points, load.inertia, origin, load.inertia * cam.base_m**2)
        pair = CamPair("cam", "cam", "follower", GROUND, cam, slider="guide")
    links = {"cam": disc, "follower": own}
    steady, rate = float(load.closing(cam, np.zeros(1))[0]), load.stiffness
    springs, loads = dict[str, Spring](), dict[str, Load]()
    if rate:
        steady -= load.preload  # the spring has it
        lowest = pair.lowest({GROUND: ground, "cam": disc.points, "follower": points}, sliders)
        free = lowest - pair.way * load.preload / rate
        springs["close"] = (
            SlideSpring("close", rate, 0.0, free, pair.slider)
            if pair.slider
            else PinSpring("close", rate, 0.0, free, "P", (GROUND, "follower"))
        )
    if steady:
        push, point = Constant(-pair.way * steady), "R" if pair.slider else None
        loads["weight"] = Load("weight", "follower", point, push, direction_rad=0.5 * math.pi)
    driver = Driver("cam", ConstantSpeed(0.0, cam.sense * found.speed_rad_s))
    return Scene(
        name, source, ground, links, sliders, driver,
        loads=loads, springs=springs, cams={"cam": pair},
    )  # fmt: skip
