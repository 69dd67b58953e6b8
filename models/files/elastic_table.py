"""Tables `[elastic.LINK]` and `[start]` of a scene file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.errors import cut, few
from models.files import schema
from models.files.schema import LARGEST, MOST_BODIES, Degrees, Name, Number, Positive
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
SECTION = "width_m and height_m, or area_m2 and second_moment_m4"
Section = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST**2, le=LARGEST)]
"""Quantity that grows with squares of lengths, or their squares: a thin strip's is under 1e-15."""


class ElasticTable(schema.Table):
    """Stiffness of a link in bending, in stretching, or both: by its modulus and section, or by EI
    and EA. A density with the section gives its mass, which otherwise is the mass of the link."""

    modulus_pa: Positive | None = None
    width_m: Positive | None = None
    height_m: Positive | None = None
    """Height of a rectangle, in the plane of the motion."""
    area_m2: Section | None = None
    second_moment_m4: Section | None = None
    flexural_n_m2: Section | None = None
    axial_n: Positive | None = None
    density_kg_m3: Positive | None = None
    damping_s: schema.NonNegative = 0.0
    bends: bool = True
    stretches: bool = False

    @property
    def area(self) -> float | None:
        """Area of the section [m^2]."""
        if self.width_m is not None and self.height_m is not None:
            return self.width_m * self.height_m
        return self.area_m2

    @property
    def second_moment(self) -> float | None:
        """Second moment of area, about the axis across the plane [m^4]."""
        if self.width_m is not None and self.height_m is not None:
            return self.width_m * self.height_m**3 / 12.0
        return self.second_moment_m4

    @property
    def flexural(self) -> float | None:
        """EI [N m^2]."""
        if self.modulus_pa is not None and self.second_moment is not None:
            return self.modulus_pa * self.second_moment
        return self.flexural_n_m2

    @property
    def axial(self) -> float | None:
        """EA [N]."""
        if self.modulus_pa is not None and self.area is not None:
            return self.modulus_pa * self.area
        return self.axial_n

    @model_validator(mode="after")
    def _has_one_section(self) -> ElasticTable:
        rectangle, other = (self.width_m, self.height_m), (self.area_m2, self.second_moment_m4)
        if self.width_m is not None and self.height_m is None:
            raise ValueError("width_m goes with height_m, which is missing")
        if None not in rectangle and any(each is not None for each in other):
            raise ValueError(f"found two sections; give one: {SECTION}")
        if self.modulus_pa is not None and (self.flexural_n_m2 or self.axial_n):
            raise ValueError(
                "modulus_pa with a section gives flexural_n_m2 and axial_n too; give one of them"
            )
        if self.density_kg_m3 is not None and self.area is None:
            raise ValueError(f"density_kg_m3 goes with a section: {SECTION}")
        return self

    @model_validator(mode="after")
    def _gives_way(self) -> ElasticTable:
        if not (self.bends or self.stretches):
            raise ValueError("it neither bends nor stretches; leave the table out")
        missing = [
            f"{key} (or modulus_pa with {SECTION})"
            for key, asked, value in (
                ("flexural_n_m2", self.bends, self.flexural),
                ("axial_n", self.stretches, self.axial),
            )
            if asked and value is None
        ]
        if missing:
            raise ValueError(f"its stiffness is missing: give {' and '.join(missing)}")
        return self

    def mass_kg(self, length_m: float) -> float | None:
        """Return the mass of a link by its section and density [kg]; None without them."""
        if self.density_kg_m3 is None or self.area is None:
            return None
        return self.density_kg_m3 * self.area * length_m

    def elastic_link(self, name: str) -> ElasticLink:
        """Make the elastic link of a table without a fault."""
        flexural, axial = self.flexural, self.axial
        return ElasticLink(
            name,
            flexural if self.bends and flexural is not None else math.inf,
            axial if self.stretches and axial is not None else math.inf,
            self.damping_s,
            self.height_m,
        )


def elastic_table(own: ElasticLink) -> Mapping[str, object]:
    """Write the table of an elastic link."""
    return {
        "bends": own.bends,
        "stretches": own.stretches,
        **({"flexural_n_m2": own.flexural_n_m2} if own.bends else {}),
        **({"axial_n": own.axial_n} if own.stretches else {}),
        "damping_s": own.damping_s,
        **({"height_m": own.height_m} if own.height_m is not None else {}),
    }


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
                f"elastic.{name}: an elastic link is a uniform slender beam from {line.pins[0]} "
                f"to {line.pins[1]}, of {rod:.6g} kg m^2 about its middle; leave centre_m, "
                "inertia_kg_m2 and flywheel_kg_m2 out, and points beyond its pins"
            )
        if own.height_m is not None and own.bends and line.length_m < SLENDER * own.height_m:
            yield (
                f"elastic.{name}: its length is {line.length_m / own.height_m:.3g} heights of "
                f"its section; this beam, without shear, needs {SLENDER:g} or more"
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
            f"friction.{next(iter(scene.friction))}: friction and elastic links can not be "
            "combined; leave one of them out"
        )
    if scene.start.shape == "periodic" and not isinstance(
        scene.driver.law, ConstantSpeed | Oscillating
    ):
        yield (
            'start.shape: found "periodic"; that needs a driver of constant speed, or an '
            'oscillating one; use "quasi-static" or "straight"'
        )
    if scene.start.shape and not scene.elastic:
        yield "start.shape: it needs [elastic.LINK]; no link of the scene is elastic"


