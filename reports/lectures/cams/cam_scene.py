"""The scene of a cam: the cam, its follower on a guide or a pivot, and what closes it."""

import math

import numpy as np

from analytic.cams.contact_force import FollowerLoad
from models.scene import GROUND, Driver, Link, Scene, Slider
from models.scene.cams import Cam, OscillatingFollower
from models.scene.characteristics import Constant
from models.scene.laws import ConstantSpeed
from models.scene.loads import Load, PinSpring, SlideSpring, Spring
from models.scene.pairs import CamPair


def cam_scene(
    name: str, source: str, cam: Cam, load: FollowerLoad | None, speed_rad_s: float
) -> Scene:
    """Return the scene of a cam in the frame of `models.scene.cams`.

    Without a ``load`` its follower has 1 kg, or 1 kg m^2 about its pivot, and nothing closes it.
    The weight of an oscillating follower acts as it does at lift 0.
    """
    arm = cam.follower.pivot_m if isinstance(cam.follower, OscillatingFollower) else 0.0
    inertia = 1.0 if load is None else load.inertia
    ground = {"O": (0.0, 0.0)} | ({"P": (arm, 0.0)} if arm else {})
    disc = Link("cam", {"O": (0.0, 0.0), "Q": (cam.base_m, 0.0)}, 1.0, (0.0, 0.0), cam.base_m**2)
    sliders, pair = {}, CamPair("cam", "cam", "follower", GROUND, cam, tip="R")
    if isinstance(cam.follower, OscillatingFollower):
        length = cam.follower.arm_m or arm
        # Of a rod about its end, with its centre in the pivot: the weight is a load.
        own = Link("follower", {"P": (0.0, 0.0), "R": (length, 0.0)}, 1.0, (0.0, 0.0), inertia)
    else:
        line = (cam.follower.offset_m, 0.0)
        sliders["guide"] = Slider("guide", "R", GROUND, line, 0.5 * math.pi, "follower")
        pair = CamPair("cam", "cam", "follower", GROUND, cam, slider="guide")
        points = {"R": (0.0, 0.0), "T": (cam.base_m, 0.0)}
        own = Link("follower", points, inertia, (0.0, 0.0), inertia * cam.base_m**2)
    links, driver = {"cam": disc, "follower": own}, ConstantSpeed(0.0, cam.sense * speed_rad_s)
    points_of = {GROUND: ground, **{link: each.points for link, each in links.items()}}
    springs, loads = _closing(pair, cam, load, pair.lowest(points_of, sliders))
    return Scene(
        name, source, ground, links, sliders, Driver("cam", driver),
        loads=loads, springs=springs, cams={"cam": pair},
    )  # fmt: skip


def _closing(
    pair: CamPair, cam: Cam, load: FollowerLoad | None, lowest: float
) -> tuple[dict[str, Spring], dict[str, Load]]:
    """Return the spring, and the load of weight and of a preload without a spring."""
    if load is None:
        return {}, {}
    steady = float(load.closing(cam, np.zeros(1))[0])
    springs: dict[str, Spring] = {}
    if rate := load.stiffness:
        steady -= load.preload
        free = lowest - pair.way * load.preload / rate
        springs["close"] = (
            SlideSpring("close", rate, 0.0, free, pair.slider)
            if pair.slider
            else PinSpring("close", rate, 0.0, free, "P", (GROUND, "follower"))
        )
    if not steady:
        return springs, {}
    point, towards = ("R", -steady) if pair.slider else (None, -pair.way * steady)
    push = Load("weight", "follower", point, Constant(towards), direction_rad=0.5 * math.pi)
    return springs, {"weight": push}
