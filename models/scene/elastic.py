"""Elastic links: properties of a link between two pins that bends, stretches, or both.

The link is a slender uniform beam (Euler and Bernoulli: no shear, no rotary inertia). Across the
line that joins its pins it bends with EI, along that line it stretches with EA::

        .-- w(x) --.
      A ------------ B        w(0) = w(l) = 0: the line always goes through both pins
      0      x      l         u(0) = 0, and the other pin is u(l) further away

Source: Thesis on vibration of planar mechanisms with elastic links (2018), chapters 2 and 3; the
shortening of a bent link by half the integral of w'^2, left out there, is kept here.
"""

import math
from dataclasses import dataclass
from typing import Literal

Shape = Literal["quasi-static", "straight", "periodic"]
"""Start of an elastic mechanism: the deflection for its rigid motion, none (which rings), or the
deflection of the motion that repeats after a period."""


@dataclass(frozen=True)
class ElasticLink:
    """``flexural_n_m2`` is EI and ``axial_n`` EA, infinite where the link does not bend, or does
    not stretch; ``damping_s`` is the ratio of damping to stiffness, for rates (Kelvin and Voigt).
    ``height_m`` is the height of the section in the plane of the motion, if known. The mass of the
    link is spread evenly between its pins."""

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
        """Return the angular frequency of a mode across, between two pins that far apart [m], with
        so much mass per length [kg/m]."""
        return (mode * math.pi / length_m) ** 2 * math.sqrt(self.flexural_n_m2 / density_kg_m)

    def axial_rad_s(self, length_m: float, density_kg_m: float, mode: int = 1) -> float:
        """Return the angular frequency of a mode along, one end fixed and the other free."""
        return (mode - 0.5) * math.pi / length_m * math.sqrt(self.axial_n / density_kg_m)


@dataclass(frozen=True)
class Beam:
    """Elements of one length between ``nodes``: links of a scene with a point each, at the angle of
    the beam's tangent. They have the mass of the beam in equal parts, the two at its ends half of
    one, and no inertia of their own.

    Straight at rest, ``length_m`` long, of ``density_kg_m`` per length [kg/m]; ``flexural_n_m2`` is
    EI and ``axial_n`` EA; ``damping_s`` is the ratio of damping to stiffness, for rates.
    """

    name: str
    nodes: tuple[str, ...]
    length_m: float
    density_kg_m: float
    flexural_n_m2: float
    axial_n: float
    damping_s: float = 0.0

    def locked(self, deflection_m: float) -> float:
        """Return the relative lack of bending of cubic elements at a deflection: they cannot bend
        without stretching somewhere, and bend less the more they resist that.

        Fitted (exudyn 1.13.6; n = 2 and 4, EA l^2/EI of 1e5 to 1e8) to a third of itself.
        """
        stiff = self.axial_n * deflection_m**2 / self.flexural_n_m2
        return 0.04 * stiff / self.elements**5

    def between(self) -> float:
        """Return the relative error of the middle of a beam by the cubic of the element around it,
        where it is no node: the fourth derivative of a half-wave, h^4/384 of it."""
        return (math.pi / self.elements) ** 4 / 384.0 if self.elements % 2 else 0.0

    def pushed(self, deflection_m: float) -> float:
        """Return the false start of a beam bent so far: acceleration of its ends over its length
        [1/s^2]. Nodes on the true line leave elements stretched, by (w/l)^2/n^4, until they have
        moved.

        Fitted (exudyn 1.13.6; n = 2 to 5, EA l^2/EI of 1e5 and 1e6, frequencies of 3.5 to 20.5
        times the speed): 2.0 to 2.1 of it in the four-bar, 0.8 and 0.4 in six-bar and slider-crank.
        """
        stretched = (deflection_m / self.length_m) ** 2 / self.elements**4
        return self.axial_n * stretched / (self.density_kg_m * self.length_m**2)

    @property
    def elements(self) -> int:
        return len(self.nodes) - 1

    @property
    def element_m(self) -> float:
        """Length of an element."""
        return self.length_m / self.elements
