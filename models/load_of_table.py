"""A load from its table in a scene file."""

from __future__ import annotations

import math
from collections.abc import Mapping

from models.characteristics import Characteristic, Constant, Polynomial, Sine
from models.degrees import within_a_turn
from models.joints import block_name
from models.load_tables import (
    FourierLoad,
    LawOfLoad,
    PolynomialLoad,
    PulseLoad,
    SineLoad,
    StepsLoad,
    TableLoad,
)
from models.loads import Load
from models.scene import Slider
from models.staircase import Staircase
from models.tabulated import Tabulated
from models.waves import FourierSum, Pulse


def load_of(
    name: str, table: LawOfLoad, sliders: Mapping[str, Slider], faults: list[str]
) -> Load | None:
    """The load of a table, or None and why it has no magnitude."""
    body, point = table.link, table.point
    if table.block is not None:
        block = sliders[table.block]
        body, point = block_name(block), block.point
    assert body is not None
    try:
        characteristic = _characteristic(table)
    except ValueError as error:
        faults.append(f"loads.{name}: {error}")
        return None
    return Load(
        name=name,
        body=body,
        point=None if table.magnitude[0] is None else point,
        characteristic=characteristic,
        over=getattr(table, "over", "time"),
        slider=table.slider,
        stroke=table.stroke,
        direction_rad=within_a_turn(table.direction_deg or 0.0),
        frame=table.frame or "ground",
    )


def _characteristic(table: LawOfLoad) -> Characteristic:
    """How the magnitude goes, angles in radians. Raises ValueError."""
    magnitude = table.force_n if table.force_n is not None else table.torque_n_m
    if isinstance(table, PolynomialLoad):
        return Polynomial(tuple(magnitude))  # type: ignore[arg-type]
    turning = getattr(table, "over", "time") == "angle"
    if isinstance(table, SineLoad):
        period = math.radians(table.period) if turning else table.period
        return Sine(float(magnitude), period, within_a_turn(table.phase_deg))  # type: ignore[arg-type]
    if isinstance(table, PulseLoad):
        return Pulse(float(magnitude), table.period_s, table.start_s)  # type: ignore[arg-type]
    if isinstance(table, StepsLoad):
        return Staircase(table.at_s, tuple(magnitude))  # type: ignore[arg-type]
    if isinstance(table, FourierLoad):
        period = math.radians(table.period) if turning else table.period
        count = max(len(table.cosines), len(table.sines))
        cosines, sines = (
            (*waves, *[0.0] * (count - len(waves))) for waves in (table.cosines, table.sines)
        )
        return FourierSum(float(magnitude), cosines, sines, period)  # type: ignore[arg-type]
    if isinstance(table, TableLoad):
        places, values = table.places, tuple(magnitude)  # type: ignore[arg-type]
        if not turning:
            return Tabulated(places, values, table.interpolation)
        period = math.radians(table.period_deg or 360.0)
        places = tuple(math.radians(place) for place in places)
        return Tabulated(places, values, table.interpolation, period)
    return Constant(float(magnitude))  # type: ignore[arg-type]
