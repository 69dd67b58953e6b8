"""Make another machine of a scene: its links, its weight, its loads and springs."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from analytic.free.release import release
from models.scene import Link, Point, Scene, characteristics, driver, joints, tabulated
from models.scene.loads import LineSpring, Load, SlideSpring
from models.scene.moved import heavier, with_link
from reports.selftest.fault import Plant, SceneChange, in_scene


def in_free_scene(change: SceneChange) -> Plant:
    """Give the engine another scene than the reference, with the accelerations of its start: all of
    it is sound, and another machine."""
    return in_scene(change, lambda wrong, _, dt_s: release(wrong, dt_s).at(np.zeros(1)).state())


LinkChange = Callable[[Link, float], Link]


def of_link(change: LinkChange, at: int) -> SceneChange:
    """Change the link in the place ``at`` of the scene: 0 the first, -1 the last."""

    def changed(scene: Scene, size: float) -> Scene:
        link = change(list(scene.links.values())[at], size)
        return replace(scene, links={**scene.links, link.name: link})

    return changed


def of_coupler(change: LinkChange) -> SceneChange:
    """Change the link that is pinned to the driver."""
    return of_link(change, 1)


def heavier_by(link: Link, share: float) -> Link:
    return heavier(link, 1.0 + share)


def lighter_by(link: Link, share: float) -> Link:
    return heavier(link, 1.0 - share)


def turning_light(link: Link, share: float) -> Link:
    """Put points in the place of rods."""
    return replace(link, inertia_kg_m2=(1.0 - share) * link.inertia_kg_m2)


def scaled_points(link: Link, factor: float) -> dict[str, Point]:
    """Return the points of a link, all of them so many times as far out."""
    return {name: (factor * x, factor * y) for name, (x, y) in link.points.items()}


def long_by(link: Link, share: float) -> Link:
    """Lengthen a link by a share, its matter as before."""
    return replace(link, points=scaled_points(link, 1.0 + share))


def of_more_mass(link: Link, share: float) -> Link:
    return replace(link, mass_kg=(1.0 + share) * link.mass_kg)


def about_pin(link: Link, share: float) -> Link:
    """Take the inertia about the first pin, or a share of the way there (Steiner)."""
    arm_m = math.dist(link.centre_m, next(iter(link.points.values())))
    return replace(link, inertia_kg_m2=link.inertia_kg_m2 + share * link.mass_kg * arm_m**2)


def off_centre(link: Link, share: float) -> Link:
    """Move the centre of mass along the link by a share of its length."""
    (x, y), (ax, ay), (bx, by) = link.centre_m, *list(link.points.values())[:2]
    return replace(link, centre_m=(x + share * (bx - ax), y + share * (by - ay)))


def of_all_matter(scene: Scene, share: float) -> Scene:
    """Scale every mass and inertia by the same factor."""
    links = {name: heavier(link, 1.0 + share) for name, link in scene.links.items()}
    return replace(scene, links=links)


def without_flywheel(scene: Scene, share: float) -> Scene:
    """Reduce the inertia that turns with the driver by a share."""
    light = turning_light(scene.links[scene.driver.link], share)
    return replace(scene, links={**scene.links, light.name: light})


def stronger_gravity(scene: Scene, share: float) -> Scene:
    x, y = scene.gravity_m_s2
    return replace(scene, gravity_m_s2=((1.0 + share) * x, (1.0 + share) * y))


def turned_gravity(scene: Scene, angle_rad: float) -> Scene:
    turned = complex(*scene.gravity_m_s2) * complex(math.cos(angle_rad), math.sin(angle_rad))
    return replace(scene, gravity_m_s2=(turned.real, turned.imag))


def faster_start(scene: Scene, share: float) -> Scene:
    law = scene.driver.law
    assert isinstance(law, driver.Released)
    faster = replace(law, speed_rad_s=(1.0 + share) * law.speed_rad_s)
    return replace(scene, driver=replace(scene.driver, law=faster))


LoadChange = Callable[[Scene, Load, float], Load]


def of_load(name: str, change: LoadChange) -> SceneChange:
    """Change a load of the scene."""

    def changed(scene: Scene, size: float) -> Scene:
        return replace(scene, loads={**scene.loads, name: change(scene, scene.loads[name], size)})

    return changed


def later(delay_s: float) -> LoadChange:
    """Delay a load over time by a multiple of a time."""
    return lambda _, load, times: replace(
        load, characteristic=load.characteristic.carried(1.0, shift=times * delay_s)
    )


def lasting(longer_s: float) -> LoadChange:
    """Lengthen a pulse by a multiple of a time."""

    def changed(_: Scene, load: Load, times: float) -> Load:
        pulse = load.characteristic
        assert isinstance(pulse, characteristics.Pulse)
        return replace(load, characteristic=replace(pulse, period=pulse.period + times * longer_s))

    return changed


def along_lines(_: Scene, load: Load, swap: float) -> Load:
    """Replace the curve of a table by straight lines from row to row."""
    table = load.characteristic
    assert isinstance(table, tabulated.Tabulated)
    return replace(load, characteristic=replace(table, interpolation="linear")) if swap else load


def reversed_load(_: Scene, load: Load, swap: float) -> Load:
    return replace(load, characteristic=load.characteristic.carried(-1.0)) if swap else load


def on_last_link(scene: Scene, load: Load, swap: float) -> Load:
    return replace(load, body=list(scene.links)[-1]) if swap else load


def held_at_start(scene: Scene, load: Load, swap: float) -> Load:
    """Let a motor keep the torque of the start at any speed."""
    law = scene.driver.law
    assert isinstance(law, driver.Released)
    first = float(load.magnitude(np.array([law.speed_rad_s]))[0])
    return (
        replace(load, characteristic=characteristics.Constant(first), over="time") if swap else load
    )


def spring_elsewhere(scene: Scene, off_m: float) -> Scene:
    """Move the first end of a spring between points on its link."""
    spring = next(iter(scene.springs.values()))
    assert isinstance(spring, LineSpring)
    (name, (x, y)), _ = joints.line_ends(scene, spring)
    scene = with_link(scene, name, points={**scene.links[name].points, "moved": (x + off_m, y)})
    other = replace(spring, points=("moved", spring.points[1]))
    return replace(scene, springs={**scene.springs, spring.name: other})


def of_spring(change: Callable[[SlideSpring, float, float], SlideSpring]) -> SceneChange:
    """Change the spring of a slider by a size, and by that size over the longest link."""

    def changed(scene: Scene, size: float) -> Scene:
        spring = next(iter(scene.springs.values()))
        assert isinstance(spring, SlideSpring)
        other = change(spring, size, size * scene.longest_m)
        return replace(scene, springs={**scene.springs, spring.name: other})

    return changed
