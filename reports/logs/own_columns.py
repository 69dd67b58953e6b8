"""What the columns say that we write ourselves: `reports.describe.frame`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from reports.logs.kinds import KINDS, Kind, LoggedKind
from reports.logs.units import si

OWN: Mapping[tuple[LoggedKind, str], str] = {
    ("link", "angle"): "theta_rad",
    ("link", "angular velocity"): "omega_rad_s",
    ("link", "angular acceleration"): "alpha_rad_s2",
    ("slider", "displacement"): "slider_displacement_m",
    ("slider", "speed"): "slider_speed_m_s",
    ("slider", "acceleration"): "slider_acceleration_m_s2",
    ("elastic", "deflection"): "deflection_m",
    ("elastic", "extension"): "extension_m",
    **{("point", f"{rate}{axis}"): f"{rate}{axis}_{unit}"
       for rate, unit in (("", "m"), ("v", "m_s"), ("a", "m_s2")) for axis in "xy"},
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
