"""The energy of a free mechanism, and what loads, dampers and friction have put into it."""

from __future__ import annotations

import numpy as np

from analytic.free.coordinate_history import MOST, CoordinateHistory
from analytic.free.gauss import gauss, sums
from analytic.free.machine import Machine
from analytic.multibody.energy_balance import EnergyBalance
from models.array import Array
from models.scene import Scene


def history_energy(scene: Scene, history: CoordinateHistory, time_s: Array) -> EnergyBalance:
    """The energies of an integrated motion at times [s], (T,)."""
    u, v, _ = history.state(time_s)
    window = history.windows_at(time_s)
    series, before = _work(scene, history)
    share = (time_s - history.starts_s[window]) / np.array([w.long_s for w in history.windows])[
        window
    ]
    work = before[window] + sums(series[window], np.clip(share, 0.0, MOST))
    kinetic, potential = np.empty_like(u), np.empty_like(u)
    for chart, first, last in history.legs():
        at = (window >= first) & (window < last)
        if at.any():
            machine = Machine(scene, chart)
            wound = history.wound_at(window[at])
            kinetic[at] = machine.kinetic(u[at], v[at])
            potential[at] = machine.potential(u[at], wound)
    return EnergyBalance(kinetic, potential, np.asarray(work))


def _work(scene: Scene, history: CoordinateHistory) -> tuple[Array, Array]:
    """The series of the work in each window, and the work before it [J]."""
    n = history.windows[0].swing.shape[1]
    rule = gauss(n)
    long_s = np.array([window.long_s for window in history.windows])
    power = np.empty((len(long_s), n))
    for chart, first, last in history.legs():
        times = history.starts_s[first:last, None] + long_s[first:last, None] * rule.places
        numbers = np.repeat(np.arange(first, last), n)
        share = np.tile(rule.places, last - first)
        u, v, _ = history.at(numbers, share)
        power[first:last] = Machine(scene, chart).power(times.ravel(), u, v).reshape(-1, n)
    series = power @ rule.series.T @ rule.lift_once.T * long_s[:, None]
    lasts_s = np.array([window.end_s for window in history.windows]) - history.starts_s
    gained = sums(series, lasts_s / long_s)
    return series, np.concatenate([[0.0], np.cumsum(gained)[:-1]])
