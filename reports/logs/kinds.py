"""What a column of a log can be: of which bodies, in which units, and where a motion has it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from models.array import Array
from models.motion import Bound, Motion, Order
from reports.logs.units import Dimension, si
from reports.quantities.quantity import FIELDS, MovingKind

LoggedKind = MovingKind | Literal["elastic"]
"""What may be logged of: an elastic link is a link, and bends and stretches besides."""


_JUDGED: Mapping[str, MovingKind] = {
    **{kind: kind for kind in get_args(MovingKind)},
    "elastic": "link",
}
"""The kind of body that quantities of one are of."""


def plural(body_kind: str) -> str:
    """What a motion calls the bodies of a kind."""
    return {"elastic": "elastic"}.get(body_kind, f"{body_kind}s")


@dataclass(frozen=True)
class Kind:
    """One kind of reading: ``field`` of the motion of bodies of ``body_kind``, of vectors the
    component ``axis``, None where it is a number.

    ``quantity`` is the entry of `reports.quantities` that it is judged as; ``order`` 0 is a place,
    1 and 2 are its rates.
    """

    name: str
    body_kind: LoggedKind
    dimension: Dimension
    quantity: str
    field: str
    order: Order
    axis: Literal[0, 1] | None = None

    @property
    def turns(self) -> bool:
        """Whether it is an angle, of which whole turns may be lost."""
        return self.dimension == "angle"

    @property
    def judged_of(self) -> MovingKind:
        """The kind of body that its quantity is of."""
        return _JUDGED[self.body_kind]

    @property
    def bodies(self) -> str:
        """What a motion calls the bodies of its kind."""
        return plural(self.body_kind)

    def of(self, motion: Motion, name: str) -> Array:
        """The series (T,) of a body in a motion."""
        series: Array = getattr(getattr(motion, self.bodies)[name], self.field)
        return series if self.axis is None else series[:, self.axis]

    def bound(self, bound: Bound, name: str) -> Array:
        """What the reference may be wrong by (T,)."""
        series: Array = getattr(getattr(bound, self.bodies)[name], self.field)
        return series


def _kinds() -> Iterator[Kind]:
    turning: Sequence[Dimension] = ("angle", "angular velocity", "angular acceleration")
    moving: Sequence[Dimension] = ("length", "velocity", "acceleration")
    orders: Sequence[Order] = (0, 1, 2)
    axes: Sequence[tuple[Literal[0, 1], str]] = ((0, "x"), (1, "y"))
    rates = ("velocity", "acceleration")
    for order in orders:
        name, field = turning[order], FIELDS["link"][order]
        yield Kind(name, "link", name, ("angle", *rates)[order], field, order)
    for order in orders:
        prefix, field = ("", "v", "a")[order], FIELDS["point"][order]
        for axis, letter in axes:
            yield Kind(prefix + letter, "point", moving[order], field, field, order, axis)
    for order in orders:
        field = FIELDS["slider"][order]
        yield Kind(field, "slider", moving[order], ("displacement", *rates)[order], field, order)
    yield Kind("deflection", "elastic", "length", "deflection", "middle", 0)
    yield Kind("extension", "elastic", "length", "extension", "extension", 0)


KINDS: Mapping[tuple[LoggedKind, str], Kind] = {
    (kind.body_kind, kind.name): kind for kind in _kinds()
}
"""By body kind and name: angle, angular velocity, angular acceleration of a link; x, y, vx, vy, ax,
ay of a point; displacement, speed, acceleration of a slider; deflection of the middle of an elastic
link from the line between its pins, and its extension."""


OWN: Mapping[tuple[LoggedKind, str], str] = {
    ("link", "angle"): "theta_rad",
    ("link", "angular velocity"): "omega_rad_s",
    ("link", "angular acceleration"): "alpha_rad_s2",
    ("slider", "displacement"): "slider_displacement_m",
    ("slider", "speed"): "slider_speed_m_s",
    ("slider", "acceleration"): "slider_acceleration_m_s2",
    ("elastic", "deflection"): "deflection_m",
    ("elastic", "extension"): "extension_m",
    **{("point", f"{rate}{letter}"): f"{rate}{letter}_{unit}"
       for rate, unit in (("", "m"), ("v", "m_s"), ("a", "m_s2")) for letter in "xy"},
}  # fmt: skip
"""What we call columns ourselves, after the name of the body (`reports.describe.frame`)."""
LENGTH = "it is the length of a vector, whose components are judged"


@dataclass(frozen=True)
class Meaning:
    """What the name of a column says; "" and None for what it leaves open."""

    of: str
    kind: Kind | None
    gap: bool
    unit: str
    relative_to: str = ""
    on: str = ""


def own_meanings(bodies: Mapping[str, tuple[LoggedKind, ...]]) -> Mapping[str, Meaning | str]:
    """What our own columns of ``bodies`` say, whatever those are called, by name: a later body's
    where two have one."""
    found: dict[str, Meaning | str] = {}
    for body, kinds in bodies.items():
        said: dict[str, Meaning | str] = {
            name: Meaning(body, KINDS[key], False, si(KINDS[key].dimension))
            for key, name in OWN.items()
            if key[0] in kinds
        }
        if "point" in kinds:
            said |= dict.fromkeys(("v_m_s", "a_m_s2"), LENGTH)
        if "point" in kinds or "slider" in kinds:
            said["gap_m"] = Meaning(body, None, True, "m")
        found |= {f"{body}{mark}{name}": each for name, each in said.items() for mark in "_."}
    return found
