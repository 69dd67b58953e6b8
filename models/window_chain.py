"""The chain of windows: N four-bars side by side, the benchmark of machines that fall flat.

::

        B0 ---- B1 ---- B2 -- ... -- BN        N couplers
        |       |       |            |         N + 1 rockers
        A0      A1      A2           AN        on the ground, one length apart

All 2 N + 1 rods are alike. Where they lie flat every window is at a change point, and the mobility
rises from 1 to N + 1 for that instant. Source: problem A02, "N-four-bar mechanism", of the Library
of Computational Benchmark Problems of the IFToMM Technical Committee for Multibody Dynamics, which
has N = 40, 20 s, 9.81 m/s^2 downwards, and a start upright with 1 m/s of B0 along x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from models.errors import CrankcheckError
from models.laws import ConstantSpeed
from models.scene import Driver, Link, Point, Scene

UPRIGHT = math.pi / 2
SOURCE = "IFToMM Library of Computational Benchmark Problems, A02: N-four-bar mechanism"


@dataclass(frozen=True)
class Chain:
    """A chain of ``count`` windows, N; 0 is the first rocker alone, a pendulum.

    ``length_m`` and ``mass_kg`` are those of every rod; gravity [m/s^2] acts downwards; at time 0
    the rockers stand upright and B0 moves along x with ``speed_m_s``. Raises CrankcheckError for
    numbers that make no chain.
    """

    count: int
    length_m: float = 1.0
    mass_kg: float = 1.0
    gravity_m_s2: float = 9.81
    speed_m_s: float = 1.0

    def __post_init__(self) -> None:
        positive = {"length_m": self.length_m, "mass_kg": self.mass_kg}
        faults = [
            f"{name} {number:g}, where a number above 0 is needed"
            for name, number in positive.items()
            if not 0.0 < number < math.inf
        ]
        if self.count < 0:
            faults.append(f"{self.count} windows, where 0 is the least")
        if not 0.0 <= self.gravity_m_s2 < math.inf:
            faults.append(f"gravity_m_s2 {self.gravity_m_s2:g}, where 0 is the least")
        if self.speed_m_s == 0.0 or not math.isfinite(self.speed_m_s):
            faults.append(f"speed_m_s {self.speed_m_s:g}, where another number than 0 is needed")
        if faults:
            raise CrankcheckError(f"chain of windows: found {'; '.join(faults)}")

    @property
    def start_rad_s(self) -> float:
        """Angular velocity of the rockers at time 0; falling along x they turn clockwise."""
        return -self.speed_m_s / self.length_m

    def rockers(self) -> tuple[str, ...]:
        """The names of the rods on the ground."""
        return tuple(f"rocker{i}" for i in range(self.count + 1))

    def couplers(self) -> tuple[str, ...]:
        """The names of the rods on top."""
        return tuple(f"coupler{i}" for i in range(self.count))

    def scene(self) -> Scene:
        """The chain, to be left free; its driver has the place and the speed of the start.

        Driven at rocker0 by `analytic.kinematics.solve` it goes through the flat position up to
        N = 6, one of 7 is refused there, and longer ones at any angle: each dyad is in a change
        point with all before it, and from the eighth on that is lost in their rounding.
        """
        links = [self._rod("rocker0", "A0", "B0")]
        for i, coupler in enumerate(self.couplers()):
            links.append(self._rod(coupler, f"B{i}", f"B{i + 1}"))
            links.append(self._rod(f"rocker{i + 1}", f"A{i + 1}", f"B{i + 1}"))
        return Scene(
            name=f"windows-{self.count}",
            source=SOURCE,
            ground={f"A{i}": (i * self.length_m, 0.0) for i in range(self.count + 1)},
            links={link.name: link for link in links},
            sliders={},
            driver=Driver("rocker0", ConstantSpeed(UPRIGHT, self.start_rad_s)),
            gravity_m_s2=(0.0, -self.gravity_m_s2),
        )

    def _rod(self, name: str, start: str, end: str) -> Link:
        """A uniform slender rod from one point to another."""
        length, mass = self.length_m, self.mass_kg
        ends: dict[str, Point] = {start: (0.0, 0.0), end: (length, 0.0)}
        return Link(name, ends, mass, (0.5 * length, 0.0), mass * length**2 / 12)
