"""The mechanical energy of an engine's bodies and springs, from the scene's and their motion."""

from __future__ import annotations

import numpy as np

from models.joints import bodies
from models.poses import centre_of, mass_of
from models.scene import Scene
from sim.engine import Energy, Poses
from sim.measure import BodyPath, PointPath, at_velocities
from sim.spring_lengths import spring_lengths


def energy(scene: Scene, poses: Poses) -> Energy:
    """Kinetic and potential energy [J] of all bodies and springs, both at the instants of the
    velocities.

    Where velocities lag, the positions are moved on to them, which is good to the second order of
    the step. Heights count from the origin against gravity. A crank that a drive carries counts
    with the mass of its link. What loads put in and dampers and friction take out is in neither: of
    a scene that has any the total changes.
    """
    then = at_velocities(poses)
    kinetic, potential = np.zeros(len(poses.time_s)), np.zeros(len(poses.time_s))
    gravity = np.array(scene.gravity_m_s2)
    with np.errstate(all="ignore"):  # what has come apart may overflow
        for body in bodies(scene):
            pose, (mass, inertia) = then.bodies[body], mass_of(scene, body)
            centre = PointPath(BodyPath(pose), centre_of(scene, body))
            square = (centre.velocity**2).sum(axis=1)
            kinetic += 0.5 * mass * square + 0.5 * inertia * pose.omega**2
            potential -= mass * centre.position @ gravity
        for name, length in spring_lengths(scene, then).items():
            spring = scene.springs[name]
            potential += 0.5 * spring.rate * (length - spring.free) ** 2
    return Energy(kinetic, potential)
