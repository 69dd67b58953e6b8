"""Whether a scene can be let go as it says: a start that contradicts itself, no mass that moves."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from analytic.change_points.sign import AT_START
from analytic.free.machine import Machine
from analytic.kinematics import solve_driven
from analytic.prepared import prepared
from models.errors import CrankcheckError, SceneError
from models.motion import Motion
from models.released import Released
from models.scene import Scene
from models.springs import LineSpring

CLOSE = 1e-9
"""Points that are not as far apart are at one place: over the longest link."""
ROOM = 1e-6
"""By how much a start may be open that is written with some digits: [rad], and of the longest link
[m]; rates, by that of those that it follows from."""


def check_start(scene: Scene, machine: Machine, u: float) -> None:
    """Raises CrankcheckError for a start, at coordinate ``u`` of the machine, that contradicts
    itself; that has no mass that moves; that is at rest in a change point."""
    law = scene.driver.law
    assert isinstance(law, Released)
    turned = math.degrees(law.start_rad)
    chart = machine.chart
    if chart.limit is not None and u < ROOM and law.speed_rad_s:
        raise CrankcheckError(
            f"{scene.name}: {scene.driver.link} starts at its limit, {turned:.6g} deg, with "
            f"{law.speed_rad_s:g} rad/s, where it has no speed; let it go at rest, or beside it"
        )
    for key, passage in prepared(scene).passages.items():
        phase = np.abs(np.remainder(passage.angles - law.start_rad + 1.0, passage.period) - 1.0)
        if law.speed_rad_s == 0.0 and phase.min() <= 10.0 * AT_START:
            raise CrankcheckError(
                f"{scene.name}: it is let go at rest in the change point of {key}, at "
                f"{scene.driver.link} {turned:.6g} deg, where it may go on in two ways; give it a "
                "speed, or another angle"
            )
    place = np.array([u])
    inertia = float(machine.inertia(place)[0][0])
    # At a limit of the driver everything moves by the coordinate that is used there.
    if not inertia > 0.0:
        around = machine.inertia(u + 0.1 * np.array([-1.0, 1.0]) * (u or 1.0))[0]
        what = "nothing that moves has a mass"
        if np.any(around > 0.0):
            what = f"nothing that moves has a mass at {scene.driver.link} {turned:.6g} deg"
        raise CrankcheckError(f"{scene.name}: {what}; free motion needs one: give the links masses")
    theta, omega = np.array([law.start_rad]), np.array([law.speed_rad_s])
    found = solve_driven(scene, theta, omega, np.zeros(1), bound=False)
    if faults := [*_contradictions(scene, found), *_without_direction(scene, found)]:
        raise SceneError(scene.name, faults)


def _without_direction(scene: Scene, at: Motion) -> Iterator[str]:
    """Springs whose two points are at one place, in words."""
    for spring in scene.springs.values():
        if isinstance(spring, LineSpring):
            a, b = (at.points[name].position[0] for name in spring.points)
            if math.dist(a, b) <= CLOSE * scene.longest_m:
                yield (
                    f"springs.{spring.name}: {' and '.join(spring.points)} are at one place at the "
                    "start, where a pull between them has no direction; let it go from elsewhere"
                )


def _contradictions(scene: Scene, at: Motion) -> Iterator[str]:
    """Where the start of a scene is not that of its assembly, in words."""
    start, long_m = scene.start, scene.longest_m
    links, sliders = at.links, at.sliders
    fastest = max(
        [abs(float(link.omega[0])) for link in links.values()]
        + [abs(float(slider.speed[0])) / long_m for slider in sliders.values()]
    )
    told = (
        *((f"angles_deg.{n}", a, links[n].theta, ROOM, "rad") for n, a in start.angles_rad.items()),
        *(
            (f"rates_rad_s.{n}", w, links[n].omega, ROOM * fastest, "rad/s")
            for n, w in start.rates_rad_s.items()
        ),
        *(
            (f"displacements_m.{n}", s, sliders[n].displacement, ROOM * long_m, "m")
            for n, s in start.displacements_m.items()
        ),
        *(
            (f"speeds_m_s.{n}", v, sliders[n].speed, ROOM * long_m * fastest, "m/s")
            for n, v in start.speeds_m_s.items()
        ),
    )
    for key, value, own, room, unit in told:
        here = float(own[0])
        off, size = value - here, 1.0
        shown = unit
        if unit == "rad":
            off, size, shown = math.remainder(off, math.tau), math.degrees(1.0), "deg"
        if abs(off) > room:
            yield (
                f"start.{key}: found {size * value:.9g} {shown}, where the assembly has "
                f"{size * here:.9g} {shown} with {scene.driver.link} as it is: it is open by "
                f"{abs(off):.3g} {unit}; leave it out, or give that"
            )
