"""Elastic links of a mechanism whose driver is controlled (`models.controlled`).

Nothing tells the driver's angle: it is one of the freedoms, as in what is let go, with the torque
of the controller on it. What the rigid mechanism needs comes from its kinetostatics.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.released import Method, ReleasedElasticMotion, follow
from analytic.forces.kinetostatics import forces
from analytic.multibody.assembly import Assembly
from analytic.multibody.configuration import Configuration
from analytic.multibody.generalised_forces import GeneralisedForces, Strokes
from models.array import Array
from models.controlled import Controlled
from models.errors import CrankcheckError
from models.released import check_duration
from models.scene import Same, Scene


class ControlledForces(GeneralisedForces):
    """What acts on an assembly whose driver is controlled."""

    def __init__(self, assembly: Assembly, start: Array) -> None:
        super().__init__(assembly, start)
        law = assembly.scene.driver.law
        assert isinstance(law, Controlled)
        self._law = law
        self._rigid = Same(replace(assembly.scene, elastic={}))

    def on(self, time_s: Array, now: Configuration, strokes: Strokes | None = None) -> Array:
        gradient = now.gradient[:, self.assembly.frames[self.scene.driver.link], 2]
        return super().on(time_s, now, strokes) + self.driving(time_s, now)[:, None] * gradient

    def driving(self, time_s: Array, now: Configuration) -> Array:
        marker, law = self.assembly.frames[self.scene.driver.link], self._law
        ahead = now.place[:, marker, 2] - law.angle(time_s)
        faster = now.velocity[:, marker, 2] - law.speed_rad_s
        needed = _needed(self._rigid, tuple(time_s))
        return needed - law.kp_n_m_rad * ahead - law.kd_n_m_s * faster


@lru_cache(maxsize=16)  # every round of Newton's method asks for the same instants
def _needed(rigid: Same, time_s: tuple[float, ...]) -> Array:
    """The driving torque of a rigid mechanism that keeps to its law [N m], (T,)."""
    instants, place = np.unique(np.array(time_s), return_inverse=True)
    return forces(rigid.scene, instants, bound=False).torque[place]


def control_elastic(
    scene: Scene,
    until_s: float,
    by: Discretisation | None = None,
    *,
    stiffened: bool = True,
    method: Method = "collocation",
    tolerance: float | None = None,
) -> ReleasedElasticMotion:
    """The motion of a scene with elastic links whose driver is controlled.

    Parameters and errors otherwise as those of `analytic.elastic.released.release_elastic`.

    Raises
    ------
    CrankcheckError
        A driver that follows another law, or none.
    """
    if not isinstance(scene.driver.law, Controlled):
        raise CrankcheckError(
            f'{scene.name}: its driver is not controlled; give law = "controlled" in [driver], '
            "with speed_rad_s, kp_n_m_rad and kd_n_m_s"
        )
    check_duration(scene.name, until_s)
    return follow(scene, until_s, by, stiffened, method, tolerance, ControlledForces)
