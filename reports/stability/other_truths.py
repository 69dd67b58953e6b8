"""Hard runs beside another reference than a driven motion: a limit, a falling chain, a toggle."""

import numpy as np

from analytic.free.exact_motions import ChainMotion
from analytic.kinematics import solve_driven
from models.array import Array
from models.motion import Motion, State
from reports.compare.errors import Departure
from reports.compare.hard_runs import OVER, ChainErrors, compared, toggle_passage
from reports.stability.case import Throw, Trial
from reports.stability.error_series import ErrorSeries, lacking, widest, worst_of
from sim.engine import Run

WILD = 1e3
"""Ratio of a link's speed to the driver's command above which forces have exploded."""

SHORT_RAD = 1e-9
"""Distance before the limit at which the reference stops, where it still has an angle."""


def held(trial: Trial, time_s: Array) -> Motion:
    """Return the reference to be drawn: the crank follows its command to the limit, and stands."""
    law = trial.scene.driver.law
    theta = law.at(np.append(0.0, time_s))[0]
    low, high = sorted((float(theta[0]), trial.limit_rad))
    still = np.zeros_like(time_s)
    inside = np.clip(theta[1:], low + SHORT_RAD, high - SHORT_RAD)
    return solve_driven(trial.scene, inside, still, still, time_s, bound=False)


def at_limit(trial: Trial, run: Run) -> ErrorSeries:
    """Return a run beside the limit that its crank cannot pass.

    The error of place is the distance of the crank from its command, which ends at the limit [rad].
    The command of the drive goes on, so that a crank that is held back stands short of it.
    """
    assert run.motion is not None
    scene, motion = trial.scene, run.motion
    law = scene.driver.law
    driver = law.at(motion.time_s)[0]
    crank = motion.links[scene.driver.link].theta
    low, high = sorted((float(driver[0]), trial.limit_rad))
    with np.errstate(over="ignore", invalid="ignore"):  # runs that came apart are judged
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


def freely(trial: Trial, run: Run) -> ErrorSeries:
    """Return a free run beside the closed form of the chain.

    The error of place is the larger of the distance of B0 from its place, over a rod, and of the
    change of the energy, over the energy exchanged in a turn.
    """
    assert trial.chain is not None
    errors = compared(trial.chain, run)
    theta, _, _ = ChainMotion(trial.chain).at(errors.time_s)
    return ErrorSeries(
        status=run.status,
        reason=run.reason,
        time_s=errors.time_s,
        driver_rad=theta,
        place=worst_of(_error(errors)),
        gap=worst_of(errors.gap_m / trial.chain.length_m),
        drive=np.full_like(theta, np.nan),
        crank=theta,
        period_s=ChainMotion(trial.chain).period_s,
        departure=errors.left,
        sine=float(np.min(np.abs(np.sin(theta)))),
        incomplete=lacking(trial.scene, run),
    )


def _error(errors: ChainErrors) -> Array:
    chain = errors.chain
    energy = np.abs(errors.energy_j) / ChainMotion(chain).exchanged_j
    return np.asarray(np.maximum(errors.place_m / chain.length_m, energy))


def falling(trial: Trial, time_s: Array) -> Motion:
    """Return the reference to be drawn."""
    assert trial.chain is not None
    return ChainMotion(trial.chain).motion(time_s)


def at_toggle(trial: Trial, run: Run) -> ErrorSeries:
    """Return a run beside the outcome that its energy allows.

    A run that gets over and should not has left its branch. For a run that should and does not, the
    error of place is the angle that coupler and rocker were short of having passed, at the nearest
    [rad].
    """
    motion, throw = run.motion, _throw(trial)
    assert motion is not None
    crank = motion.links[trial.scene.driver.link].theta
    passage = toggle_passage(throw.barrier, run)
    place, left = np.zeros_like(crank), None
    over = throw.margin > 0.0
    if passage.outcome == "over" and not over:
        _, other = throw.barrier.links
        at = passage.index
        left = Departure(other, float(motion.time_s[at]), float(crank[at]))
    elif passage.outcome == "undecided" or (passage.outcome == "back" and over):
        short = passage.nearest_rad - OVER * abs(throw.barrier.open_rad)
        place[passage.index :] = short
    gaps = [np.abs(gap) / trial.scene.longest_m for gap in run.gaps.values()]
    decided = np.arange(crank.size) <= passage.index
    return ErrorSeries(
        status=run.status,
        reason=run.reason,
        time_s=motion.time_s,
        driver_rad=worst_of(crank),
        place=place,
        gap=np.where(decided, widest(gaps, crank), 0.0),  # the gap after it does not matter
        drive=np.full_like(crank, np.nan),
        crank=worst_of(crank),
        period_s=trial.scene.driver.law.period_s,
        departure=left,
        sine=0.0,
        incomplete=lacking(trial.scene, run),
        worst_of_place="the angle of coupler and rocker, short of being over,",
    )


def thrown_start(trial: Trial) -> State:
    """Return the state of the throw."""
    throw = _throw(trial)
    return throw.barrier.start(throw.margin)


def thrown_motion(trial: Trial, time_s: Array) -> Motion:
    """Return the reference to be drawn."""
    from analytic.free.release import release  # slow to import, for free motion alone

    return release(trial.scene, trial.steps * trial.dt_s).at(time_s, bound=False)


def _throw(trial: Trial) -> Throw:
    assert trial.throw is not None
    return trial.throw
