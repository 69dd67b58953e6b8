"""Conversion of the tables of a scene file to a Scene: short forms expanded, names checked."""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from numbers import Integral

from models.errors import SceneError
from models.files import elastic_table, schema
from models.files.driver_table import DriverTable, driver_of, driver_table
from models.files.load_table import LawOfLoad, in_degrees, load_of, load_table
from models.files.spring_table import springs_of
from models.scene import GROUND, Link, Point, Scene, Slider, Start, span
from models.scene.elastic import ElasticLink
from models.scene.loads import (
    ConstantFriction,
    CoulombFriction,
    Friction,
    LineSpring,
    PinSpring,
    Spring,
)

ROD_KG_PER_M = 1.0
FARTHEST = 1e12
"""Largest distance of a ground point, over the longest link: positions keep four digits there."""
BLOCK_OF_LONGEST = 0.1
"""Side of a square slider block with mass, over the longest link, for the default inertia."""


def scene_from_table(
    table: schema.SceneTable, driver: DriverTable, loads: Mapping[str, LawOfLoad], place: str
) -> Scene:
    """Return the scene of the tables.

    Raises
    ------
    SceneError
        Links without length or too far away, masses that cannot be derived, loads that have no
        magnitude or act on no mass, an impossible free motion.
    """
    faults: list[str] = []
    points = {name: _points(link) for name, link in table.links.items()}
    faults += _faults_of_lengths(table, points)
    if faults:
        raise SceneError(place, faults)
    links = {
        name: _link(name, link, points[name], table.elastic.get(name), faults)
        for name, link in table.links.items()
    }
    longest = max(span(p) for p in points.values())
    sliders = {name: _slider(name, slider, longest) for name, slider in table.sliders.items()}
    found = {name: load_of(name, load, sliders, faults) for name, load in loads.items()}
    try:
        driven = driver_of(driver, table.ground.points, links, sliders)
    except ValueError as error:
        faults.append(f"driver: {error}")
    if longest == 0.0:
        faults.append("links: no link has two points, so the scene has no length; add a point")
    else:
        faults += _faults_of_place(table.ground.points, longest)
    if faults:
        raise SceneError(place, faults)
    scene = Scene(
        name=table.name,
        source=table.source,
        note=table.note,
        ground=dict(table.ground.points),
        links=links,
        sliders=sliders,
        driver=driven,
        branch=dict(table.branch),
        gravity_m_s2=table.gravity_m_s2,
        tolerance=dict(table.tolerance),
        loads={name: load for name, load in found.items() if load is not None},
        friction={joint: _friction(joint, table) for joint, table in table.friction.items()},
        springs=springs_of(table),
        start=elastic_table.start_of(table.start),
        elastic=elastic_table.elastic_of(table),
    )
    if impossible := [
        *elastic_table.faults_of_free_motion(scene),
        *elastic_table.faults_of_beams(scene),
    ]:
        raise SceneError(place, impossible)
    return scene


def _points(link: schema.LinkTable) -> dict[str, Point]:
    """Return all points of a link in its frame, including the ends of its bar."""
    bar: dict[str, Point] = {}
    if link.bar is not None and link.length_m is not None:
        bar = {link.bar[0]: (0.0, 0.0), link.bar[1]: (link.length_m, 0.0)}
    return bar | dict(link.points)


def _faults_of_lengths(
    table: schema.SceneTable, points: Mapping[str, Mapping[str, Point]]
) -> list[str]:
    """List points that coincide, and links whose mass cannot be spread over a length."""
    faults = []
    for name, places in [(GROUND, table.ground.points), *points.items()]:
        names = list(places)
        faults += [
            f"{'' if name == GROUND else 'links.'}{name}: length {a}{b} is "
            f"{math.dist(places[a], places[b]):g}; set the points apart"
            for i, a in enumerate(names)
            for b in names[i + 1 :]
            if math.dist(places[a], places[b]) < 1 / schema.LARGEST
        ]
    for name, link in table.links.items():
        if link.bar is not None and set(link.bar) & set(link.points):
            faults.append(f"links.{name}.points: the ends of the bar stand there already")
        given = (link.mass_kg, link.centre_m, link.inertia_kg_m2)
        if len(points[name]) < 2 and None in given:
            faults.append(
                f"links.{name}: one point has no length to derive a mass from; give "
                "mass_kg, centre_m and inertia_kg_m2, or a second point"
            )
    return faults


