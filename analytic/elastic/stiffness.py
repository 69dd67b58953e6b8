"""The frequencies of elastic links at the start, which say what step holds them."""

from __future__ import annotations

import math

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.array import Array
from models.scene import Scene


def fastest_rad_s(scene: Scene, by: Discretisation) -> float:
    """The highest angular frequency of the links in the position of the start, unloaded."""
    return math.sqrt(float(_squares(scene, by).max()))


def slowest_rad_s(scene: Scene, by: Discretisation) -> float:
    """The lowest."""
    return math.sqrt(max(float(_squares(scene, by).min()), 0.0))


def _squares(scene: Scene, by: Discretisation) -> Array:
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    mass, stiffness = motion.first.mass[0], motion.form.stiffness
    return np.asarray(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
