"""What the angular momentum of a free run has drifted by, where nothing outside may change it."""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene
from reports.compare.errors import Error
from reports.compare.free.energy_drift import drift, drift_row, window_s
from reports.compare.free.free_beside import FreeBeside
from reports.quantities.free import MOMENTUM


def momentum_rows(beside: FreeBeside) -> list[Error]:
    """The drift of the angular momentum about the one point that pins a mechanism to the ground,
    of means over windows as that of the energy; none where something else acts from outside."""
    run, scene = beside.run, beside.scene
    pivot = kept_about(scene) if beside.tells_momentum else None
    if pivot is None or run.velocity_time_s is None or run.velocity_time_s.size < 2:
        return []
    time_s = run.velocity_time_s
    spin = momentum(scene, beside.motion, time_s, pivot)
    largest = float(np.max(np.abs(spin)))
    if not largest > 0.0:
        return []
    change = drift(spin, time_s, window_s(scene, float(time_s[-1] - time_s[0])))
    return [drift_row(beside, MOMENTUM, abs(change), largest)]


def kept_about(scene: Scene) -> str | None:
    """The point about which a scene keeps its angular momentum; None where it does not."""
    pinned = [point for point, bodies in scene.pins.items() if GROUND in bodies and bodies[1:]]
    acts = any(scene.gravity_m_s2) or scene.loads or scene.friction or scene.springs
    return None if acts or scene.sliders or len(pinned) != 1 else pinned[0]


def momentum(scene: Scene, motion: Motion, time_s: Array, pivot: str) -> Array:
    """The angular momentum of the links about a point of the ground [kg m^2/s], (T,), at the
    instants ``time_s`` of their velocities."""
    total = np.zeros_like(time_s)
    later = time_s - motion.time_s
    place = complex(*scene.ground[pivot])
    for name, link in scene.links.items():
        point, own = next(iter(link.points.items()))
        moved, turned = motion.points[point], motion.links[name]
        theta = turned.theta + later * turned.omega
        arm = np.exp(1j * theta) * complex(link.centre_m[0] - own[0], link.centre_m[1] - own[1])
        velocity = moved.velocity @ np.array([1.0, 1j])
        centre = moved.position @ np.array([1.0, 1j]) + later * velocity + arm - place
        speed = velocity + 1j * turned.omega * arm
        total += link.mass_kg * (centre.conj() * speed).imag + link.inertia_kg_m2 * turned.omega
    return total
