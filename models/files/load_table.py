"""Pydantic models of the tables `[loads.NAME]` of a scene file, one for each law of a load."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.errors import CrankcheckError
from models.files.schema import Degrees, Name, Number, Positive, Table, within_a_turn
from models.scene import Slider, characteristics
from models.scene.joints import block_name
from models.scene.loads import Load, Over, Stroke
from models.scene.tabulated import Interpolation, Tabulated

UNIT: dict[str, str] = {
    "time": "s",
    "angle": "deg",
    "displacement": "m",
    "speed": "m_s",
    "omega": "rad_s",
}
MOST_ROWS = 10_000
Rows = Annotated[tuple[Number, ...], Field(min_length=1, max_length=MOST_ROWS)]
Waves = Annotated[tuple[Number, ...], Field(max_length=200)]
"""Cosines or sines; the shorter of the two is padded with zeros."""
Powers = Annotated[tuple[Number, ...], Field(min_length=1, max_length=20)]


class LoadTable(Table):
    """Base of all load tables: the point or body of the load, and its direction."""

    link: Name | None = None
    block: Name | None = None
    point: Name | None = None
    direction_deg: Degrees | None = None
    frame: Literal["ground", "body"] | None = None
    slider: Name | None = None
    stroke: Stroke = "both"

    @property
    def magnitude(self) -> tuple[object, object]:
        """``force_n`` and ``torque_n_m``, of which one is given."""
        return getattr(self, "force_n", None), getattr(self, "torque_n_m", None)

    @model_validator(mode="after")
    def _acts_on_one_body(self) -> LoadTable:
        if (self.link is None) == (self.block is None):
            raise ValueError("name what it acts on: link, or block (a slider without a link)")
        force, torque = self.magnitude
        if (force is None) == (torque is None):
            raise ValueError("give force_n or torque_n_m, one of the two")
        if torque is not None:
            for key in ("point", "direction_deg", "frame"):
                if getattr(self, key) is not None:
                    raise ValueError(f"{key} belongs to a force; a torque has none")
        elif self.link is not None and self.point is None:
            raise ValueError(f"a force on link {self.link} needs the point of it that it acts at")
        elif self.block is not None and self.point is not None:
            raise ValueError("a force on a block acts at its point; leave point out")
        return self

    @model_validator(mode="after")
    def _follows_a_slider_where_it_says(self) -> LoadTable:
        over = getattr(self, "over", None)
        wanted = self.stroke != "both" or over in ("displacement", "speed")
        if wanted and self.slider is None:
            raise ValueError("over displacement or speed, or on one stroke, it needs slider = ...")
        if self.slider is not None and not wanted:
            raise ValueError('slider needs stroke = "forward", or over = "displacement" or "speed"')
        if over == "omega" and self.link is None:
            raise ValueError('over = "omega" is the angular velocity of a link; name it by link')
        return self

    def _in_unit(self, stem: str, over: Over) -> object:
        """Return the value of ``stem`` in the unit of the argument; other units are a fault."""
        for other, unit in UNIT.items():
            if other != over and getattr(self, f"{stem}_{unit}", None) is not None:
                raise ValueError(f'over = "{over}" takes {stem}_{UNIT[over]}; found {stem}_{unit}')
        value: object = getattr(self, f"{stem}_{UNIT[over]}", None)
        if value is None:
            raise ValueError(f'over = "{over}" needs {stem}_{UNIT[over]}')
        return value


class ConstantLoad(LoadTable):
    law: Literal["constant"] = "constant"
    force_n: Number | None = None
    torque_n_m: Number | None = None


class SineLoad(LoadTable):
    """A sine; ``force_n`` or ``torque_n_m`` is the amplitude, the period the length of one wave."""

    law: Literal["sine"]
    over: Over
    force_n: Number | None = None
    torque_n_m: Number | None = None
    period_s: Positive | None = None
    period_deg: Positive | None = None
    period_m: Positive | None = None
    phase_deg: Degrees = 0.0

    @model_validator(mode="after")
    def _has_its_period(self) -> SineLoad:
        self._in_unit("period", self.over)
        return self

    @property
    def period(self) -> float:
        return float(self._in_unit("period", self.over))  # type: ignore[arg-type]


class PulseLoad(LoadTable):
    """One wave of a sine over time, from ``start_s`` on, and 0 outside it."""

    law: Literal["pulse"]
    force_n: Number | None = None
    torque_n_m: Number | None = None
    period_s: Positive
    start_s: Number = 0.0


class StepsLoad(LoadTable):
    """Levels over time, each from its instant on; 0 before the first."""

    law: Literal["steps"]
    force_n: Rows | None = None
    torque_n_m: Rows | None = None
    at_s: Rows


class FourierLoad(LoadTable):
    """A mean, and cosines and sines of one wave in a period, of two, of three and so on."""

    law: Literal["fourier"]
    over: Over
    force_n: Number | None = None
    torque_n_m: Number | None = None
    cosines: Waves = ()
    sines: Waves = ()
    period_s: Positive | None = None
    period_deg: Positive | None = None
    period_m: Positive | None = None

    @model_validator(mode="after")
    def _has_its_period(self) -> FourierLoad:
        self._in_unit("period", self.over)
        return self

    @property
    def period(self) -> float:
        return float(self._in_unit("period", self.over))  # type: ignore[arg-type]


class PolynomialLoad(LoadTable):
    """Coefficients, of x^0 first, x in s, rad or m."""

    law: Literal["polynomial"]
    over: Over
    force_n: Powers | None = None
    torque_n_m: Powers | None = None


class TableLoad(LoadTable):
    """Rows; over the angle they repeat with ``period_deg``."""

    law: Literal["table"]
    over: Over
    interpolation: Interpolation
    force_n: Rows | None = None
    torque_n_m: Rows | None = None
    at_s: Rows | None = None
    at_deg: Rows | None = None
    at_m: Rows | None = None
    at_m_s: Rows | None = None
    at_rad_s: Rows | None = None
    period_deg: Positive | None = None

    @model_validator(mode="after")
    def _has_its_places(self) -> TableLoad:
        self._in_unit("at", self.over)
        if self.period_deg is not None and self.over != "angle":
            raise ValueError('period_deg needs over = "angle"; other tables do not repeat')
        return self

    @property
    def places(self) -> tuple[float, ...]:
        return tuple(self._in_unit("at", self.over))  # type: ignore[arg-type]


LawOfLoad = (
    ConstantLoad | SineLoad | PulseLoad | StepsLoad | FourierLoad | PolynomialLoad | TableLoad
)
LOADS: dict[str, type[LawOfLoad]] = {
    "constant": ConstantLoad,
    "sine": SineLoad,
    "pulse": PulseLoad,
    "steps": StepsLoad,
    "fourier": FourierLoad,
    "polynomial": PolynomialLoad,
    "table": TableLoad,
}


def load_of(
    name: str, table: LawOfLoad, sliders: Mapping[str, Slider], faults: list[str]
) -> Load | None:
    """Make the load of a table; None, with the reason in ``faults``, without a magnitude."""
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


def _characteristic(table: LawOfLoad) -> characteristics.Characteristic:
    """Make the characteristic of the magnitude, angles in radians. Raises ValueError."""
    magnitude = table.force_n if table.force_n is not None else table.torque_n_m
    if isinstance(table, PolynomialLoad):
        return characteristics.Polynomial(tuple(magnitude))  # type: ignore[arg-type]
    turning = getattr(table, "over", "time") == "angle"
    if isinstance(table, SineLoad):
        period = math.radians(table.period) if turning else table.period
        return characteristics.Sine(float(magnitude), period, within_a_turn(table.phase_deg))  # type: ignore[arg-type]
    if isinstance(table, PulseLoad):
        return characteristics.Pulse(float(magnitude), table.period_s, table.start_s)  # type: ignore[arg-type]
    if isinstance(table, StepsLoad):
        return characteristics.Staircase(table.at_s, tuple(magnitude))  # type: ignore[arg-type]
    if isinstance(table, FourierLoad):
        period = math.radians(table.period) if turning else table.period
        count = max(len(table.cosines), len(table.sines))
        cosines, sines = (
            (*waves, *[0.0] * (count - len(waves))) for waves in (table.cosines, table.sines)
        )
        return characteristics.FourierSum(float(magnitude), cosines, sines, period)  # type: ignore[arg-type]
    if isinstance(table, TableLoad):
        places, values = table.places, tuple(magnitude)  # type: ignore[arg-type]
        if not turning:
            return Tabulated(places, values, table.interpolation)
        period = math.radians(table.period_deg or 360.0)
        places = tuple(math.radians(place) for place in places)
        return Tabulated(places, values, table.interpolation, period)
    return characteristics.Constant(float(magnitude))  # type: ignore[arg-type]


def load_table(load: Load) -> Mapping[str, object]:
    """Write the table of a load. Raises CrankcheckError for a characteristic of another kind."""
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
    return table | _law_table(load, key)


def in_degrees(angle_rad: float) -> float:
    """Convert an angle to degrees, rounded to twelve decimals where these read as the same angle:
    10, and not 10.000000000000002."""
    plain = round(math.degrees(angle_rad), 12)
    return plain if math.radians(plain) == angle_rad else math.degrees(angle_rad)


def _law_table(load: Load, key: str) -> dict[str, object]:
    """Write the law with its numbers; ``key`` is the key of the magnitude."""
    unit, turns = UNIT[load.over], load.over == "angle"
    match load.characteristic:
        case characteristics.Constant(value):
            return {"law": "constant", key: value}
        case characteristics.Sine(amplitude, period, phase_rad):
            own = {
                f"period_{unit}": in_degrees(period) if turns else period,
                "phase_deg": in_degrees(phase_rad),
            }
            return {"law": "sine", "over": load.over, key: amplitude, **own}
        case characteristics.Pulse(amplitude, period, start):
            return {"law": "pulse", key: amplitude, "period_s": period, "start_s": start}
        case characteristics.Staircase(places, values):
            return {"law": "steps", "at_s": places, key: values}
        case characteristics.FourierSum(mean, cosines, sines, period):
            own = {f"period_{unit}": in_degrees(period) if turns else period}
            waves = {"cosines": cosines, "sines": sines, **own}
            return {"law": "fourier", "over": load.over, key: mean, **waves}
        case characteristics.Polynomial(coefficients):
            return {"law": "polynomial", "over": load.over, key: coefficients}
        case Tabulated(places, values, interpolation, period):
            at = tuple(map(in_degrees, places)) if turns else places
            rows = {f"at_{unit}": at, key: values}
            own = {} if period is None else {"period_deg": in_degrees(period)}
            law = {"law": "table", "over": load.over, "interpolation": interpolation}
            return {**law, **rows, **own}
    kind = type(load.characteristic).__name__
    raise CrankcheckError(f"load {load.name}: a scene file has no words for a {kind}")
