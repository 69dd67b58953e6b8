"""The highest frequency of elastic links at the start, which says what step holds them."""

from __future__ import annotations

import math

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.scene import Scene


def fastest_rad_s(scene: Scene, by: Discretisation) -> float:
    """The highest angular frequency of the links in the position of the start, unloaded."""
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    mass, stiffness = motion.first.mass[0], motion.form.stiffness
    return math.sqrt(float(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.max()))
