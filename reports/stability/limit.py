"""A run towards a limit position: there is no reference beyond it, and the limit is the truth."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from models.laws import Law
from models.scene import Scene
from reports.series import Array
from reports.stability.case import Trial
from reports.stability.seen import Seen
from sim.engine import Run

WILD = 1e3
"""A link this much faster than the driver is told to be: forces have exploded."""

SHORT_RAD = 1e-9
"""The reference stops that much before the limit, where it still has an angle."""


@dataclass(frozen=True)
class HeldAt:
    """A law that follows another as far as a limit [rad], and stands there: the truth to draw."""

    law: Law
    low_rad: float
    high_rad: float

    @property
    def offset_rad(self) -> float:
        return self.law.offset_rad

    @property
    def phase_rad(self) -> float:
        return self.law.phase_rad

    @property
    def fastest_rad_s(self) -> float:
        return self.law.fastest_rad_s

    @property
    def period_s(self) -> float:
        return self.law.period_s

    @property
    def peak_speed_rad_s(self) -> float:
        return self.law.peak_speed_rad_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        theta, omega, alpha = self.law.at(time_s)
        free = (theta > self.low_rad) & (theta < self.high_rad)
        held = np.clip(theta, self.low_rad, self.high_rad)
        return held, np.where(free, omega, 0.0), np.where(free, alpha, 0.0)

    def turned(self, angle_rad: float) -> HeldAt:
        low, high = self.low_rad + angle_rad, self.high_rad + angle_rad
        return HeldAt(self.law.turned(angle_rad), low, high)

    def mirrored(self) -> HeldAt:
        return HeldAt(self.law.mirrored(), -self.high_rad, -self.low_rad)

    def sped_up(self, factor: float) -> HeldAt:
        return replace(self, law=self.law.sped_up(factor))


def held_scene(trial: Trial) -> Scene:
    """The scene with its crank held at the limit."""
    driver = trial.scene.driver
    low = float(driver.law.at(np.zeros(1))[0][0])
    law = HeldAt(driver.law, low, trial.limit_rad - SHORT_RAD)
    return replace(trial.scene, driver=replace(driver, law=law))


def at_limit(trial: Trial, run: Run) -> Seen:
    """A run beside the limit that its crank cannot pass.

    The error of place is how far the crank has gone beyond the limit [rad]; what the crank is
    told is its command, so that a crank that is held back stands short of it.
    """
    assert run.motion is not None
    scene, motion = trial.scene, run.motion
    law = scene.driver.law
    driver = law.at(motion.time_s)[0]
    crank = motion.links[scene.driver.link].theta
    forward = np.sign(driver[-1] - driver[0])
    with np.errstate(over="ignore", invalid="ignore"):  # what has come apart is judged, not warned
        spin = np.max([np.abs(link.omega) for link in motion.links.values()], axis=0)
        gap = np.max([np.abs(one) for one in run.gaps.values()], axis=0) / scene.longest_m
        beyond = np.maximum(forward * (crank - trial.limit_rad), 0.0)
    status, reason = run.status, run.reason
    fastest = float(np.nan_to_num(spin, nan=np.inf).max()) / law.peak_speed_rad_s
    if status == "ok" and fastest > WILD:
        status, reason = "diverged", f"a link turns {fastest:.1g} times as fast as the command"
    return Seen(
        status=status,
        reason=reason,
        time_s=motion.time_s,
        driver_rad=driver,
        place=np.nan_to_num(beyond, nan=np.inf),
        gap=np.nan_to_num(gap, nan=np.inf),
        drive=np.nan_to_num(np.abs(crank - driver), nan=np.inf),
        crank=crank,
        period_s=law.period_s,
        settled=0,
        departure=None,
        sine=0.0,
    )
