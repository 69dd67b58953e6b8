"""Table of the driver, a model for each law: of a link or a pin, and of a slider."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Annotated, Literal

from pydantic import AfterValidator, model_validator

from models.errors import CrankcheckError, cut, few
from models.files import schema
from models.scene import GROUND, Driver, Link, Point, Slider
from models.scene.driver import Controlled, Released
from models.scene.joints import sliding_body
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating


class TurningDriver(schema.Table):
    """A turning driver: a ``link`` about its ground pin; or a ``pin``, by the angle of the second
    of two ``links`` less the angle of the first."""

    link: schema.Name | None = None
    pin: schema.Name | None = None
    links: tuple[schema.Name, schema.Name] | None = None
    law: str

    @model_validator(mode="after")
    def _is_one_joint(self) -> TurningDriver:
        if (self.link is None) == (self.pin is None):
            raise ValueError(
                'name the driven joint, one of link = "crank", pin = "B" and slider = "C"'
            )
        if self.links is not None and self.pin is None:
            raise ValueError('links go with a pin: pin = "B", links = ["crank", "coupler"]')
        return self


class SlidingDriver(schema.Table):
    """A driven ``slider``, by its displacement."""

    slider: schema.Name
    law: str


class ConstantDriver(TurningDriver):
    law: Literal["constant"] = "constant"
    speed_rad_s: schema.RateNumber
    start_deg: schema.Degrees = 0.0


class ConstantSlide(SlidingDriver):
    law: Literal["constant"] = "constant"
    speed_m_s: schema.RateNumber
    start_m: schema.Number = 0.0
    travel_m: schema.Positive


class OscillatingDriver(TurningDriver):
    law: Literal["oscillating"]
    centre_deg: schema.Degrees
    amplitude_deg: Annotated[schema.Degrees, AfterValidator(schema.not_tiny)]
    frequency_rad_s: schema.RateNumber
    phase_deg: schema.Degrees = 0.0


class OscillatingSlide(SlidingDriver):
    law: Literal["oscillating"]
    centre_m: schema.Number
    amplitude_m: schema.RateNumber
    frequency_rad_s: schema.RateNumber
    phase_deg: schema.Degrees = 0.0


class FromRestDriver(TurningDriver):
    law: Literal["from-rest"]
    speed_rad_s: schema.RateNumber
    rise_s: schema.Positive
    start_deg: schema.Degrees = 0.0


class FromRestSlide(SlidingDriver):
    law: Literal["from-rest"]
    speed_m_s: schema.RateNumber
    rise_s: schema.Positive
    start_m: schema.Number = 0.0
    travel_m: schema.Positive


class AcceleratingDriver(TurningDriver):
    law: Literal["accelerating"]
    speed_rad_s: schema.RateNumber
    acceleration_rad_s2: schema.RateNumber
    start_deg: schema.Degrees = 0.0


class AcceleratingSlide(SlidingDriver):
    law: Literal["accelerating"]
    speed_m_s: schema.RateNumber
    acceleration_m_s2: schema.RateNumber
    start_m: schema.Number = 0.0
    travel_m: schema.Positive


class ControlledDriver(TurningDriver):
    """A link driven at a constant speed by a torque, from a controller with two gains."""

    law: Literal["controlled"]
    speed_rad_s: schema.RateNumber
    kp_n_m_rad: schema.NonNegative
    kd_n_m_s: schema.NonNegative
    start_deg: schema.Degrees = 0.0

    @model_validator(mode="after")
    def _turns_at_the_ground(self) -> ControlledDriver:
        if self.pin is not None:
            raise ValueError('a controlled driver is a link at the ground: link = "crank"')
        return self


class FreeDriver(TurningDriver):
    """A driver released at time 0, with a speed or from rest, in free motion for a duration."""

    law: Literal["free"]
    speed_rad_s: schema.RateNumber = 0.0
    start_deg: schema.Degrees = 0.0
    duration_s: schema.Duration = 10.0

    @model_validator(mode="after")
    def _is_told_by_a_link(self) -> FreeDriver:
        if self.pin is not None:
            raise ValueError(
                "free motion has no drive: name a link at the ground whose angle is its "
                'coordinate, link = "crank"'
            )
        return self


DriverTable = TurningDriver | SlidingDriver
DRIVERS: dict[str, type[TurningDriver]] = {
    "constant": ConstantDriver,
    "oscillating": OscillatingDriver,
    "from-rest": FromRestDriver,
    "accelerating": AcceleratingDriver,
    "controlled": ControlledDriver,
    "free": FreeDriver,
}
SLIDES: dict[str, type[SlidingDriver]] = {
    "constant": ConstantSlide,
    "oscillating": OscillatingSlide,
    "from-rest": FromRestSlide,
    "accelerating": AcceleratingSlide,
}
"""Models of drivers that name a slider."""
LawInFile = ConstantSpeed | Oscillating | FromRest | Accelerating | Released
LAWS: dict[str, type[LawInFile]] = {
    "constant": ConstantSpeed,
    "oscillating": Oscillating,
    "from-rest": FromRest,
    "accelerating": Accelerating,
    "controlled": Controlled,
    "free": Released,
}
KEYS = {
    "start_rad": ("start_deg", "start_m"),
    "centre_rad": ("centre_deg", "centre_m"),
    "amplitude_rad": ("amplitude_deg", "amplitude_m"),
    "phase_rad": ("phase_deg", "phase_deg"),
    "speed_rad_s": ("speed_rad_s", "speed_m_s"),
    "acceleration_rad_s2": ("acceleration_rad_s2", "acceleration_m_s2"),
    "travel_rad": ("", "travel_m"),
}
"""Keys of the fields of laws, for an angle and for a displacement, where they have another name;
the travel of an angle is a turn, and has no key."""


def _keys_of(law: type[LawInFile], *, slides: bool) -> Iterator[tuple[str, str]]:
    for field in fields(law):
        if key := KEYS.get(field.name, (field.name, field.name))[slides]:
            yield field.name, key


def driver_of(
    table: DriverTable,
    ground: Mapping[str, Point],
    links: Mapping[str, Link],
    sliders: Mapping[str, Slider],
) -> Driver:
    """Make the driver of a scene with such bodies. Raises ValueError for a driver at rest."""
    law = _law_of(table)
    if isinstance(table, SlidingDriver):
        slider = sliders[table.slider]
        return Driver(sliding_body(slider), law, slider.on, slider=table.slider)
    if table.pin is None:
        assert table.link is not None
        return Driver(table.link, law)
    points = {name: link.points for name, link in links.items()}
    base, link = table.links or schema.bodies_at(table.pin, ground, points)[:2]
    if base == GROUND and next(p for p in links[link].points if p in ground) == table.pin:
        return Driver(link, law)
    return Driver(link, law, base, pin=table.pin)


def _law_of(table: DriverTable) -> Law:
    """Make the law, angles in radians, a phase without its whole turns."""
    law = LAWS[table.law]
    values = {}
    for name, key in _keys_of(law, slides=isinstance(table, SlidingDriver)):
        value = getattr(table, key)
        if key.endswith("_deg"):
            value = schema.within_a_turn(value) if name == "phase_rad" else math.radians(value)
        values[name] = value
    return law(**values)


def driver_table(driver: Driver) -> Mapping[str, object]:
    """Write the table that reads as a driver. Raises CrankcheckError for a law of another kind."""
    law = _law_table(driver.law, slides=driver.slider is not None)
    if driver.slider is not None:
        return {"slider": driver.slider, **law}
    if driver.pin is not None:
        return {"pin": driver.pin, "links": (driver.base, driver.link), **law}
    return {"link": driver.link, **law}


def _law_table(law: Law, *, slides: bool) -> Mapping[str, object]:
    kind, known = next((each for each in LAWS.items() if type(law) is each[1]), ("", None))
    if known is None:
        raise CrankcheckError(
            f"law {type(law).__name__}: a scene file can not state it; use another"
        )
    if slides and known is Released:
        raise CrankcheckError("free motion starts at a link: a scene file has no free slider")
    table: dict[str, object] = {} if kind == "constant" else {"law": kind}
    for name, key in _keys_of(known, slides=slides):
        value = getattr(law, name)
        table[key] = schema.in_degrees(value) if key.endswith("_deg") else value
    return table


def faults_of_driver(driver: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield one line per fault of the raw table; wrong shapes are faults of the schema."""
    link, pin, slider = driver.get("link"), driver.get("pin"), driver.get("slider")
    if isinstance(link, str):
        if link not in names.points:
            links = few(map(cut, names.points), schema.LISTED)
            yield f"driver.link: found {cut(link)}; use one of {links}"
        elif not names.points[link] & names.ground:
            yield (
                f"driver.link: {cut(link)} has no ground pin to turn about; give it a ground "
                "point, or drive the pin of two links: pin = ..., links = [..., ...]"
            )
    if isinstance(slider, str) and slider not in names.sliders:
        yield f"driver.slider: found {cut(slider)}; {schema.use_one_of(names.sliders)}"
    if isinstance(pin, str):
        yield from _faults_of_pin(pin, driver.get("links"), names)


