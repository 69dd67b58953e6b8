"""Rigid motions and scalings of a scene: turned, moved, mirrored or scaled with its loads.

The physics does not depend on the location, so errors as pure numbers must not change either.
Besides, a scene with another link.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from models.scene import GROUND, Driver, Link, Point, Scene, Slider
from models.scene.cams import TranslatingFollower
from models.scene.driver import Released
from models.scene.joints import turned
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.scene.loads import CoulombFriction, Friction, Load, PinSpring, Spring
from models.scene.pairs import CamPair, Gear


def with_link(scene: Scene, name: str, **changes: Any) -> Scene:
    """The scene with changes of one link."""
    link = replace(scene.links[name], **changes)
    return replace(scene, links={**scene.links, name: link})


def heavier(link: Link, factor: float) -> Link:
    """The link with ``factor`` times its mass and inertia: of the same shape."""
    mass, inertia = factor * link.mass_kg, factor * link.inertia_kg_m2
    return replace(link, mass_kg=mass, inertia_kg_m2=inertia)


def of_mass(scene: Scene, name: str, factor: float) -> Scene:
    """The scene with ``factor`` times the mass and inertia of one link."""
    return replace(scene, links={**scene.links, name: heavier(scene.links[name], factor)})


def rotated(scene: Scene, angle_rad: float) -> Scene:
    """The scene turned about the origin, its gravity and its loads with it."""

    def turn(place: Point) -> Point:
        return turned(place, angle_rad)

    def on_ground(slider: Slider) -> Slider:
        return replace(
            slider,
            through_m=turn(slider.through_m),
            direction_rad=slider.direction_rad + angle_rad,
        )

    def load(old: Load) -> Load:
        lean = angle_rad if old.point is not None and old.frame == "ground" else 0.0
        ahead = angle_rad if old.over == "angle" else 0.0
        return replace(
            old,
            direction_rad=old.direction_rad + lean,
            characteristic=old.characteristic.carried(1.0, shift=ahead),
        )

    def spring(old: Spring) -> Spring:
        # Against the ground, which stays as it is, a link has turned.
        if not isinstance(old, PinSpring) or GROUND not in old.bodies:
            return old
        by = angle_rad if old.bodies[0] == GROUND else -angle_rad
        return replace(old, free=old.free + by)

    def gear(old: Gear) -> Gear:
        return replace(
            old, phase_rad=old.phase_rad - angle_rad * old.relation.get(GROUND, 0) / old.second
        )

    def cam(old: CamPair) -> CamPair:
        return replace(old, start_rad=old.start_rad + angle_rad * (old.carrier == GROUND))

    # A link that slides on the ground turns with it: its angle is kept against the line.
    return replace(
        scene,
        ground={name: turn(place) for name, place in scene.ground.items()},
        sliders={n: on_ground(s) if s.on == GROUND else s for n, s in scene.sliders.items()},
        driver=Driver(scene.driver.link, scene.driver.law.turned(angle_rad)),
        gravity_m_s2=turn(scene.gravity_m_s2),
        loads={name: load(old) for name, old in scene.loads.items()},
        springs={name: spring(old) for name, old in scene.springs.items()},
        start=replace(
            scene.start,
            angles_rad={n: angle + angle_rad for n, angle in scene.start.angles_rad.items()},
        ),
        gears={name: gear(old) for name, old in scene.gears.items()},
        cams={name: cam(old) for name, old in scene.cams.items()},
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


def mirrored(scene: Scene, sides: Iterable[str]) -> Scene:
    """Return the scene mirrored in the x-axis; the pins ``sides``, of dyads of two links and three
    pins, change their branch."""

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

    def load(old: Load) -> Load:
        return replace(
            old,
            direction_rad=-old.direction_rad,
            characteristic=old.characteristic.carried(
                -1.0 if old.point is None else 1.0,
                stretch=-1.0 if old.over in ("angle", "omega") else 1.0,
            ),
        )

    def spring(old: Spring) -> Spring:
        return replace(old, free=-old.free) if isinstance(old, PinSpring) else old

    def cam(old: CamPair) -> CamPair:
        profile = old.profile
        if isinstance(follower := profile.follower, TranslatingFollower):
            flipped = replace(follower, offset_m=-follower.offset_m)
            profile = replace(profile, follower=flipped, sense=-profile.sense)
        start = -old.start_rad
        return replace(old, profile=profile, side=-old.side, start_rad=start, outline=())

    flipped = {pin: -scene.branch.get(pin, 1) for pin in sides}
    return replace(
        scene,
        ground={name: flip(place) for name, place in scene.ground.items()},
        links={name: link(old) for name, old in scene.links.items()},
        sliders={name: slider(old) for name, old in scene.sliders.items()},
        driver=Driver(scene.driver.link, mirrored_law(scene.driver.law)),
        branch={**scene.branch, **flipped},
        gravity_m_s2=flip(scene.gravity_m_s2),
        loads={name: load(old) for name, old in scene.loads.items()},
        springs={name: spring(old) for name, old in scene.springs.items()},
        start=replace(
            scene.start,
            angles_rad={name: -angle for name, angle in scene.start.angles_rad.items()},
            rates_rad_s={name: -rate for name, rate in scene.start.rates_rad_s.items()},
        ),
        gears={n: replace(old, phase_rad=-old.phase_rad) for n, old in scene.gears.items()},
        cams={name: cam(old) for name, old in scene.cams.items()},
    )


def mirrored_law(law: Law) -> Law:
    """The law with every angle of the opposite sign."""
    match law:
        case Oscillating():
            return replace(law, centre_rad=-law.centre_rad, amplitude_rad=-law.amplitude_rad)
        case ConstantSpeed() | FromRest() | Released():
            return replace(law, start_rad=-law.start_rad, speed_rad_s=-law.speed_rad_s)
        case Accelerating(start, speed, gain):
            return Accelerating(-start, -speed, -gain)
        case SpeedChange(start, before, after):
            return replace(law, start_rad=-start, before_rad_s=-before, after_rad_s=-after)
    raise TypeError(law)


def scaled(scene: Scene, factor: float) -> Scene:
    """The scene with every length times ``factor``, made of rods of the same mass per length.

    Masses grow with the factor, inertias with its cube; gravity with the factor, so that the motion
    stays similar at the same speed. Forces are masses times accelerations: loads and friction grow
    with its square, torques with its cube; a load over a displacement is stretched, and the radii
    of pins with friction and modules of gears grow.
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

    def load(old: Load) -> Load:
        size = factor**3 if old.point is None else factor**2
        stretch = factor if old.over in ("displacement", "speed") else 1.0
        return replace(old, characteristic=old.characteristic.carried(size, stretch=stretch))

    def rubbing(old: Friction) -> Friction:
        if isinstance(old, CoulombFriction):
            return replace(old, radius_m=old.radius_m * factor)
        return replace(old, size=old.size * factor ** (2 if old.joint in scene.sliders else 3))

    def spring(old: Spring) -> Spring:
        if isinstance(old, PinSpring):
            return replace(old, rate=old.rate * factor**3, damping=old.damping * factor**3)
        rate, damping = old.rate * factor, old.damping * factor
        return replace(old, rate=rate, damping=damping, free=old.free * factor)

    def gear(old: Gear) -> Gear:
        return replace(old, module_m=None if old.module_m is None else old.module_m * factor)

    def cam(old: CamPair) -> CamPair:
        profile, own = old.profile, vars(old.profile.follower)
        lengths = {k: factor * v for k, v in own.items() if k.endswith("_m")}
        law = profile.law.scaled(factor) if old.slider else profile.law
        follower, base_m = replace(profile.follower, **lengths), profile.base_m * factor
        larger = replace(profile, law=law, base_m=base_m, follower=follower)
        return replace(old, profile=larger, outline=())

    grown = {name: factor * by for name, by in scene.start.displacements_m.items()}
    quick = {name: factor * speed for name, speed in scene.start.speeds_m_s.items()}
    return replace(
        scene,
        ground={name: grow(place) for name, place in scene.ground.items()},
        links={name: link(old) for name, old in scene.links.items()},
        sliders={name: slider(old) for name, old in scene.sliders.items()},
        gravity_m_s2=grow(scene.gravity_m_s2),
        loads={name: load(old) for name, old in scene.loads.items()},
        friction={name: rubbing(old) for name, old in scene.friction.items()},
        springs={name: spring(old) for name, old in scene.springs.items()},
        start=replace(scene.start, displacements_m=grown, speeds_m_s=quick),
        gears={name: gear(old) for name, old in scene.gears.items()},
        cams={name: cam(old) for name, old in scene.cams.items()},
    )
