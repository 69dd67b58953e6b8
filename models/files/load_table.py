"""Tables `[loads.NAME]` of a scene file, a model for each law of a load."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from models.errors import CrankcheckError, cut
from models.files import schema
from models.files.schema import Degrees, Name, Number, Positive, in_degrees
from models.scene import Slider, characteristics
from models.scene.characteristics import Characteristic
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


class LoadTable(schema.Table):
    """Base of all load tables: the point or body of the load, and its direction."""

    link: Name | None = None
    block: Name | None = None
    point: Name | None = None
    direction_deg: Degrees | None = None
    frame: Literal["ground", "body"] | None = None
    slider: Name | None = None
    stroke: Stroke = "both"

    @property
    def force(self) -> Any:
        """``force_n``: a number, or as many as the law has; None for a torque."""
        return getattr(self, "force_n", None)

    @property
    def magnitude(self) -> Any:
        """The force or the torque."""
        return getattr(self, "torque_n_m", None) if self.force is None else self.force

    @property
    def argument(self) -> Over:
        """Quantity that the magnitude follows."""
        return getattr(self, "over", "time")

    @abstractmethod
    def characteristic(self) -> Characteristic:
        """Make the course of the magnitude, angles in radians. Raises ValueError."""

    @model_validator(mode="after")
    def _acts_on_one_body(self) -> LoadTable:
        if (self.link is None) == (self.block is None):
            raise ValueError("name the loaded body: link, or block (a slider without a link)")
        torque = getattr(self, "torque_n_m", None)
        if (self.force is None) == (torque is None):
            raise ValueError("give force_n or torque_n_m, one of the two")
        if torque is not None:
            for key in ("point", "direction_deg", "frame"):
                if getattr(self, key) is not None:
                    raise ValueError(f"{key} belongs to a force; a torque has none")
        elif self.link is not None and self.point is None:
            raise ValueError(
                f"a force on link {self.link} needs the point of the link at which it acts"
            )
        elif self.block is not None and self.point is not None:
            raise ValueError("a force on a block acts at its point; leave point out")
        return self

    @model_validator(mode="after")
    def _follows_a_slider_where_it_says(self) -> LoadTable:
        wanted = self.stroke != "both" or self.argument in ("displacement", "speed")
        if wanted and self.slider is None:
            raise ValueError("over displacement or speed, or on one stroke, it needs slider = ...")
        if self.slider is not None and not wanted:
            raise ValueError('slider needs stroke = "forward", or over = "displacement" or "speed"')
        if self.argument == "omega" and self.link is None:
            raise ValueError('over = "omega" is the angular velocity of a link; name it by link')
        return self

    def _in_unit(self, stem: str) -> Any:
        """Return the value of ``stem`` in the unit of the argument; other units are a fault."""
        over = self.argument
        for other, unit in UNIT.items():
            if other != over and getattr(self, f"{stem}_{unit}", None) is not None:
                raise ValueError(f'over = "{over}" takes {stem}_{UNIT[over]}; found {stem}_{unit}')
        value = getattr(self, f"{stem}_{UNIT[over]}", None)
        if value is None:
            raise ValueError(f'over = "{over}" needs {stem}_{UNIT[over]}')
        return value


class PeriodicLoad(LoadTable):
    """A load with a period in the unit of its argument."""

    @model_validator(mode="after")
    def _has_its_period(self) -> PeriodicLoad:
        self._in_unit("period")
        return self

    @property
    def period(self) -> float:
        """Period in s, rad or m."""
        period = float(self._in_unit("period"))
        return math.radians(period) if self.argument == "angle" else period


class ConstantLoad(LoadTable):
    law: Literal["constant"] = "constant"
    force_n: Number | None = None
    torque_n_m: Number | None = None

    def characteristic(self) -> Characteristic:
        return characteristics.Constant(float(self.magnitude))


class SineLoad(PeriodicLoad):
    """A sine; ``force_n`` or ``torque_n_m`` is the amplitude, the period the length of one wave."""

    law: Literal["sine"]
    over: Over
    force_n: Number | None = None
    torque_n_m: Number | None = None
    period_s: Positive | None = None
    period_deg: Positive | None = None
    period_m: Positive | None = None
    phase_deg: Degrees = 0.0

    def characteristic(self) -> Characteristic:
        phase_rad = schema.within_a_turn(self.phase_deg)
        return characteristics.Sine(float(self.magnitude), self.period, phase_rad)


class PulseLoad(LoadTable):
    """One wave of a sine over time, from ``start_s`` on, and 0 outside it."""

    law: Literal["pulse"]
    force_n: Number | None = None
    torque_n_m: Number | None = None
    period_s: Positive
    start_s: Number = 0.0

    def characteristic(self) -> Characteristic:
        return characteristics.Pulse(float(self.magnitude), self.period_s, self.start_s)


class StepsLoad(LoadTable):
    """Levels over time, each from its instant on; 0 before the first."""

    law: Literal["steps"]
    force_n: Rows | None = None
    torque_n_m: Rows | None = None
    at_s: Rows

    def characteristic(self) -> Characteristic:
        return characteristics.Staircase(self.at_s, tuple(self.magnitude))


class FourierLoad(PeriodicLoad):
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

    def characteristic(self) -> Characteristic:
        both = (self.cosines, self.sines)
        count = max(map(len, both))
        cosines, sines = ((*waves, *[0.0] * (count - len(waves))) for waves in both)
        return characteristics.FourierSum(float(self.magnitude), cosines, sines, self.period)


class PolynomialLoad(LoadTable):
    """Coefficients, of x^0 first, x in s, rad or m."""

    law: Literal["polynomial"]
    over: Over
    force_n: Powers | None = None
    torque_n_m: Powers | None = None

    def characteristic(self) -> Characteristic:
        return characteristics.Polynomial(tuple(self.magnitude))


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
        self._in_unit("at")
        if self.period_deg is not None and self.over != "angle":
            raise ValueError('period_deg needs over = "angle"; other tables do not repeat')
        return self

    def characteristic(self) -> Characteristic:
        places, values = tuple(self._in_unit("at")), tuple(self.magnitude)
        if self.over != "angle":
            return Tabulated(places, values, self.interpolation)
        places = tuple(math.radians(place) for place in places)
        period = math.radians(self.period_deg or 360.0)
        return Tabulated(places, values, self.interpolation, period)


LOADS: dict[str, type[LoadTable]] = {
    "constant": ConstantLoad,
    "sine": SineLoad,
    "pulse": PulseLoad,
    "steps": StepsLoad,
    "fourier": FourierLoad,
    "polynomial": PolynomialLoad,
    "table": TableLoad,
}


def load_of(
    name: str, table: LoadTable, sliders: Mapping[str, Slider], faults: list[str]
) -> Load | None:
    """Make the load of a table; None, with the reason in ``faults``, without a magnitude."""
    body, point = table.link, table.point
    if table.block is not None:
        block = sliders[table.block]
        body, point = block_name(block), block.point
    assert body is not None
    try:
        characteristic = table.characteristic()
    except ValueError as error:
        faults.append(f"loads.{name}: {error}")
        return None
    return Load(
        name=name,
        body=body,
        point=None if table.force is None else point,
        characteristic=characteristic,
        over=table.argument,
        slider=table.slider,
        stroke=table.stroke,
        direction_rad=schema.within_a_turn(table.direction_deg or 0.0),
        frame=table.frame or "ground",
    )


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
    raise CrankcheckError(f"load {load.name}: a scene file can not state a {kind}")


def faults_of_loads(loads: schema.RawTables, names: schema.NamesInTables) -> Iterator[str]:
    """Yield faults of loads on, at or over missing things."""
    everything = (("link", names.points), ("block", names.blocks), ("slider", names.sliders))
    for key, _, load in schema.each_of(loads, "loads"):
        for what, known in everything:
            one = load.get(what)
            if isinstance(one, str) and one not in known:
                have = f"use one of {schema.first_of(known)}" if known else "the scene has none"
                yield f"{key}.{what}: found {cut(one)}; {have}"
        link, point = load.get("link"), load.get("point")
        own = names.points.get(link) if isinstance(link, str) else None
        if own is not None and isinstance(point, str) and point not in own:
            has = schema.first_of(sorted(own))
            yield f"{key}.point: {cut(str(link))} has no point {cut(point)}; it has {has}"
