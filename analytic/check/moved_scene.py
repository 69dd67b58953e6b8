"""The same mechanism somewhere else: turned, moved, mirrored or scaled.

A mechanism does not know where it stands, so errors as pure numbers must not change either.
"""

from __future__ import annotations

from dataclasses import replace

from analytic.structure.mobility import analyse
from models.joints import turned
from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.scene import GROUND, Driver, Link, Point, Scene, Slider


def rotated(scene: Scene, angle_rad: float) -> Scene:
    """The scene turned about the origin, its gravity and its loads with it.

    Not for loads over the driver's angle, which is another one then.
    """

    def turn(place: Point) -> Point:
        return turned(place, angle_rad)

    def on_ground(slider: Slider) -> Slider:
        return replace(
            slider,
            through_m=turn(slider.through_m),
            direction_rad=slider.direction_rad + angle_rad,
        )

    loads = {
        name: replace(load, direction_rad=load.direction_rad + angle_rad)
        for name, load in scene.loads.items()
        if load.frame == "ground"
    }
    # A link that slides on the ground turns with it: its angle is kept against the line.
    return replace(
        scene,
        ground={name: turn(place) for name, place in scene.ground.items()},
        sliders={n: on_ground(s) if s.on == GROUND else s for n, s in scene.sliders.items()},
        driver=Driver(scene.driver.link, scene.driver.law.turned(angle_rad)),
        gravity_m_s2=turn(scene.gravity_m_s2),
        loads={**scene.loads, **loads},
    )


def moved(scene: Scene, by_m: Point) -> Scene:
    """The scene shifted as a whole."""

    def shift(p: Point) -> Point:
        return (p[0] + by_m[0], p[1] + by_m[1])

    return replace(
        scene,
        ground={name: shift(place) for name, place in scene.ground.items()},
        sliders={
            n: replace(s, through_m=shift(s.through_m)) if s.on == GROUND else s
            for n, s in scene.sliders.items()
        },
    )


def mirrored(scene: Scene) -> Scene:
    """The scene mirrored in the x-axis; pins of two-link dyads change their branch with it."""

    def flip(p: Point) -> Point:
        return (p[0], -p[1])

    def link(old: Link) -> Link:
        points = {name: flip(place) for name, place in old.points.items()}
        return replace(old, points=points, centre_m=flip(old.centre_m))

    def slider(old: Slider) -> Slider:
        return replace(
            old,
            through_m=flip(old.through_m),
            direction_rad=-old.direction_rad,
            angle_rad=-old.angle_rad,
        )

    sides = [group.branch_key for group in analyse(scene).groups if group.kind == "RRR"]
    flipped = {pin: -scene.branch.get(pin, 1) for pin in sides}
    return replace(
        scene,
        ground={name: flip(place) for name, place in scene.ground.items()},
        links={name: link(old) for name, old in scene.links.items()},
        sliders={name: slider(old) for name, old in scene.sliders.items()},
        driver=Driver(scene.driver.link, mirrored_law(scene.driver.law)),
        branch={**scene.branch, **flipped},
        gravity_m_s2=flip(scene.gravity_m_s2),
    )


def mirrored_law(law: Law) -> Law:
    """The law with every angle of the opposite sign."""
    match law:
        case Oscillating():
            return replace(law, centre_rad=-law.centre_rad, amplitude_rad=-law.amplitude_rad)
        case ConstantSpeed() | FromRest():
            return replace(law, start_rad=-law.start_rad, speed_rad_s=-law.speed_rad_s)
        case Accelerating(start, speed, gain):
            return Accelerating(-start, -speed, -gain)
        case SpeedChange(start, before, after):
            return replace(law, start_rad=-start, before_rad_s=-before, after_rad_s=-after)
    raise TypeError(law)


def scaled(scene: Scene, factor: float) -> Scene:
    """The scene with every length times ``factor``, made of rods of the same mass per length.

    Masses grow with the factor, inertias with its cube; gravity with the factor, so that the
    motion stays similar at the same speed. Loads stay as they are.
    """

    def grow(p: Point) -> Point:
        return (p[0] * factor, p[1] * factor)

    def link(old: Link) -> Link:
        return replace(
            old,
            points={name: grow(place) for name, place in old.points.items()},
            mass_kg=old.mass_kg * factor,
            centre_m=grow(old.centre_m),
            inertia_kg_m2=old.inertia_kg_m2 * factor**3,
        )

    def slider(old: Slider) -> Slider:
        return replace(
            old,
            through_m=grow(old.through_m),
            mass_kg=old.mass_kg * factor,
            inertia_kg_m2=old.inertia_kg_m2 * factor**3,
        )

    return replace(
        scene,
        ground={name: grow(place) for name, place in scene.ground.items()},
        links={name: link(old) for name, old in scene.links.items()},
        sliders={name: slider(old) for name, old in scene.sliders.items()},
        gravity_m_s2=grow(scene.gravity_m_s2),
    )
