"""The same mechanism mirrored or sped up; the rest is in `analytic.check.moved_scene`."""

from __future__ import annotations

from dataclasses import replace

from analytic.structure.mobility import analyse
from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.scene import Driver, Link, Point, Scene, Slider


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


def faster_law(law: Law, factor: float) -> Law:
    """The law that runs ``factor`` times as fast through the same angles."""
    match law:
        case Oscillating():
            return replace(law, frequency_rad_s=law.frequency_rad_s * factor)
        case ConstantSpeed():
            return replace(law, speed_rad_s=law.speed_rad_s * factor)
        case FromRest():
            return FromRest(law.start_rad, law.speed_rad_s * factor, law.rise_s / factor)
        case Accelerating(start, speed, gain):
            return Accelerating(start, speed * factor, gain * factor**2)
        case SpeedChange(start, before, after, at, rise):
            return SpeedChange(start, before * factor, after * factor, at / factor, rise / factor)
    raise TypeError(law)


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


def sped_up(scene: Scene, factor: float) -> Scene:
    """The scene driven ``factor`` times as fast through the same angles, in similar motion."""
    g = scene.gravity_m_s2
    return replace(
        scene,
        driver=Driver(scene.driver.link, faster_law(scene.driver.law, factor)),
        gravity_m_s2=(g[0] * factor**2, g[1] * factor**2),
    )
