"""The driver's table in pydantic models, one for each law: of a link or a pin, and of a slider."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, model_validator

from models.table_fields import (
    Degrees,
    Duration,
    Name,
    NonNegative,
    Number,
    Positive,
    RateNumber,
    Table,
    not_tiny,
)

TinyChecked = AfterValidator(not_tiny)


class TurningDriver(Table):
    """What turns: a ``link`` about its ground pin; or a ``pin``, by the angle of the second of two
    ``links`` less that of the first."""

    link: Name | None = None
    pin: Name | None = None
    links: tuple[Name, Name] | None = None

    @model_validator(mode="after")
    def _is_one_joint(self) -> TurningDriver:
        if (self.link is None) == (self.pin is None):
            raise ValueError(
                'name what is driven, one of link = "crank", pin = "B" and slider = "C"'
            )
        if self.links is not None and self.pin is None:
            raise ValueError('links go with a pin: pin = "B", links = ["crank", "coupler"]')
        return self


class SlidingDriver(Table):
    """A ``slider``, by its displacement."""

    slider: Name


class ConstantDriver(TurningDriver):
    law: Literal["constant"] = "constant"
    speed_rad_s: RateNumber
    start_deg: Degrees = 0.0


class ConstantSlide(SlidingDriver):
    law: Literal["constant"] = "constant"
    speed_m_s: RateNumber
    start_m: Number = 0.0
    travel_m: Positive


class OscillatingDriver(TurningDriver):
    law: Literal["oscillating"]
    centre_deg: Degrees
    amplitude_deg: Annotated[Degrees, TinyChecked]
    frequency_rad_s: RateNumber
    phase_deg: Degrees = 0.0


class OscillatingSlide(SlidingDriver):
    law: Literal["oscillating"]
    centre_m: Number
    amplitude_m: RateNumber
    frequency_rad_s: RateNumber
    phase_deg: Degrees = 0.0


class FromRestDriver(TurningDriver):
    law: Literal["from-rest"]
    speed_rad_s: RateNumber
    rise_s: Positive
    start_deg: Degrees = 0.0


class FromRestSlide(SlidingDriver):
    law: Literal["from-rest"]
    speed_m_s: RateNumber
    rise_s: Positive
    start_m: Number = 0.0
    travel_m: Positive


class AcceleratingDriver(TurningDriver):
    law: Literal["accelerating"]
    speed_rad_s: RateNumber
    acceleration_rad_s2: RateNumber
    start_deg: Degrees = 0.0


class AcceleratingSlide(SlidingDriver):
    law: Literal["accelerating"]
    speed_m_s: RateNumber
    acceleration_m_s2: RateNumber
    start_m: Number = 0.0
    travel_m: Positive


class ControlledDriver(TurningDriver):
    """A link that a torque holds to a constant speed, by a controller with two gains."""

    law: Literal["controlled"]
    speed_rad_s: RateNumber
    kp_n_m_rad: NonNegative
    kd_n_m_s: NonNegative
    start_deg: Degrees = 0.0

    @model_validator(mode="after")
    def _turns_at_the_ground(self) -> ControlledDriver:
        if self.pin is not None:
            raise ValueError('a controlled driver is a link at the ground: link = "crank"')
        return self


class FreeDriver(TurningDriver):
    """What is let go, with a speed or from rest, for a duration."""

    law: Literal["free"]
    speed_rad_s: RateNumber = 0.0
    start_deg: Degrees = 0.0
    duration_s: Duration = 10.0

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
"""Of drivers that name a slider."""
