"""From the table `[driver]` of a scene file to the driver, angles in rad, and back."""

from __future__ import annotations

import math
from collections.abc import Mapping

from models.controlled import Controlled
from models.degrees import within_a_turn
from models.driver_tables import (
    AcceleratingDriver,
    AcceleratingSlide,
    ConstantSlide,
    ControlledDriver,
    DriverTable,
    FreeDriver,
    FromRestDriver,
    FromRestSlide,
    OscillatingDriver,
    OscillatingSlide,
    SlidingDriver,
    TurningDriver,
)
from models.errors import CrankcheckError
from models.joints import sliding_body
from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from models.load_text import in_degrees
from models.released import Released
from models.scene import GROUND, Driver, Link, Point, Slider


def driver_of(
    table: DriverTable,
    ground: Mapping[str, Point],
    links: Mapping[str, Link],
    sliders: Mapping[str, Slider],
) -> Driver:
    """The driver of a scene with such bodies. Raises ValueError for numbers that drive nothing."""
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
    """The law of an angle."""
    if isinstance(table, OscillatingDriver):
        return Oscillating(
            math.radians(table.centre_deg),
            math.radians(table.amplitude_deg),
            table.frequency_rad_s,
            within_a_turn(table.phase_deg),
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
    """The law of a displacement."""
    if isinstance(table, OscillatingSlide):
        phase = within_a_turn(table.phase_deg)
        return Oscillating(table.centre_m, table.amplitude_m, table.frequency_rad_s, phase)
    assert isinstance(table, ConstantSlide | FromRestSlide | AcceleratingSlide)
    start, speed, travel = table.start_m, table.speed_m_s, table.travel_m
    if isinstance(table, FromRestSlide):
        return FromRest(start, speed, table.rise_s, travel_rad=travel)
    if isinstance(table, AcceleratingSlide):
        return Accelerating(start, speed, table.acceleration_m_s2, travel_rad=travel)
    return ConstantSpeed(start, speed, travel_rad=travel)


def driver_table(driver: Driver) -> Mapping[str, object]:
    """The table that reads as a driver. Raises CrankcheckError for a law of another kind."""
    if driver.slider is not None:
        return {"slider": driver.slider, **_slide_table(driver.law)}
    if driver.pin is not None:
        links = (driver.base, driver.link)
        return {"pin": driver.pin, "links": links, **_turn_table(driver.law)}
    return {"link": driver.link, **_turn_table(driver.law)}


def _turn_table(law: Law) -> Mapping[str, object]:
    """A law of an angle."""
    if isinstance(law, Oscillating):
        return {
            "law": "oscillating",
            "centre_deg": in_degrees(law.centre_rad),
            "amplitude_deg": in_degrees(law.amplitude_rad),
            "frequency_rad_s": law.frequency_rad_s,
            "phase_deg": in_degrees(law.phase_rad),
        }
    law = _written(law)
    start = {"start_deg": in_degrees(law.start_rad), "speed_rad_s": law.speed_rad_s}
    if isinstance(law, Released):
        return {"law": "free", **start, "duration_s": law.duration_s}
    if isinstance(law, Controlled):
        gains = {"kp_n_m_rad": law.kp_n_m_rad, "kd_n_m_s": law.kd_n_m_s}
        return {"law": "controlled", **start, **gains}
    if isinstance(law, FromRest):
        return {"law": "from-rest", **start, "rise_s": law.rise_s}
    if isinstance(law, Accelerating):
        return {"law": "accelerating", **start, "acceleration_rad_s2": law.acceleration_rad_s2}
    return start


def _slide_table(law: Law) -> Mapping[str, object]:
    """A law of a displacement."""
    if isinstance(law, Oscillating):
        return {
            "law": "oscillating",
            "centre_m": law.centre_rad,
            "amplitude_m": law.amplitude_rad,
            "frequency_rad_s": law.frequency_rad_s,
            "phase_deg": in_degrees(law.phase_rad),
        }
    law = _written(law)
    start = {"start_m": law.start_rad, "speed_m_s": law.speed_rad_s}
    if isinstance(law, Released):
        raise CrankcheckError("what is let go is told by a link: a scene file has no free slider")
    start |= {"travel_m": law.travel_rad}
    if isinstance(law, FromRest):
        return {"law": "from-rest", **start, "rise_s": law.rise_s}
    if isinstance(law, Accelerating):
        return {"law": "accelerating", **start, "acceleration_m_s2": law.acceleration_rad_s2}
    return start


def _written(law: Law) -> ConstantSpeed | FromRest | Accelerating | Released:
    """The law, of those that a file has words for."""
    if not isinstance(law, ConstantSpeed | FromRest | Accelerating | Released):
        name = type(law).__name__
        raise CrankcheckError(f"law {name}: a scene file has no words for it; take another")
    return law
