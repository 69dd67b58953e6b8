"""A load as the table of a scene file that reads as it, angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Mapping

from models.characteristics import Constant, Polynomial, Sine
from models.errors import CrankcheckError
from models.load_tables import UNIT
from models.loads import Load
from models.staircase import Staircase
from models.tabulated import Tabulated
from models.waves import FourierSum, Pulse


def load_table(load: Load) -> Mapping[str, object]:
    """The table. Raises CrankcheckError for a characteristic of another kind."""
    table: dict[str, object] = {}
    block = load.body.removeprefix("block ")  # no link has a space in its name
    if block != load.body:
        table["block"] = block
    else:
        table["link"] = load.body
        if load.point is not None:
            table["point"] = load.point
    if load.point is not None:
        table |= {"direction_deg": in_degrees(load.direction_rad), "frame": load.frame}
    if load.stroke != "both" or load.over in ("displacement", "speed"):
        table |= {"slider": load.slider, "stroke": load.stroke}
    key = "torque_n_m" if load.point is None else "force_n"
    return table | _characteristic(load, key)


def in_degrees(angle_rad: float) -> float:
    """An angle in degrees that reads as itself, where one of twelve decimals does: 10, and not
    10.000000000000002."""
    plain = round(math.degrees(angle_rad), 12)
    return plain if math.radians(plain) == angle_rad else math.degrees(angle_rad)


def _characteristic(load: Load, key: str) -> dict[str, object]:
    """The law with its numbers; ``key`` is that of the magnitude."""
    unit, turns = UNIT[load.over], load.over == "angle"
    match load.characteristic:
        case Constant(value):
            return {"law": "constant", key: value}
        case Sine(amplitude, period, phase_rad):
            own = {
                f"period_{unit}": in_degrees(period) if turns else period,
                "phase_deg": in_degrees(phase_rad),
            }
            return {"law": "sine", "over": load.over, key: amplitude, **own}
        case Pulse(amplitude, period, start):
            return {"law": "pulse", key: amplitude, "period_s": period, "start_s": start}
        case Staircase(places, values):
            return {"law": "steps", "at_s": places, key: values}
        case FourierSum(mean, cosines, sines, period):
            own = {f"period_{unit}": in_degrees(period) if turns else period}
            waves = {"cosines": cosines, "sines": sines, **own}
            return {"law": "fourier", "over": load.over, key: mean, **waves}
        case Polynomial(coefficients):
            return {"law": "polynomial", "over": load.over, key: coefficients}
        case Tabulated(places, values, interpolation, period):
            at = tuple(map(in_degrees, places)) if turns else places
            rows = {f"at_{unit}": at, key: values}
            own = {} if period is None else {"period_deg": in_degrees(period)}
            law = {"law": "table", "over": load.over, "interpolation": interpolation}
            return {**law, **rows, **own}
    kind = type(load.characteristic).__name__
    raise CrankcheckError(f"load {load.name}: a scene file has no words for a {kind}")
