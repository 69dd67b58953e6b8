"""A family of any mechanism: scenes that differ in one number, each solved by the reference."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analytic.kinematics import driven_chunk, repeats_after, solve
from analytic.structure.mobility import refuse_other_than_cranked
from models.array import Array
from models.errors import CrankcheckError, ReachError, suggestion
from models.motion import Motion
from models.scene import GROUND, Scene, span
from models.scene.laws import ConstantSpeed
from reports.lectures.drawing.workbook.family import (
    CLOSE_DEG,
    KINDS,
    FamilyChart,
    FamilyCurves,
    check_values,
)

OMEGA = "omega"
AXES = ("x", "y")
CLOSE_RAD = math.radians(CLOSE_DEG)
MOST_CLOSE = 20_000
"""Instants at which the law of a driver is looked at for how far it goes."""


@dataclass(frozen=True)
class SceneFamily:
    """The motions of scenes that differ in ``name``, each over the same share of its period."""

    scene: Scene
    name: str
    unit: str
    values: Sequence[float]
    motions: Sequence[Motion]


def scene_family(scene: Scene, name: str, values: Sequence[float], time_s: Array) -> SceneFamily:
    """The members over the instants of the ``scene``; where they differ in speed each has its own.

    Raises CrankcheckError for a driver that is no crank, for what the scene has not, and for a
    member that can not be assembled.
    """
    refuse_other_than_cranked(scene, "--family")
    check_values(name, values)
    turns = time_s / scene.driver.law.period_s
    motions = []
    members = [varied_scene(scene, name, value) for value in values]
    for value, member in zip(values, members, strict=True):
        own_s = turns * member.driver.law.period_s
        try:
            _close_all_the_way(member, own_s)
            motions.append(solve(member, own_s, bound=False))
        except ReachError as error:
            raise CrankcheckError(
                f"--family {name}={value:g}: this member cannot be assembled: {error}"
            ) from None
    return SceneFamily(scene, name, "rad/s" if name == OMEGA else "m", values, motions)


def _close_all_the_way(member: Scene, time_s: Array) -> None:
    """Assemble a member closely on the way of its driver: between the instants, too. Raises
    ReachError."""
    count = math.ceil(float(time_s[-1]) * member.driver.law.peak_speed_rad_s / CLOSE_RAD)
    angles = member.driver.law.at(np.linspace(0.0, time_s[-1], min(count, MOST_CLOSE) + 1))[0]
    low, high = float(angles.min()), float(angles.max())
    way = min(high - low, repeats_after(member))
    theta = np.linspace(low, low + way, math.ceil(way / CLOSE_RAD) + 1)
    driven_chunk(member, theta, np.ones_like(theta))


def varied_scene(scene: Scene, name: str, value: float) -> Scene:
    """The scene with the length of a link of two points, a coordinate of a pin on the ground, or
    the speed of its driver set to ``value`` [m, rad/s]. Raises CrankcheckError."""
    law = scene.driver.law
    pin, _, axis = name.partition(".")
    if name in scene.links and len(scene.links[name].points) == 2:
        if value <= 0.0:
            raise CrankcheckError(f"--family {name}={value:g}: a length; give numbers above 0")
        link = scene.links[name]
        factor = value / span(link.points)
        points = {each: (factor * x, factor * y) for each, (x, y) in link.points.items()}
        return replace(scene, links=dict(scene.links) | {name: replace(link, points=points)})
    if pin in scene.ground and axis in AXES:
        x, y = scene.ground[pin]
        moved = (value, y) if axis == "x" else (x, value)
        return replace(scene, ground=dict(scene.ground) | {pin: moved})
    if name == OMEGA and isinstance(law, ConstantSpeed):
        if value == 0.0:
            raise CrankcheckError(f"--family {name}=0: a speed; give numbers that are not 0")
        driver = replace(scene.driver, law=replace(law, speed_rad_s=value))
        return replace(scene, driver=driver)
    names = [each.name for each in scene.links.values() if len(each.points) == 2]
    names += [f"{each}.{axis}" for each in scene.ground for axis in AXES]
    names += [OMEGA] if isinstance(law, ConstantSpeed) else []
    raise CrankcheckError(f"--family {name}: {suggestion(name, names, 'it has')}")


def scene_curves(family: SceneFamily) -> FamilyCurves:
    """The curves of what the mechanism drives: its last slider on the ground, else its last
    link."""
    scene, motions = family.scene, family.motions
    sliders = [each.name for each in scene.sliders.values() if each.on == GROUND]
    if sliders:
        last = [motion.sliders[sliders[-1]] for motion in motions]
        labels = "displacement [m]", "speed [m/s]", "acceleration [m/s²]"
        series = [[each.displacement, each.speed, each.acceleration] for each in last]
        name = sliders[-1]
    else:
        name = list(scene.links)[-1]
        labels = "theta [rad]", "omega [rad/s]", "alpha [rad/s²]"
        turned = [motion.links[name] for motion in motions]
        series = [[each.theta, each.omega, each.alpha] for each in turned]
    charts = [
        FamilyChart(kind, f"{name}: {label}", [each[k] for each in series])
        for k, (kind, label) in enumerate(zip(KINDS, labels, strict=True))
    ]
    angles = [np.degrees(motion.links[scene.driver.link].theta) for motion in motions]
    return FamilyCurves(family.name, family.unit, family.values, angles, charts)
