"""What the links of a linkage weigh."""

from __future__ import annotations

from dataclasses import dataclass

from sim.mujoco.own_model.component import WORLD, rigid
from sim.mujoco.own_model.linkage import Linkage


@dataclass(frozen=True)
class Matter:
    """Mass [kg], centre of mass as the link is drawn [m], inertia about it across the plane."""

    mass_kg: float
    centre: complex
    inertia_kg_m2: float


def matter_of(linkage: Linkage, link: int) -> Matter:
    """What the bodies of a link weigh together, as the link is drawn."""
    component = linkage.component
    model, data, plane = component.model, component.data, component.plane
    parts = []
    for body in range(1, model.nbody):
        root = rigid(model, body)
        if root == WORLD or linkage.placements.get(root, (WORLD,))[0] != link:
            continue
        centre = linkage.placements[root][1](plane.flat(data.xipos[body]))
        axes = data.ximat[body].reshape(3, 3).T @ plane.normal
        about = float(axes @ (model.body_inertia[body] * axes))
        parts.append((float(model.body_mass[body]), centre, about))
    mass = sum(part[0] for part in parts)
    centre = sum(m * c for m, c, _ in parts) / mass if mass else 0j
    inertia = sum(own + m * abs(c - centre) ** 2 for m, c, own in parts)
    return Matter(mass, centre, inertia)
