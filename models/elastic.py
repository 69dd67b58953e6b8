"""Elastic links: what a link between two pins needs to bend, to stretch, or both.

The link is a slender uniform beam (Euler and Bernoulli: no shear, no rotary inertia). Across the
line that joins its pins it bends with EI, along it it stretches with EA::

        .-- w(x) --.
      A ------------ B        w(0) = w(l) = 0: the line always goes through both pins
      0      x      l         u(0) = 0, and the other pin is u(l) further away

Source: Thesis on vibration of planar mechanisms with elastic links (2018), chapters 2 and 3; the
shortening of a bent link by half the integral of w'^2, which is left out there, is kept here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Shape = Literal["quasi-static", "straight", "periodic"]
"""What an elastic mechanism starts with: the deflection that its motion as a rigid one asks for,
none at all, which rings, or that of the motion which comes back after a period."""


@dataclass(frozen=True)
class ElasticLink:
    """``flexural_n_m2`` is EI and ``axial_n`` EA, infinite where the link does not bend, or does
    not stretch; ``damping_s`` is by how much damping is stiffness, for rates (Kelvin and Voigt).
    ``height_m`` is that of the section in the plane of the motion, where it is known. The mass is
    that of the link, spread evenly between its pins."""

    link: str
    flexural_n_m2: float = math.inf
    axial_n: float = math.inf
    damping_s: float = 0.0
    height_m: float | None = None

    @property
    def bends(self) -> bool:
        return math.isfinite(self.flexural_n_m2)

    @property
    def stretches(self) -> bool:
        return math.isfinite(self.axial_n)

    def bending_rad_s(self, length_m: float, density_kg_m: float, mode: int = 1) -> float:
        """The angular frequency of a mode across, between two pins that far apart [m], with so much
        mass per length [kg/m]."""
        return (mode * math.pi / length_m) ** 2 * math.sqrt(self.flexural_n_m2 / density_kg_m)

    def axial_rad_s(self, length_m: float, density_kg_m: float, mode: int = 1) -> float:
        """That of a mode along, one end held and the other free."""
        return (mode - 0.5) * math.pi / length_m * math.sqrt(self.axial_n / density_kg_m)
