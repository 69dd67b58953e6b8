"""Elastic links of a mechanism whose driver is controlled (`models.scene.driver`).

The driver's angle is one of the freedoms, as in free motion, with the torque of the controller on
it. The torque that the rigid mechanism needs comes from its kinetostatics.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from analytic.elastic.discretisation import Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion, ElasticHistory
from analytic.elastic.released import ReleasedElasticMotion, release_elastic
from analytic.forces.kinetostatics import forces
from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration
from analytic.multibody.generalised_forces import GeneralisedForces, Strokes
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Same, Scene
from models.scene.characteristics import FourierSum
from models.scene.cut_links import with_rigid_links
from models.scene.driver import Controlled, Released, let_go
from models.scene.elastic import Shape


def elastic_history(
    scene: Scene,
    until_s: float,
    by: Discretisation,
    start: Shape,
    *,
    stiffened: bool = True,
    tolerance: float | None = None,
) -> ElasticHistory:
    """Return the motion from time 0 to ``until_s`` [s], which starts with a shape.

    ``tolerance`` is that of `release_elastic`, for free and controlled drivers. Raises
    CrankcheckError as `release_elastic`, and as `DrivenElasticMotion` where it is evaluated.
    """
    law = scene.driver.law
    if not isinstance(law, Controlled | Released):
        return DrivenElasticMotion(scene, until_s, by, start, stiffened)
    begun = replace(scene, start=replace(scene.start, shape=start))
    release = control_elastic if isinstance(law, Controlled) else release_elastic
    return release(begun, until_s, by, stiffened=stiffened, tolerance=tolerance)


TURN_SAMPLES = (64, 128, 256, 512, 1024)
"""Numbers of samples of the rigid mechanism's torque, tried one after the other."""
SMOOTH, REPEATED = 1e-13, 1e-9
"""Largest amplitude of the shortest waves of a smooth torque, and largest change of the torque a
turn later, both over its largest value."""


class ControlledForces(GeneralisedForces):
    """Forces on an assembly whose driver is controlled."""

    def __init__(self, assembly: Assembly, start: Array) -> None:
        super().__init__(assembly, start)
        law = assembly.scene.driver.law
        assert isinstance(law, Controlled)
        self._law = law
        self._rigid = Same(with_rigid_links(assembly.scene))

    def on(self, time_s: Array, now: Configuration, strokes: Strokes | None = None) -> Array:
        gradient = now.gradient[:, self.assembly.frames[self.scene.driver.link], 2]
        return super().on(time_s, now, strokes) + self.driving(time_s, now)[:, None] * gradient

    def driving(self, time_s: Array, now: Configuration) -> Array:
        marker, law = self.assembly.frames[self.scene.driver.link], self._law
        ahead = now.place[:, marker, 2] - law.angle(time_s)
        faster = now.velocity[:, marker, 2] - law.speed_rad_s
        needed = _needed(self._rigid, tuple(time_s))
        return needed - law.kp_n_m_rad * ahead - law.kd_n_m_s * faster


@lru_cache(maxsize=16)  # every round of Newton's method needs the same instants
def _needed(rigid: Same, time_s: tuple[float, ...]) -> Array:
    """Return the driving torque of a rigid mechanism that follows its law exactly [N m], (T,)."""
    instants, place = np.unique(np.array(time_s), return_inverse=True)
    return forces(rigid.scene, instants, bound=False).torque[place]


def control_elastic(
    scene: Scene,
    until_s: float,
    by: Discretisation | None = None,
    *,
    stiffened: bool = True,
    tolerance: float | None = None,
) -> ReleasedElasticMotion:
    """Prepare the motion of a scene with elastic links whose driver is controlled.

    Parameters and errors as in `release_elastic`; raises CrankcheckError for another driver.
    """
    _controlled(scene)
    return release_elastic(
        scene, until_s, by, stiffened=stiffened, tolerance=tolerance, acting=ControlledForces
    )


def released_under_control(scene: Scene) -> Scene:
    """Return a scene whose driver is controlled as a free one, with the torque of the controller as
    loads: the scene for engines.

    The torque that the rigid mechanism needs is a Fourier sum, to rounding.

    Raises
    ------
    CrankcheckError
        As `control_elastic`; a torque that does not repeat itself turn by turn, or is not smooth.
    """
    law, link = _controlled(scene), scene.driver.link
    loads = {load.name: load for load in law.loads(link, _needed_sum(scene, law))}
    if taken := loads.keys() & scene.loads.keys():
        raise CrankcheckError(
            f"{scene.name}: loads.{min(taken)} has the name of a part of the controller's torque; "
            "give it another one"
        )
    return replace(let_go(scene), loads={**scene.loads, **loads})


def _needed_sum(scene: Scene, law: Controlled) -> FourierSum:
    """Return the driving torque of the rigid mechanism over a turn. Raises CrankcheckError."""
    rigid, period_s = Same(with_rigid_links(scene)), law.period_s
    for count in TURN_SAMPLES:
        turn_s = period_s / count * np.arange(count)
        torque = _needed(rigid, tuple(turn_s))
        size = float(np.abs(torque).max()) or 1.0
        # The shortest wave has two samples; the last half of the waves shows the truncation.
        waves = np.fft.rfft(torque)[: count // 2] / count
        if np.abs(waves[count // 4 :]).max() <= SMOOTH * size:
            later = _needed(rigid, tuple(turn_s[:: count // 8] + period_s))
            if np.abs(later - torque[:: count // 8]).max() <= REPEATED * size:
                kept = waves[1 : count // 4]
                cosines, sines = 2.0 * kept.real, -2.0 * kept.imag
                return FourierSum(
                    float(waves[0].real), tuple(cosines.tolist()), tuple(sines.tolist()), period_s
                )
    raise CrankcheckError(
        f"{scene.name}: the torque below its controller does not continue smoothly from turn to "
        "turn, because of loads over time or with jumps; leave these out, or compute the "
        "motion with `crankcheck solve`"
    )


def _controlled(scene: Scene) -> Controlled:
    """Return the law of a controlled driver. Raises CrankcheckError for another."""
    law = scene.driver.law
    if not isinstance(law, Controlled):
        raise CrankcheckError(
            f'{scene.name}: its driver is not controlled; give law = "controlled" in [driver], '
            "with speed_rad_s, kp_n_m_rad and kd_n_m_s"
        )
    return law
