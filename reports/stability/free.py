"""A chain of windows that is left free: its energy and its first pin against the closed form."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from analytic.windows import Turning
from models.scene import Scene
from models.windows import Chain
from reports.series import Array
from reports.stability.case import Trial
from reports.stability.seen import Seen
from reports.windows import Held, compared
from sim.engine import Run


def freely(trial: Trial, run: Run) -> Seen:
    """A free run beside the closed form of the chain.

    The error of place is the larger of the distance of B0 from its place, over a rod, and of the
    change of the energy, over what is exchanged in a turn. No crank is told where to be.
    """
    assert trial.chain is not None
    held = compared(trial.chain, run)
    theta, _, _ = Turning(trial.chain).at(held.time_s)
    return Seen(
        status=run.status,
        reason=run.reason,
        time_s=held.time_s,
        driver_rad=theta,
        place=np.nan_to_num(_error(held), nan=np.inf),
        gap=np.nan_to_num(held.gap_m / trial.chain.length_m, nan=np.inf),
        drive=np.zeros_like(theta),
        crank=theta,
        period_s=Turning(trial.chain).period_s,
        settled=0,
        departure=held.left,
        sine=float(np.min(np.abs(np.sin(theta)))),
    )


def _error(held: Held) -> Array:
    chain = held.chain
    energy = np.abs(held.energy_j) / Turning(chain).exchanged_j
    return np.asarray(np.maximum(held.place_m / chain.length_m, energy))


@dataclass(frozen=True)
class Falling:
    """The law by which a free chain turns, as if it were driven so: the truth to draw."""

    chain: Chain
    added_rad: float = 0.0

    @property
    def offset_rad(self) -> float:
        return 0.0

    @property
    def phase_rad(self) -> float:
        return 0.0

    @property
    def fastest_rad_s(self) -> float:
        return Turning(self.chain).fastest_rad_s

    @property
    def period_s(self) -> float:
        return Turning(self.chain).period_s

    @property
    def peak_speed_rad_s(self) -> float:
        return Turning(self.chain).fastest_rad_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        theta, omega, alpha = Turning(self.chain).at(time_s)
        return theta + self.added_rad, omega, alpha

    def turned(self, angle_rad: float) -> Falling:
        return replace(self, added_rad=self.added_rad + angle_rad)

    def mirrored(self) -> Falling:
        raise NotImplementedError("a chain that falls is drawn as it falls")

    def sped_up(self, factor: float) -> Falling:
        raise NotImplementedError("a chain that falls is drawn as it falls")


def falling_scene(trial: Trial) -> Scene:
    """The scene of the chain with the closed form as its driver's law."""
    assert trial.chain is not None
    driver = replace(trial.scene.driver, law=Falling(trial.chain))
    return replace(trial.scene, driver=driver)