def _faults_of_place(ground: Mapping[str, Point], longest: float) -> list[str]:
    """List points so far away that a float cannot distinguish the places of the links."""
    return [
        f"ground.points.{name}: {math.hypot(*place):.3g} m from the origin, {far:.3g} times the "
        f"longest link ({longest:.3g} m); at most {FARTHEST:g}: move the scene towards the origin"
        for name, place in ground.items()
        if (far := math.hypot(*place) / longest) > FARTHEST
    ]


def _longest(points: Mapping[str, Point]) -> tuple[float, Point, Point]:
    """Return the largest distance between two points, and the two."""
    places = list(points.values())
    pairs = [(math.dist(a, b), a, b) for i, a in enumerate(places) for b in places[i:]]
    return max(pairs, key=lambda pair: pair[0])


def _link(
    name: str,
    table: schema.LinkTable,
    points: dict[str, Point],
    elastic: schema.ElasticTable | None,
    faults: list[str],
) -> Link:
    """Make a link; missing mass data default to a uniform slender rod on its longest span."""
    length, a, b = _longest(points)
    given, own = elastic_table.mass_of(elastic, length), table.mass_kg
    if given is not None and own is not None:
        faults.append(
            f"links.{name}: mass_kg is {own:g}, and its section and density_kg_m3 give {given:g}; "
            "give one of them"
        )
    mass = next((one for one in (own, given) if one is not None), ROD_KG_PER_M * length)
    centre = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) if table.centre_m is None else table.centre_m
    inertia = mass * length**2 / 12 if table.inertia_kg_m2 is None else table.inertia_kg_m2
    if mass == 0.0 and inertia > 0.0:
        faults.append(f"links.{name}: inertia_kg_m2 is {inertia} with mass_kg 0; give both or none")
    if mass == 0.0 and table.flywheel_kg_m2 > 0.0:
        faults.append(
            f"links.{name}: flywheel_kg_m2 is {table.flywheel_kg_m2:g} with mass_kg 0; give the "
            "link the mass of its flywheel too"
        )
    return Link(name, points, mass, centre, inertia + table.flywheel_kg_m2)


def _slider(name: str, table: schema.SliderTable, longest: float) -> Slider:
    """Make a slider with angles in rad and, if it has a mass, the inertia of a square block."""
    mass = table.mass_kg or 0.0
    side = BLOCK_OF_LONGEST * longest
    inertia = mass * side**2 / 6 if table.inertia_kg_m2 is None else table.inertia_kg_m2
    return Slider(
        name=name,
        point=table.point or name,
        on=table.on,
        through_m=table.through_m,
        direction_rad=schema.within_a_turn(table.direction_deg),
        link=table.link,
        angle_rad=schema.within_a_turn(table.angle_deg),
        mass_kg=mass,
        inertia_kg_m2=inertia,
    )


def _friction(joint: str, table: schema.FrictionTable) -> Friction:
    """Make the friction of a joint."""
    if table.mu is not None:
        return CoulombFriction(joint, table.mu, table.radius_m or 0.0)
    size = table.torque_n_m if table.force_n is None else table.force_n
    assert size is not None
    return ConstantFriction(joint, size)


Table = Mapping[str, object]


def scene_text(scene: Scene, flywheels: Mapping[str, float] | None = None) -> str:
    """Return TOML that reads as the scene (`models.files.reading.parse_scene`), except for the last
    digit of angles, written in degrees. ``flywheels`` [kg m^2] are written beside the links' own
    inertia. Raises CrankcheckError for a law of another kind."""
    lines = [
        f"{name} = {toml_value(value)}"
        for name, value in (
            ("name", scene.name),
            ("source", scene.source),
            ("note", scene.note),
            ("gravity_m_s2", scene.gravity_m_s2),
        )
    ]
    for head, table in _tables(scene, flywheels or {}):
        lines += [
            "",
            f"[{head}]",
            *(f"{key} = {toml_value(value)}" for key, value in table.items()),
        ]
    return "\n".join(lines) + "\n"


