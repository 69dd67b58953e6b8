"""The speeds that a driver may have had, seen from how places come back."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from models.array import Array
from reports.logs.channel import Reading

HARMONICS = 3
"""Of the motion of a linkage, which tell its period."""
BEST = 8
"""Frequencies that come into question."""
APART = 0.1
"""Neighbours of a frequency that are less than this over the time of the log away are that one."""
MOST = 3000
"""Frequencies that are looked at."""
FACTORS = (1.0, 0.5, 0.7, 1.5, 2.0)
"""Of the scene's own speed, where the log is too short to come back."""


def speeds(readings: Sequence[Reading], usual_rad_s: float) -> list[float]:
    """Speeds of both signs [rad/s], those that repeat the readings best first, then some near the
    scene's own."""
    found = [usual_rad_s * factor for factor in FACTORS]
    periodic = _frequencies(readings)
    chosen = dict.fromkeys([*periodic, *(abs(each) for each in found)])
    sign = math.copysign(1.0, usual_rad_s)
    return [side * each for each in chosen for side in (sign, -sign)]


def _frequencies(readings: Sequence[Reading]) -> list[float]:
    """The circular frequencies of a few harmonics that leave least of the readings [rad/s]."""
    time_s = readings[0].instants
    lasts = float(np.ptp(time_s))
    fastest = math.pi / float(np.median(np.diff(time_s))) / 2.0
    slowest = math.tau / lasts
    if fastest <= slowest or time_s.size < 4 * HARMONICS:
        return []
    step = max(APART * math.tau / lasts, (fastest - slowest) / MOST)
    tried = np.arange(slowest, fastest, step)
    signals = _stacked(readings)
    left = np.array([_left(time_s, signals, each) for each in tried])
    lows = np.flatnonzero(
        (left <= np.roll(left, 1)) & (left <= np.roll(left, -1)) & np.isfinite(left)
    )
    return [float(tried[at]) for at in lows[np.argsort(left[lows])][:BEST]]


def _stacked(readings: Sequence[Reading]) -> Array:
    """The signals of all readings, (T, n)."""
    every = [each for reading in readings for each in _signals(reading)]
    return np.stack(every, axis=-1) if every else np.zeros((readings[0].values.size, 0))


def _signals(reading: Reading) -> list[Array]:
    """A reading as numbers that come back, each about its mean and of size 1."""
    kind = reading.channel.kind
    parts = [np.cos(reading.values), np.sin(reading.values)] if kind.turns else [reading.values]
    parts = [part - np.mean(part) for part in parts]
    return [part / size for part in parts if (size := float(np.sqrt(np.mean(part**2)))) > 0.0]


def _left(time_s: Array, signals: Array, frequency: float) -> float:
    """What harmonics of a frequency leave of signals (T, n)."""
    if signals.shape[-1] == 0:
        return math.inf
    turns = frequency * np.outer(time_s - time_s[0], np.arange(1, HARMONICS + 1))
    waves = np.concatenate([np.ones((time_s.size, 1)), np.cos(turns), np.sin(turns)], axis=-1)
    # The normal equations: a tenth of the time of a decomposition, for what is only a guess.
    normal = waves.T @ waves + 1e-9 * time_s.size * np.eye(waves.shape[-1])
    weights = np.linalg.solve(normal, waves.T @ signals)
    return float(np.sum((signals - waves @ weights) ** 2))
