"""What a scene says of its start beside the driver's angle and speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from models.elastic import Shape
from models.fixed import FixedMapping


@dataclass(frozen=True)
class Start:
    """Angles [rad] and angular velocities [rad/s] of links, displacements [m] and speeds [m/s] of
    sliders at time 0, by name.

    Of a mechanism of mobility 1 they say again what the driver's own angle and speed say already,
    and are held to it; of one with more freedoms they are the rest of its start.
    """

    angles_rad: Mapping[str, float] = field(default_factory=dict)
    rates_rad_s: Mapping[str, float] = field(default_factory=dict)
    displacements_m: Mapping[str, float] = field(default_factory=dict)
    speeds_m_s: Mapping[str, float] = field(default_factory=dict)
    shape: Shape | None = None

    def __post_init__(self) -> None:
        for name in ("angles_rad", "rates_rad_s", "displacements_m", "speeds_m_s"):
            object.__setattr__(self, name, FixedMapping(getattr(self, name)))

    def __bool__(self) -> bool:
        return any(vars(self).values())
