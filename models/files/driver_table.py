"""Pydantic models of the driver's table, one for each law: of a link or a pin, and of a slider."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import AfterValidator, model_validator

from models.errors import CrankcheckError
from models.files import schema
from models.files.load_table import in_degrees
from models.scene import GROUND, Driver, Link, Point, Slider
from models.scene.driver import Controlled, Released
from models.scene.joints import sliding_body
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating

TinyChecked = AfterValidator(schema.not_tiny)


class TurningDriver(schema.Table):
    """A turning driver: a ``link`` about its ground pin; or a ``pin``, by the angle of the second
    of two ``links`` less the angle of the first."""

    link: schema.Name | None = None
    pin: schema.Name | None = None
    links: tuple[schema.Name, schema.Name] | None = None

    @model_validator(mode="after")
    def _is_one_joint(self) -> TurningDriver:
        if (self.link is None) == (self.pin is None):
            raise ValueError(
                'name what is driven, one of link = "crank", pin = "B" and slider = "C"'
            )
        if self.links is not None and self.pin is None:
            raise ValueError('links go with a pin: pin = "B", links = ["crank", "coupler"]')
        return self


class SlidingDriver(schema.Table):
    """A driven ``slider``, by its displacement."""

    slider: schema.Name


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
    amplitude_deg: Annotated[schema.Degrees, TinyChecked]
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
                "nothing drives what is let go: name a link at the ground, by whose angle its "
                'motion is told, link = "crank"'
            )
        return self


DriverTable = (
    ConstantDriver
    | OscillatingDriver
    | FromRestDriver
    | AcceleratingDriver
    | ControlledDriver
    | FreeDriver
    | ConstantSlide
    | OscillatingSlide
    | FromRestSlide
    | AcceleratingSlide
)
DRIVERS: dict[str, type[DriverTable]] = {
    "constant": ConstantDriver,
    "oscillating": OscillatingDriver,
    "from-rest": FromRestDriver,
    "accelerating": AcceleratingDriver,
    "controlled": ControlledDriver,
    "free": FreeDriver,
}
SLIDES: dict[str, type[DriverTable]] = {
    "constant": ConstantSlide,
    "oscillating": OscillatingSlide,
    "from-rest": FromRestSlide,
    "accelerating": AcceleratingSlide,
}
"""Models of drivers that name a slider."""


def driver_of(
    table: DriverTable,
    ground: Mapping[str, Point],
    links: Mapping[str, Link],
    sliders: Mapping[str, Slider],
) -> Driver:
    """Make the driver of a scene with such bodies. Raises ValueError for a driver at rest."""
    if isinstance(table, SlidingDriver):
        slider = sliders[table.slider]
        return Driver(sliding_body(slider), _sliding(table), slider.on, slider=table.slider)
    assert isinstance(table, TurningDriver)
    law = _turning(table)
    if table.pin is None:
        assert table.link is not None
        return Driver(table.link, law)
    joined = [GROUND] * (table.pin in ground)
    joined += [name for name, link in links.items() if table.pin in link.points]
    base, link = table.links or joined[:2]
    if base == GROUND and next(p for p in links[link].points if p in ground) == table.pin:
        return Driver(link, law)
    return Driver(link, law, base, pin=table.pin)


def _turning(table: DriverTable) -> Law:
    """Make the law of an angle."""
    if isinstance(table, OscillatingDriver):
        return Oscillating(
            math.radians(table.centre_deg),
            math.radians(table.amplitude_deg),
            table.frequency_rad_s,
            schema.within_a_turn(table.phase_deg),
        )
    if isinstance(table, FromRestDriver):
        return FromRest(math.radians(table.start_deg), table.speed_rad_s, table.rise_s)
    assert isinstance(table, TurningDriver)
    start_rad = math.radians(table.start_deg)
    if isinstance(table, FreeDriver):
        return Released(start_rad, table.speed_rad_s, table.duration_s)
    if isinstance(table, AcceleratingDriver):
        return Accelerating(start_rad, table.speed_rad_s, table.acceleration_rad_s2)
    if isinstance(table, ControlledDriver):
        return Controlled(start_rad, table.speed_rad_s, table.kp_n_m_rad, table.kd_n_m_s)
    return ConstantSpeed(start_rad, table.speed_rad_s)


def _sliding(table: DriverTable) -> Law:
    """Make the law of a displacement."""
    if isinstance(table, OscillatingSlide):
        phase = schema.within_a_turn(table.phase_deg)
        return Oscillating(table.centre_m, table.amplitude_m, table.frequency_rad_s, phase)
    assert isinstance(table, ConstantSlide | FromRestSlide | AcceleratingSlide)
    start, speed, travel = table.start_m, table.speed_m_s, table.travel_m
    if isinstance(table, FromRestSlide):
        return FromRest(start, speed, table.rise_s, travel_rad=travel)
    if isinstance(table, AcceleratingSlide):
        return Accelerating(start, speed, table.acceleration_m_s2, travel_rad=travel)
    return ConstantSpeed(start, speed, travel_rad=travel)


def driver_table(driver: Driver) -> Mapping[str, object]:
    """Write the table that reads as a driver. Raises CrankcheckError for a law of another kind."""
    law = _law_table(driver.law, slides=driver.slider is not None)
    if driver.slider is not None:
        return {"slider": driver.slider, **law}
    if driver.pin is not None:
        return {"pin": driver.pin, "links": (driver.base, driver.link), **law}
    return {"link": driver.link, **law}


def _law_table(law: Law, *, slides: bool) -> Mapping[str, object]:
    """Write the table of a law of an angle, or of a displacement."""
    place, rate = ("m", "m_s") if slides else ("deg", "rad_s")
    shown = (lambda size_m: size_m) if slides else in_degrees
    if isinstance(law, Oscillating):
        return {
            "law": "oscillating",
            f"centre_{place}": shown(law.centre_rad),
            f"amplitude_{place}": shown(law.amplitude_rad),
            "frequency_rad_s": law.frequency_rad_s,
            "phase_deg": in_degrees(law.phase_rad),
        }
    law = _written(law)
    start = {f"start_{place}": shown(law.start_rad), f"speed_{rate}": law.speed_rad_s}
    if isinstance(law, Released):
        if slides:
            raise CrankcheckError(
                "what is let go is told by a link: a scene file has no free slider"
            )
        return {"law": "free", **start, "duration_s": law.duration_s}
    if slides:
        start["travel_m"] = law.travel_rad
    if isinstance(law, Controlled):
        gains = {"kp_n_m_rad": law.kp_n_m_rad, "kd_n_m_s": law.kd_n_m_s}
        return {"law": "controlled", **start, **gains}
    if isinstance(law, FromRest):
        return {"law": "from-rest", **start, "rise_s": law.rise_s}
    if isinstance(law, Accelerating):
        return {"law": "accelerating", **start, f"acceleration_{rate}2": law.acceleration_rad_s2}
    return start


def _written(law: Law) -> ConstantSpeed | FromRest | Accelerating | Released:
    """Refuse a law that a scene file cannot express."""
    if not isinstance(law, ConstantSpeed | FromRest | Accelerating | Released):
        name = type(law).__name__
        raise CrankcheckError(f"law {name}: a scene file has no words for it; take another")
    return law
