"""From the table `[start]` of a scene file to a start, and what is wrong with its names."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from models.driver import Controlled, Released
from models.errors import cut, few
from models.files.schema import StartTable
from models.scene import Scene, Start
from models.tabulated import Tabulated

OF_LINKS, OF_SLIDERS = ("angles_deg", "rates_rad_s"), ("displacements_m", "speeds_m_s")


def start_of(table: StartTable) -> Start:
    """The start, angles in radians."""
    return Start(
        {link: math.radians(angle) for link, angle in table.angles_deg.items()},
        dict(table.rates_rad_s),
        dict(table.displacements_m),
        dict(table.speeds_m_s),
        table.shape,
    )


def faults_of_start(
    start: Mapping[str, Any], links: Mapping[str, Any], sliders: Mapping[str, Any]
) -> Iterator[str]:
    """One line per link or slider of the raw table that the scene has not."""
    for keys, known in ((OF_LINKS, links), (OF_SLIDERS, sliders)):
        for key in keys:
            table = start.get(key)
            for name in table if isinstance(table, Mapping) else ():
                if name not in known:
                    have = f"use one of {few(map(cut, known), 12)}" if known else "there is none"
                    yield f"start.{key}: found {cut(name)}; {have}"


SAME = 1e-9
"""Numbers that a file says twice, in degrees once and once in radians, agree to so much."""


def faults_of_free_motion(scene: Scene) -> Iterator[str]:
    """One line per fault of a scene that is let go, and of one that is driven and has a start."""
    law = scene.driver.law
    if scene.start.shape == "periodic" and isinstance(law, Controlled | Released):
        yield (
            'start.shape: found "periodic" with a driver whose angle is not told: it comes back '
            'after no period that is known before; give "quasi-static" or "straight"'
        )
    if not isinstance(law, Released):
        if replace(scene.start, shape=None):
            yield 'start: it goes with law = "free"; a driven mechanism starts as its law has it'
        return
    yield from _of_driver(scene, law)
    for joint in scene.coulomb_joints:
        yield (
            f"friction.{joint}: friction by mu follows from the reactions, and free motion is not "
            "worked out with it; give torque_n_m of a pin, or force_n of a slider"
        )
    links, blocks = scene.links.values(), scene.sliders.values()
    if not any(link.mass_kg > 0.0 for link in links) and not any(b.mass_kg > 0.0 for b in blocks):
        yield (
            "links: no body has a mass, and nothing says how fast it would move; give mass_kg, or "
            "leave it out for slender rods"
        )


def _of_driver(scene: Scene, law: Released) -> Iterator[str]:
    """What is said of the driver's start twice, in two ways, or beyond what moves it."""
    name = scene.driver.link
    theta, omega = law.start_rad, law.speed_rad_s
    angle = scene.start.angles_rad.get(name, theta)
    if abs(angle - theta) > SAME * max(1.0, abs(theta)):
        yield (
            f"start.angles_deg.{name}: found {math.degrees(angle):g}, and start_deg of [driver] is "
            f"{math.degrees(theta):g}; leave it out here"
        )
    rate = scene.start.rates_rad_s.get(name, omega)
    if abs(rate - omega) > SAME * max(1.0, abs(omega)):
        yield (
            f"start.rates_rad_s.{name}: found {rate:g}, and speed_rad_s of [driver] is {omega:g}; "
            "leave it out here"
        )
    for load in scene.loads.values():
        own = load.characteristic
        if load.over != "omega" or load.body != name or not isinstance(own, Tabulated):
            continue
        if own.nearest(omega) != omega:
            yield (
                f"loads.{load.name}.at_rad_s: {name} starts at {omega:g} rad/s, and the table goes "
                f"from {own.places[0]:g} to {own.places[-1]:g}; give it rows for all speeds of the "
                "motion"
            )
