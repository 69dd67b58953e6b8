"""What Baumgarte's terms cost: the error of a motion over alpha = beta and the step."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic.multibody.multibody_motion import Baumgarte, MultibodyMotion
from analytic.multibody.release_multibody import release_multibody
from models.array import Array
from models.errors import CrankcheckError
from models.motion import State
from models.scene import Scene

ALPHAS = (0.0, 1.0, 5.0, 20.0, 100.0, 500.0, 2000.0)
STEPS_S = (4e-3, 2e-3, 1e-3)
STABLE = 2.785
"""alpha h up to which the method of order 4 lets what decays by alpha decay: its interval of
stability on the real axis. Both roots of critical damping are -alpha."""
SAMPLES = 201


@dataclass(frozen=True)
class BaumgarteRow:
    """One motion with alpha = beta [1/s] and steps of ``step_s``, beside that with projection.

    ``error`` is the largest error of the angle of any link [rad], ``gap`` the largest violation of
    a constraint [m or rad], ``drift`` the largest change of the balance of energy over the largest
    kinetic energy. All are infinite where the motion has come apart.
    """

    alpha: float
    step_s: float
    error: float
    gap: float
    drift: float

    @property
    def stable(self) -> bool:
        """Whether what is open can decay at this step."""
        return self.alpha * self.step_s <= STABLE


def baumgarte_table(
    scene: Scene,
    until_s: float,
    alphas: Sequence[float] = ALPHAS,
    steps_s: Sequence[float] = STEPS_S,
    *,
    near: State | None = None,
) -> tuple[BaumgarteRow, ...]:
    """The errors for every alpha = beta [1/s] and every step [s].

    Parameters and errors otherwise as those of `release_multibody`.
    """
    time_s = np.linspace(0.0, until_s, SAMPLES)
    true = _angles(release_multibody(scene, until_s, near=near), time_s)

    def row(alpha: float, step_s: float) -> BaumgarteRow:
        free = release_multibody(scene, until_s, Baumgarte(alpha, alpha, step_s), near=near)
        try:
            error = float(np.abs(_angles(free, time_s) - true).max())
            energy = free.energy(time_s)
            drift = float(np.ptp(energy.balance) / energy.kinetic.max())
            return BaumgarteRow(alpha, step_s, error, float(gap(free, time_s).max()), drift)
        except CrankcheckError:
            return BaumgarteRow(alpha, step_s, math.inf, math.inf, math.inf)

    return tuple(row(alpha, step_s) for alpha in alphas for step_s in steps_s)


def gap(free: MultibodyMotion, time_s: Array) -> Array:
    """The largest violation of a constraint at times [s], [m or rad], (T,)."""
    gaps, each = free.dynamics.assembly.joints.gaps, free._configurations(time_s)
    return np.concatenate([np.abs(gaps(now)).max(axis=1) for _, now, _ in each])


def _angles(free: MultibodyMotion, time_s: Array) -> Array:
    return np.array([link.theta for link in free.at(time_s).links.values()])
