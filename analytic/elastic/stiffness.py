"""The highest frequency of elastic links at the start, which says what step holds them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.released import release_elastic
from models.array import Array
from models.scene import Scene


def fastest_rad_s(scene: Scene, by: Discretisation) -> float:
    """The highest angular frequency of the links in the position of the start, unloaded."""
    return math.sqrt(float(_squares(scene, by).max()))


def _squares(scene: Scene, by: Discretisation) -> Array:
    if scene.is_free:
        return _of_released(scene, by)
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    mass, stiffness = motion.first.mass[0], motion.form.stiffness
    return np.asarray(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)


def _of_released(scene: Scene, by: Discretisation) -> Array:
    """Of what nothing holds: all but the lowest, as many as there would be with rigid links."""
    straight = replace(scene, start=replace(scene.start, shape="straight"))
    motion = release_elastic(straight, 1.0, by)
    form, tangent = motion.form, motion.form.tangent(motion.start[0])
    still = np.zeros(tangent.free.shape[1])
    pulled = -form.derivatives(0.0, tangent, still, still)[:, : still.size]
    squares = np.sort(np.linalg.eigvals(pulled).real)
    return np.asarray(squares[still.size - len(motion.assembly.coefficients) :])
