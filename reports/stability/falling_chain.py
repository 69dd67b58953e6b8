"""A chain of windows that is left free: its energy and its first pin against the closed form."""

from __future__ import annotations

import numpy as np

from analytic.free.window_chain import ChainMotion
from models.array import Array
from models.motion import Motion
from reports.compare.free.hard_runs import ChainErrors, compared
from reports.stability.case import Trial
from reports.stability.error_series import ErrorSeries, lacking, worst_of
from sim.engine import Run


def freely(trial: Trial, run: Run) -> ErrorSeries:
    """A free run beside the closed form of the chain.

    The error of place is the larger of the distance of B0 from its place, over a rod, and of the
    change of the energy, over what is exchanged in a turn.
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
    """The truth to be drawn."""
    assert trial.chain is not None
    return ChainMotion(trial.chain).motion(time_s)
