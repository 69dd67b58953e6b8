"""A run towards a limit position: there is no reference beyond it, and the limit is the truth."""

from __future__ import annotations

import numpy as np

from analytic.kinematics import solve_driven
from models.array import Array
from models.motion import Motion
from reports.stability.case import Trial
from reports.stability.error_series import ErrorSeries, lacking, worst_of
from sim.engine import Run

WILD = 1e3
"""A link this much faster than the driver is told to be: forces have exploded."""

SHORT_RAD = 1e-9
"""The reference stops that much before the limit, where it still has an angle."""


def held(trial: Trial, time_s: Array) -> Motion:
    """The truth to be drawn: the crank follows its command as far as the limit, and stands."""
    law = trial.scene.driver.law
    theta = law.at(np.append(0.0, time_s))[0]
    low, high = sorted((float(theta[0]), trial.limit_rad))
    still = np.zeros_like(time_s)
    inside = np.clip(theta[1:], low + SHORT_RAD, high - SHORT_RAD)
    return solve_driven(trial.scene, inside, still, still, time_s, bound=False)


def at_limit(trial: Trial, run: Run) -> ErrorSeries:
    """A run beside the limit that its crank cannot pass.

    The error of place is how far the crank is from its command, which ends at the limit [rad]. What
    the crank is told goes on, so that a crank that is held back stands short of it.
    """
    assert run.motion is not None
    scene, motion = trial.scene, run.motion
    law = scene.driver.law
    driver = law.at(motion.time_s)[0]
    crank = motion.links[scene.driver.link].theta
    low, high = sorted((float(driver[0]), trial.limit_rad))
    with np.errstate(over="ignore", invalid="ignore"):  # what has come apart is judged, not warned
        spin = np.max([np.abs(link.omega) for link in motion.links.values()], axis=0)
        gap = np.max([np.abs(one) for one in run.gaps.values()], axis=0) / scene.longest_m
        off = np.abs(crank - np.clip(driver, low, high))
    status, reason = run.status, run.reason
    fastest = float(worst_of(spin).max()) / law.peak_speed_rad_s
    if status == "ok" and fastest > WILD:
        status, reason = "diverged", f"a link turns {fastest:.1g} times as fast as the command"
    return ErrorSeries(
        status=status,
        reason=reason,
        time_s=motion.time_s,
        driver_rad=driver,
        place=worst_of(off),
        gap=worst_of(gap),
        drive=worst_of(np.abs(crank - driver)),
        crank=crank,
        period_s=law.period_s,
        sine=0.0,
        incomplete=lacking(scene, run),
        limited=True,
    )
