"""A whole scene file: its tables read into a Scene, and a Scene written as its text."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from numbers import Integral
from typing import Annotated

from pydantic import Field, StrictInt, StringConstraints

from models.errors import SceneError
from models.files import body_table, elastic_table, pair_tables, schema, spring_table
from models.files.driver_table import DriverTable, driver_of, driver_table, faults_of_driver
from models.files.load_table import LoadTable, faults_of_loads, load_of, load_table
from models.files.schema import MOST_BODIES, Coordinates, Name, Text
from models.scene import GROUND, Scene, span


class SceneTable(schema.Table):
    """A whole scene file; `models.files.driver_table.DRIVERS` checks its driver once the law is
    known, and `models.files.load_table.LOADS` its loads."""

    name: Name
    source: Annotated[Text, StringConstraints(min_length=1)]
    note: Text = ""
    ground: body_table.GroundTable
    links: dict[Name, body_table.LinkTable] = Field(min_length=1, max_length=MOST_BODIES)
    sliders: dict[Name, body_table.SliderTable] = Field(
        default_factory=dict, max_length=MOST_BODIES
    )
    driver: dict[str, object]
    branch: dict[Name, StrictInt] = Field(default_factory=dict)
    gravity_m_s2: Coordinates = (0.0, 0.0)
    tolerance: dict[Name, schema.Positive] = Field(default_factory=dict)
    loads: dict[Name, dict[str, object]] = Field(default_factory=dict, max_length=MOST_BODIES)
    friction: dict[Name, spring_table.FrictionTable] = Field(
        default_factory=dict, max_length=MOST_BODIES
    )
    springs: dict[Name, spring_table.SpringTable] = Field(
        default_factory=dict, max_length=MOST_BODIES
    )
    start: elastic_table.StartTable = Field(default_factory=elastic_table.StartTable)
    elastic: dict[Name, elastic_table.ElasticTable] = Field(
        default_factory=dict, max_length=MOST_BODIES
    )
    cams: dict[Name, pair_tables.CamTable] = Field(default_factory=dict, max_length=MOST_BODIES)
    gears: dict[Name, pair_tables.GearTable] = Field(default_factory=dict, max_length=MOST_BODIES)


FAULTS_OF_NAMES = {
    "links": body_table.faults_of_links,
    "sliders": body_table.faults_of_sliders,
    "driver": faults_of_driver,
    "loads": faults_of_loads,
    "friction": spring_table.faults_of_friction,
    "springs": spring_table.faults_of_springs,
    "gears": pair_tables.faults_of_gears,
    "cams": pair_tables.faults_of_cams,
    "start": elastic_table.faults_of_start,
    "elastic": elastic_table.faults_of_elastic,
    "branch": body_table.faults_of_branch,
}


def faults_of_names(raw: schema.RawTables) -> list[str]:
    """List one line per name that stands for nothing, or for two things."""
    names = schema.NamesInTables.of(raw)
    return [
        fault
        for key, faults in FAULTS_OF_NAMES.items()
        for fault in faults(schema.raw_tables(raw, key), names)
    ]


def scene_from_table(
    table: SceneTable, driver: DriverTable, loads: Mapping[str, LoadTable], place: str
) -> Scene:
    """Return the scene of the tables.

    Raises SceneError for links without length or too far away, masses that cannot be derived, loads
    that have no magnitude or act on no mass, an impossible free motion.
    """
    ground = table.ground.points
    points = {name: link.every_point for name, link in table.links.items()}
    faults: list[str] = []
    for body, places in [(GROUND, ground), *points.items()]:
        faults += body_table.coincident_points(body, places)
    for name, link in table.links.items():
        faults += link.faults_of_points(name)
    if faults:
        raise SceneError(place, faults)
    links = {
        name: link.link(name, table.elastic.get(name), faults) for name, link in table.links.items()
    }
    longest = max(span(p) for p in points.values())
    sliders = {name: slider.slider(name, longest) for name, slider in table.sliders.items()}
    acting = {name: load_of(name, load, sliders, faults) for name, load in loads.items()}
    try:
        driven = driver_of(driver, ground, links, sliders)
    except ValueError as error:
        faults.append(f"driver: {error}")
    cams = {}
    for name, one in table.cams.items():
        try:
            cams[name] = one.pair(name, {GROUND: ground, **points}, sliders)
        except ValueError as error:
            faults.append(f"cams.{name}: {error}")
    if longest == 0.0:
        faults.append("links: no link has two points, so the scene has no length; add a point")
    else:
        faults += table.ground.faults_of_place(longest)
    if faults:
        raise SceneError(place, faults)
    scene = Scene(
        name=table.name,
        source=table.source,
        note=table.note,
        ground=dict(ground),
        links=links,
        sliders=sliders,
        driver=driven,
        branch=dict(table.branch),
        gravity_m_s2=table.gravity_m_s2,
        tolerance=dict(table.tolerance),
        loads={name: load for name, load in acting.items() if load is not None},
        friction={joint: each.friction(joint) for joint, each in table.friction.items()},
        springs={n: each.spring(n, ground, links) for n, each in table.springs.items()},
        start=table.start.start(),
        elastic={name: each.elastic_link(name) for name, each in table.elastic.items()},
        gears={name: each.gear(name) for name, each in table.gears.items()},
        cams=cams,
    )
    if impossible := [
        *elastic_table.faults_of_free_motion(scene),
        *elastic_table.faults_of_beams(scene),
        *pair_tables.faults_of_meshes(scene),
        *pair_tables.faults_of_guides(scene),
    ]:
        raise SceneError(place, impossible)
    return scene


Table = Mapping[str, object]


def scene_text(scene: Scene, flywheels: Mapping[str, float] | None = None) -> str:
    """Return TOML that reads as the scene (`models.files.reading.parse_scene`), except for the last
    digit of angles, written in degrees. ``flywheels`` [kg m^2] are written beside the links' own
    inertia. Raises CrankcheckError for a law of another kind."""
    keys = ("name", "source", "note", "gravity_m_s2")
    head = {key: getattr(scene, key) for key in keys}
    return toml_text(head, dict(_tables(scene, flywheels or {})))


def _tables(scene: Scene, flywheels: Mapping[str, float]) -> Iterator[tuple[str, Table]]:
    yield "ground", {"points": scene.ground}
    for name, link in scene.links.items():
        yield f"links.{name}", body_table.link_table(link, flywheels.get(name))
    for name, slider in scene.sliders.items():
        yield f"sliders.{name}", body_table.slider_table(slider)
    yield "driver", driver_table(scene.driver)
    yield "branch", scene.branch
    yield "tolerance", scene.tolerance
    for name, load in scene.loads.items():
        yield f"loads.{name}", load_table(load)
    for name, spring in scene.springs.items():
        yield f"springs.{name}", spring_table.spring_table(spring)
    for name, gear in scene.gears.items():
        yield f"gears.{name}", pair_tables.gear_table(gear)
    for name, pair in scene.cams.items():
        yield f"cams.{name}", pair_tables.cam_table(pair)
    if scene.start:
        yield "start", elastic_table.start_table(scene.start)
    for name, own in scene.elastic.items():
        yield f"elastic.{name}", elastic_table.elastic_table(own)
    for joint, friction in scene.friction.items():
        slides = joint in scene.sliders
        yield f"friction.{joint}", spring_table.friction_table(friction, slides=slides)


def toml_text(head: Table, tables: Mapping[str, Table]) -> str:
    """Write keys with their values, then tables by their names."""
    lines = [f"{key} = {toml_value(value)}" for key, value in head.items()]
    for name, table in tables.items():
        lines += ["", f"[{name}]"]
        lines += [f"{key} = {toml_value(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


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