def _tables(scene: Scene, flywheels: Mapping[str, float]) -> Iterator[tuple[str, Table]]:
    """Yield the tables of the file, in its order."""
    yield "ground", {"points": scene.ground}
    for name, link in scene.links.items():
        yield (
            f"links.{name}",
            {
                "points": link.points,
                "mass_kg": link.mass_kg,
                "centre_m": link.centre_m,
                "inertia_kg_m2": link.inertia_kg_m2,
                **({"flywheel_kg_m2": flywheels[name]} if name in flywheels else {}),
            },
        )
    for name, slider in scene.sliders.items():
        yield f"sliders.{name}", _slider_table(slider)
    yield "driver", driver_table(scene.driver)
    yield "branch", scene.branch
    yield "tolerance", scene.tolerance
    for name, load in scene.loads.items():
        yield f"loads.{name}", load_table(load)
    for name, spring in scene.springs.items():
        yield f"springs.{name}", _spring(spring)
    if scene.start:
        yield "start", _start(scene.start)
    for name, own in scene.elastic.items():
        yield f"elastic.{name}", _elastic(own)
    for joint, friction in scene.friction.items():
        yield f"friction.{joint}", _friction_table(friction, slides=joint in scene.sliders)


def _friction_table(friction: Friction, *, slides: bool) -> Table:
    if isinstance(friction, ConstantFriction):
        return {"force_n" if slides else "torque_n_m": friction.size}
    table = {"mu": friction.mu}
    return table if slides else {**table, "radius_m": friction.radius_m}


def _spring(spring: Spring) -> Table:
    if isinstance(spring, PinSpring):
        return {
            "pin": spring.point,
            "bodies": spring.bodies,
            "rate_n_m_rad": spring.rate,
            "damping_n_m_s": spring.damping,
            "free_deg": in_degrees(spring.free),
        }
    own = {"rate_n_m": spring.rate, "damping_n_s_m": spring.damping, "free_m": spring.free}
    if isinstance(spring, LineSpring):
        return {"points": spring.points, **own}
    return {"slider": spring.slider, **own}


def _start(start: Start) -> Table:
    angles = {link: in_degrees(angle) for link, angle in start.angles_rad.items()}
    return {
        "angles_deg": angles,
        "rates_rad_s": start.rates_rad_s,
        "displacements_m": start.displacements_m,
        "speeds_m_s": start.speeds_m_s,
        **({"shape": start.shape} if start.shape else {}),
    }


def _elastic(own: ElasticLink) -> Table:
    return {
        "bends": own.bends,
        "stretches": own.stretches,
        **({"flexural_n_m2": own.flexural_n_m2} if own.bends else {}),
        **({"axial_n": own.axial_n} if own.stretches else {}),
        "damping_s": own.damping_s,
        **({"height_m": own.height_m} if own.height_m is not None else {}),
    }


def _slider_table(slider: Slider) -> Table:
    table: dict[str, object] = {
        "point": slider.point,
        "on": slider.on,
        "through_m": slider.through_m,
        "direction_deg": in_degrees(slider.direction_rad),
    }
    if slider.link is not None:
        return {**table, "link": slider.link, "angle_deg": in_degrees(slider.angle_rad)}
    return {**table, "mass_kg": slider.mass_kg, "inertia_kg_m2": slider.inertia_kg_m2}


def toml_value(value: object) -> str:
    """Format a value in TOML."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {toml_value(each)}' for key, each in value.items())} }}"
    if isinstance(value, Sequence):
        return f"[{', '.join(map(toml_value, value))}]"
    return repr(int(value) if isinstance(value, Integral) else float(value))  # type: ignore[arg-type]
