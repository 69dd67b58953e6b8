"""Links and a start from tables `[elastic.LINK]` and `[start]` of a scene file; their faults."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from models.errors import cut, few
from models.files.schema import ElasticTable, SceneTable, StartTable
from models.scene import Scene, Start
from models.scene.cut_links import line_of
from models.scene.driver import Controlled, Released
from models.scene.elastic import ElasticLink
from models.scene.laws import ConstantSpeed, Oscillating
from models.scene.tabulated import Tabulated

SAME = 1e-9
"""Relative tolerance of masses and lengths that a file states twice."""
SLENDER = 10.0
"""Least length over the height of the section; shorter beams shear and turn as they bend."""

MOST_DAMPED = 1e3
"""Largest multiple of the damping at which the first mode of a link stops swinging: with more the
link is rigid, and its creep takes turns without end."""


def elastic_of(table: SceneTable) -> dict[str, ElasticLink]:
    """Make the elastic links of a scene whose tables have no fault."""
    return {
        name: ElasticLink(
            name,
            _flexural(own),
            _axial(own),
            own.damping_s,
            own.height_m,
        )
        for name, own in table.elastic.items()
    }


def _flexural(own: ElasticTable) -> float:
    found = own.flexural
    return found if own.bends and found is not None else math.inf


def _axial(own: ElasticTable) -> float:
    found = own.axial
    return found if own.stretches and found is not None else math.inf


def mass_of(own: ElasticTable | None, length_m: float) -> float | None:
    """Return the mass of a link by its section and density [kg]; None without them."""
    if own is None or own.density_kg_m3 is None or own.area is None:
        return None
    return own.density_kg_m3 * own.area * length_m


def faults_of_beams(scene: Scene) -> Iterator[str]:
    """Yield one line per elastic link that is no uniform slender beam between its pins."""
    for name, own in scene.elastic.items():
        link, line = scene.links[name], line_of(scene, name)
        middle = line.at(0.5 * line.length_m)
        rod = link.mass_kg * line.length_m**2 / 12.0
        off = math.dist(middle, link.centre_m) > SAME * line.length_m
        if link.mass_kg == 0.0:
            yield f"elastic.{name}: the link has no mass; give it mass_kg, or density_kg_m3 here"
        elif off or abs(link.inertia_kg_m2 - rod) > SAME * rod:
            yield (
                f"elastic.{name}: an elastic link is a uniform slender beam from {line.pins[0]} to "
                f"{line.pins[1]}, of {rod:.6g} kg m^2 about its middle; leave centre_m, "
                "inertia_kg_m2 and flywheel_kg_m2 out, and points further out than its pins"
            )
        if own.height_m is not None and own.bends and line.length_m < SLENDER * own.height_m:
            yield (
                f"elastic.{name}: it is {line.length_m / own.height_m:.3g} heights of its section "
                f"long; from {SLENDER:g} on a beam bends as it does here, without shear"
            )
        first = own.bending_rad_s if own.bends else own.axial_rad_s
        critical_s = 2.0 / first(line.length_m, line.density_kg_m) if link.mass_kg else math.inf
        if own.damping_s > MOST_DAMPED * critical_s:
            yield (
                f"elastic.{name}: found damping_s = {own.damping_s:g}; from {critical_s:.3g} on "
                f"its first mode no longer swings, and with more than {MOST_DAMPED:g} times that "
                f"it is a rigid link; use {MOST_DAMPED * critical_s:.3g} or less, or leave the "
                "table out"
            )
    yield from _faults_of_loads(scene)
    if scene.elastic and scene.friction:
        yield (
            f"friction.{next(iter(scene.friction))}: friction and elastic links do not go together "
            "here; leave one of them out"
        )
    if scene.start.shape == "periodic" and not comes_back(scene.driver.law):
        yield (
            'start.shape: found "periodic"; that goes with a driver of constant speed, or one that '
            'oscillates; use "quasi-static" or "straight"'
        )
    if scene.start.shape and not scene.elastic:
        yield "start.shape: it goes with [elastic.LINK]; no link of the scene is elastic"


def _faults_of_loads(scene: Scene) -> Iterator[str]:
    """Yield one line per load that depends on the turning of an elastic link as a whole."""
    for name, load in scene.loads.items():
        if load.body not in scene.elastic:
            continue
        if load.point is None:
            yield (
                f"loads.{name}: it turns {load.body}, which is elastic: a torque bends it by where "
                "it acts; put it on a rigid link, or a force at a point"
            )
        elif load.over == "omega":
            yield (
                f"loads.{name}: it goes over the angular velocity of {load.body}, which is "
                "elastic and has many; put it on a rigid link"
            )


def comes_back(law: object) -> bool:
    """True if the speed of a driver repeats after a period."""
    return isinstance(law, ConstantSpeed | Oscillating)


def faults_of_elastic(
    elastic: Mapping[str, Any],
    ground: set[str],
    points: Mapping[str, set[str]],
    sliders: Mapping[str, Any],
    driver: object,
) -> Iterator[str]:
    """Yield one line per raw table of a missing link, or of a link that cannot be elastic."""
    for name in elastic:
        key = f"elastic.{cut(name)}"
        if name not in points:
            yield f"{key}: no link of that name; use one of {few(map(cut, points), 12)}"
            continue
        if name == driver:
            yield (
                f"{key}: the driver is a rigid link here: its angle is told, and one that bends "
                "has none of its own; drive a rigid crank that it is pinned to"
            )
        guided = [
            cut(slider)
            for slider, own in sliders.items()
            if isinstance(own, Mapping) and name in (own.get("on"), own.get("link"))
        ]
        if guided:
            yield (
                f"{key}: slider {guided[0]} holds it by a moment, which an elastic link is not "
                "given here; only links between two pins are"
            )
        pins = sorted(_pins(name, ground, points, sliders))
        if len(pins) != 2 and not guided:
            found = few(map(cut, pins), 12) if pins else "none"
            yield f"{key}: an elastic link lies between two pins; it has {len(pins)}: {found}"


def _pins(
    name: str, ground: set[str], points: Mapping[str, set[str]], sliders: Mapping[str, Any]
) -> set[str]:
    """Return the points of a link that other bodies are pinned to."""
    others = ground.union(*(own for link, own in points.items() if link != name))
    blocks = {
        str(slider.get("point", block))
        for block, slider in sliders.items()
        if isinstance(slider, Mapping) and "link" not in slider
    }
    return points[name] & (others | blocks)


OF_LINKS, OF_SLIDERS = ("angles_deg", "rates_rad_s"), ("displacements_m", "speeds_m_s")


def start_of(table: StartTable) -> Start:
    """Make the start, angles in radians."""
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
    """Yield one line per link or slider of the raw table that the scene lacks."""
    for keys, known in ((OF_LINKS, links), (OF_SLIDERS, sliders)):
        for key in keys:
            table = start.get(key)
            for name in table if isinstance(table, Mapping) else ():
                if name not in known:
                    have = f"use one of {few(map(cut, known), 12)}" if known else "there is none"
                    yield f"start.{key}: found {cut(name)}; {have}"


def faults_of_free_motion(scene: Scene) -> Iterator[str]:
    """Yield one line per fault of a scene in free motion, and of a driven one that has a start."""
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
    """Yield contradictions about the driver's start, and a start beyond the table of its load."""
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