def _faults_of_pin(pin: str, links: object, names: schema.NamesInTables) -> Iterator[str]:
    joined = names.at(pin)
    blocks = {point: name for name, point in names.blocks.items()}
    if len(joined) == 1 and pin in blocks:
        yield (
            f"driver.pin: found {cut(pin)}, by which {joined[0]} turns against the block of slider "
            f"{cut(blocks[pin])}; drive that slider, slider = {cut(blocks[pin])!r}, or a pin of "
            "two links"
        )
        return
    if len(joined) < 2:
        what = f"it is a point of {joined[0]} alone" if joined else "no body has such a point"
        yield f"driver.pin: found {cut(pin)}, and {what}; name a point that two bodies share"
        return
    both = few(map(cut, joined), schema.LISTED)
    if links is None:
        if len(joined) > 2:
            yield f"driver.links: missing, and pin {cut(pin)} joins {both}; name two of them"
        return
    if not (isinstance(links, list) and all(isinstance(name, str) for name in links)):
        return
    for name in links:
        if name not in joined:
            yield f"driver.links: pin {cut(pin)} joins {both}, not {cut(name)}; name two of them"
    if len(links) == 2 and links[0] == links[1]:
        yield f"driver.links: found {cut(links[0])} twice; pin {cut(pin)} joins {both}"
    elif len(links) == 2 and links[1] == GROUND:
        yield f"driver.links: the ground is driven against {cut(links[0])}; name the ground first"
