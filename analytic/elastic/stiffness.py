"""The frequencies of elastic links at the start, which say what step holds them."""

from __future__ import annotations

import math

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.array import Array
from models.scene import Scene


def fastest_rad_s(scene: Scene, by: Discretisation) -> float:
    """The highest angular frequency of the links in the position of the start, unloaded, or what
    dies off the fastest where damping_s makes that faster still."""
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    highest = math.sqrt(float(_squares(motion).max()))
    if not motion.form.damping.any():
        return highest
    mass, size = motion.first.mass[0], motion.form.size
    whole = np.zeros((2 * size, 2 * size))  # of deflections and their rates
    whole[:size, size:] = np.eye(size)
    whole[size:, :size] = -np.linalg.solve(mass, motion.form.stiffness)
    whole[size:, size:] = -np.linalg.solve(mass, motion.form.damping)
    return max(highest, float(np.abs(np.linalg.eigvals(whole)).max()))


def slowest_rad_s(scene: Scene, by: Discretisation) -> float:
    """The lowest."""
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    return math.sqrt(max(float(_squares(motion).min()), 0.0))


def _squares(motion: DrivenElasticMotion) -> Array:
    mass, stiffness = motion.first.mass[0], motion.form.stiffness
    return np.asarray(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
