"""A beam of an engine's own: what joins the nodes that an elastic link was cut into."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Beam:
    """Elements of one length between ``nodes``, links of a scene with a point each, whose angle is
    that of the beam's tangent; they have the mass of the beam in equal parts, the two at its ends
    half of one, and no inertia of their own.

    Straight at rest, ``length_m`` long, of ``density_kg_m`` per length [kg/m]; ``flexural_n_m2`` is
    EI and ``axial_n`` EA; ``damping_s`` is by how much damping is stiffness, for rates.
    """

    name: str
    nodes: tuple[str, ...]
    length_m: float
    density_kg_m: float
    flexural_n_m2: float
    axial_n: float
    damping_s: float = 0.0

    def locked(self, deflection_m: float) -> float:
        """By which share cubic elements bend too little to a deflection: they can not bend without
        stretching somewhere, the less so the more they resist that.

        Fitted (exudyn 1.13.6; n = 2 and 4, EA l^2/EI of 1e5 to 1e8) to a third of itself.
        """
        stiff = self.axial_n * deflection_m**2 / self.flexural_n_m2
        return 0.04 * stiff / self.elements**5

    def between(self) -> float:
        """By which share of its deflection the middle of a beam is off the cubic of the element
        that it lies in, where no node is: the fourth derivative of a half-wave, h^4/384 of it."""
        return (math.pi / self.elements) ** 4 / 384.0 if self.elements % 2 else 0.0

    def pushed(self, deflection_m: float) -> float:
        """What it starts off by, bent so far: acceleration of its ends over its length [1/s^2].
        Nodes that stand on the true line leave elements stretched, by (w/l)^2/n^4, until they have
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
        """The length of an element."""
        return self.length_m / self.elements
