"""The shape of the tables `[loads.NAME]` of a scene file, one for each law of a load."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.loads import Over, Stroke
from models.table_fields import Degrees, Name, Number, Positive, Table
from models.tabulated import Interpolation

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
"""Cosines or sines; the shorter of the two goes on with zeros."""
Powers = Annotated[tuple[Number, ...], Field(min_length=1, max_length=20)]


class LoadTable(Table):
    """What every load says: where it acts, and along what."""

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
        """What stands under ``stem`` in the unit of the argument; in other units it is a fault."""
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
    """``force_n`` or ``torque_n_m`` is the amplitude, the period that of one wave."""

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
    """One wave of a sine over time, from ``start_s`` on, and nothing beside it."""

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
    """The mean, and cosines and sines of one wave in a period, of two, of three and so on."""

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
    """The coefficients, of x^0 first, x in s, rad or m."""

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
