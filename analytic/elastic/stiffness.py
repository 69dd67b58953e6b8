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
    """The highest angular frequency of the links in the position of the start, unloaded, or what
    dies off the fastest where damping_s makes that faster still."""
    by_place, by_rate = _of_released(scene, by) if scene.is_free else _of_driven(scene, by)
    highest = math.sqrt(float(np.linalg.eigvals(-by_place).real.max()))
    if not any(own.damping_s for own in scene.elastic.values()):
        return highest
    still, one = np.zeros_like(by_place), np.eye(len(by_place))
    whole = np.block([[still, one], [by_place, by_rate]])
    return max(highest, float(np.abs(np.linalg.eigvals(whole)).max()))


def _of_driven(scene: Scene, by: Discretisation) -> tuple[Array, Array]:
    """What accelerations of the coefficients are by these and by their rates, (m, m) each."""
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    form, mass = motion.form, motion.first.mass[0]
    return -np.linalg.solve(mass, form.stiffness), -np.linalg.solve(mass, form.damping)


def _of_released(scene: Scene, by: Discretisation) -> tuple[Array, Array]:
    """The same where nothing holds the driver, of its angle too."""
    straight = replace(scene, start=replace(scene.start, shape="straight"))
    motion = release_elastic(straight, 1.0, by)
    form, tangent = motion.form, motion.form.tangent(motion.start[0])
    still = np.zeros(tangent.free.shape[1])
    derived = form.derivatives(0.0, tangent, still, still)
    return derived[:, : still.size], derived[:, still.size :]
