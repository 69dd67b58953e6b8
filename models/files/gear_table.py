"""Tables `[gears.NAME]` of a scene file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Annotated

from pydantic import Field, StrictBool, StrictInt, model_validator

from models.errors import cut
from models.files import schema
from models.files.schema import Name
from models.scene import GROUND, Scene
from models.scene.pairs import FITS, Gear

Teeth = Annotated[StrictInt, Field(ge=1, le=100_000)]
STEEPEST_DEG = 45.0
"""Largest pressure angle of a table [deg]; teeth in use have 14.5 to 30."""


class GearTable(schema.Table):
    """Two gears in mesh: ``bodies`` with ``teeth``, in ``internal`` pairs the ring as the second,
    on centres carried by ``carrier``."""

    bodies: tuple[Name, Name]
    teeth: tuple[Teeth, Teeth]
    carrier: Name = GROUND
    internal: StrictBool = False
    module_m: schema.Positive | None = None
    pressure_angle_deg: Annotated[schema.Positive, Field(le=STEEPEST_DEG)] = 20.0
    efficiency: Annotated[schema.Positive, Field(le=1.0)] = 1.0
    phase_deg: schema.Degrees = 0.0

    @model_validator(mode="after")
    def _ring_has_more_teeth(self) -> GearTable:
        if self.internal and self.teeth[1] <= self.teeth[0]:
            raise ValueError(
                f"teeth are {self.teeth[0]} and {self.teeth[1]}; the second of an internal pair is "
                "the ring, which has more teeth: exchange them, or leave internal out"
            )
        return self

    def gear(self, name: str) -> Gear:
        """Make the pair of a scene without faults (`faults_of_gears`)."""
        return Gear(
            name=name,
            bodies=self.bodies,
            teeth=self.teeth,
            carrier=self.carrier,
            internal=self.internal,
            module_m=self.module_m,
            pressure_angle_rad=math.radians(self.pressure_angle_deg),
            efficiency=self.efficiency,
            phase_rad=math.radians(self.phase_deg),
        )


def gear_table(gear: Gear) -> Mapping[str, object]:
    """Write the table of a pair."""
    return {
        "bodies": gear.bodies,
        "teeth": gear.teeth,
        "carrier": gear.carrier,
        "internal": gear.internal,
        **({} if gear.module_m is None else {"module_m": gear.module_m}),
        "pressure_angle_deg": schema.in_degrees(gear.pressure_angle_rad),
        "efficiency": gear.efficiency,
        "phase_deg": schema.in_degrees(gear.phase_rad),
    }


def faults_of_gears(gears: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per raw table whose bodies or carrier are missing, or are one body."""
    known = [GROUND, *names.points]
    for key, _, table in schema.each_of(gears, "gears"):
        listed, carrier = table.get("bodies"), table.get("carrier", GROUND)
        bodies = [b for b in (listed if isinstance(listed, list) else []) if isinstance(b, str)]
        for place, body in [*(("bodies", b) for b in bodies), ("carrier", carrier)]:
            if isinstance(body, str) and body not in known:
                yield f"{key}.{place}: found {cut(body)}; {schema.use_one_of(known)}"
        if len(bodies) == 2 and bodies[0] == bodies[1]:
            yield f"{key}.bodies: found {cut(bodies[0])} twice; name two bodies"
        elif carrier in bodies:
            yield (
                f"{key}.carrier: {cut(carrier)} is one of the two gears; name the body that "
                "carries both centres"
            )


def faults_of_meshes(scene: Scene) -> Iterator[str]:
    """Yield one line per pair whose gears do not turn on its carrier, whose centre distance does
    not fit, or with a body that is elastic."""
    for name, gear in scene.gears.items():
        key, points = f"gears.{name}", scene.points_of
        for body in dict.fromkeys((*gear.bodies, gear.carrier)):
            if body in scene.elastic:
                yield f"{key}: {body} is elastic, and gears and carriers are rigid here"
        try:
            distance = gear.distance_m(points)
        except ValueError as error:
            yield f"{key}: {error}"
            continue
        if gear.module_m is None:
            continue
        count = abs(gear.teeth[0] + gear.second)
        fitting = 0.5 * gear.module_m * count
        if abs(distance - fitting) > FITS * fitting:
            yield (
                f"{key}.module_m: {gear.module_m:g} with {gear.teeth[0]} and {gear.teeth[1]} teeth "
                f"needs a centre distance of {fitting:.9g} m, found {distance:.9g} m; use "
                f"{2.0 * distance / count:.9g}, leave it out, or move the centres"
            )
