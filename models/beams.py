"""A beam of an engine's own: what joins the nodes that an elastic link was cut into."""

from __future__ import annotations

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

    @property
    def elements(self) -> int:
        return len(self.nodes) - 1

    @property
    def element_m(self) -> float:
        """The length of an element."""
        return self.length_m / self.elements