def _faults_of_loads(scene: Scene) -> Iterator[str]:
    """Yield one line per load that depends on the turning of an elastic link as a whole."""
    for name, load in scene.loads.items():
        if load.body not in scene.elastic:
            continue
        if load.point is None:
            yield (
                f"loads.{name}: a torque on {load.body}, which is elastic, bends it by its "
                "place; put it on a rigid link, or give a force at a point"
            )
        elif load.over == "omega":
            yield (
                f"loads.{name}: it depends on the angular velocity of {load.body}, which is "
                "elastic and has many; put it on a rigid link"
            )


def faults_of_elastic(elastic: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per raw table of a missing link, or of a link that cannot be elastic."""
    for name in elastic:
        key = f"elastic.{cut(name)}"
        if name not in names.points:
            links = few(map(cut, names.points), schema.LISTED)
            yield f"{key}: no link of that name; use one of {links}"
            continue
        if name == names.driver:
            yield (
                f"{key}: the driver has to be a rigid link, as an elastic one has no single angle; "
                "drive a rigid crank that it is pinned to"
            )
        guided = [
            cut(slider)
            for _, slider, own in schema.each_of(names.sliders, "sliders")
            if name in (own.get("on"), own.get("link"))
        ]
        if guided:
            yield (
                f"{key}: slider {guided[0]} holds it by a moment; only links between two pins "
                "can be elastic"
            )
        others = (own for link, own in names.points.items() if link != name)
        pinned = names.ground.union(names.blocks.values(), *others)
        pins = sorted(names.points[name] & pinned)
        if len(pins) != 2 and not guided:
            found = few(map(cut, pins), schema.LISTED) if pins else "none"
            yield f"{key}: an elastic link lies between two pins; it has {len(pins)}: {found}"


class StartTable(schema.Table):
    """Start of free motion beyond the driver, by link and by slider; and of elastic links."""

    angles_deg: dict[Name, Degrees] = Field(default_factory=dict, max_length=MOST_BODIES)
    rates_rad_s: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    displacements_m: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    speeds_m_s: dict[Name, Number] = Field(default_factory=dict, max_length=MOST_BODIES)
    shape: Literal["quasi-static", "straight", "periodic"] | None = None

    def start(self) -> Start:
        """Make the start, angles in radians."""
        return Start(
            {link: math.radians(angle) for link, angle in self.angles_deg.items()},
            dict(self.rates_rad_s),
            dict(self.displacements_m),
            dict(self.speeds_m_s),
            self.shape,
        )


def start_table(start: Start) -> Mapping[str, object]:
    """Write the table of a start."""
    return {
        "angles_deg": {n: schema.in_degrees(angle) for n, angle in start.angles_rad.items()},
        "rates_rad_s": start.rates_rad_s,
        "displacements_m": start.displacements_m,
        "speeds_m_s": start.speeds_m_s,
        **({"shape": start.shape} if start.shape else {}),
    }


def faults_of_start(start: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per link or slider of the raw table that the scene lacks."""
    for key, known in (
        ("angles_deg", names.points),
        ("rates_rad_s", names.points),
        ("displacements_m", names.sliders),
        ("speeds_m_s", names.sliders),
    ):
        for name in schema.raw_tables(start, key):
            if name not in known:
                have = schema.use_one_of(known, "there is none")
                yield f"start.{key}: found {cut(name)}; {have}"


def faults_of_free_motion(scene: Scene) -> Iterator[str]:
    """Yield one line per fault of a scene in free motion, and of a driven one that has a start."""
    law = scene.driver.law
    if scene.start.shape == "periodic" and isinstance(law, Controlled | Released):
        yield (
            'start.shape: found "periodic" with a free driver, which has no known period; give '
            '"quasi-static" or "straight"'
        )
    if not isinstance(law, Released):
        if replace(scene.start, shape=None):
            yield 'start: only for law = "free"; a driven mechanism starts by its law'
        return
    yield from _of_driver(scene, law)
    for joint in scene.coulomb_joints:
        yield (
            f"friction.{joint}: friction by mu follows from the reactions, and free motion is "
            "not computed with it; give torque_n_m of a pin, or force_n of a slider"
        )
    links, blocks = scene.links.values(), scene.sliders.values()
    if not any(link.mass_kg > 0.0 for link in links) and not any(b.mass_kg > 0.0 for b in blocks):
        yield (
            "links: no body has a mass, so its motion is not determined; give mass_kg, or leave it "
            "out for slender rods"
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
