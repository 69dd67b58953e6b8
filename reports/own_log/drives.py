"""The drive of a log's reference: the scene's driver, or the driver's motion in the log."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from analytic.structure.mobility import refuse_other_than_cranked
from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.compare.compare import Truth
from reports.logs.channel import OwnLog, Reading, is_driver
from reports.logs.log_beside import MANY, AtCrank

LogDrive = Literal["scene", "fitted", "logged"]
"""The scene's law; a constant speed fitted to the log; or its angles, for geometry alone."""
STARTS = 24
"""Angles of the start that are tried, where the log lacks the driver's."""
FIRST = 400
"""Samples, all over the log, on which they are tried."""
FINALISTS = 6
"""Guesses that are followed to their least squares."""
STILL = 1e-6
"""Turn of a crank below which it stands still [rad]."""
EXPLAINED = 0.05
"""Largest root mean square of the residual of a fit [rad, longest links]."""
ROUNDS = 30
CLOSE = 1e-13
"""Negligible change of both parameters, as a share."""
NUDGE = 1e-6


@dataclass(frozen=True)
class DriveFit:
    """Speed [rad/s] and start angle [rad] of the driver by a log, and one standard error of each;
    ``by`` names the data of the fit. If it does not explain the log, no other speed that was tried
    did."""

    speed_rad_s: float
    start_rad: float
    speed_doubt: float
    start_doubt: float
    by: str
    explains: bool = True


def why_aside(drive: LogDrive, driver: str) -> str:
    """Return the reason why quantities in a log are not judged at the logged angle."""
    what = "--drive logged judges the geometry alone," if drive == "logged" else "the log is judged"
    return f"{what} at its angle of {driver}"


def truth_of_log(log: OwnLog, drive: LogDrive) -> tuple[Truth, DriveFit | None]:
    """Return the reference, and the fit of its drive. Raises CrankcheckError for a drive that the
    log, or the scene's law, does not allow; a crank that leaves its range."""
    links, points = _compared(log)
    if drive == "scene" and log.timed:
        return Truth(log.scene, links=links, points=points), None
    refuse_other_than_cranked(log.scene, f"--drive {drive}")
    crank = next((each for each in log.readings if is_driver(each.channel, log.scene)), None)
    if drive == "logged" or not log.timed:
        if drive != "logged":
            _refuse_without_times(log, drive)
        if crank is None or not np.array_equal(crank.instants, log.time_s):
            raise CrankcheckError(
                f"--drive logged: {log.source} has no angle of {log.scene.driver.link} at the "
                f"times of its rows; log {log.scene.driver.link}_rad, or use --drive fitted"
            )
        angle = _continuous(log, crank)
        truth = AtCrank(log.scene, links=links, points=points, time_s=log.time_s, crank_rad=angle)
        return replace(truth, with_rates=drive == "scene"), None
    if not isinstance(log.scene.driver.law, ConstantSpeed):
        raise CrankcheckError(
            f"--drive fitted: the driver of {log.scene.name} has no constant speed that could be "
            "fitted; use --drive scene, or --drive logged for the geometry alone"
        )
    fit = _of_crank(log, crank) if crank else _of_places(log)
    scene = moved(log.scene, fit.speed_rad_s, fit.start_rad)
    return Truth(scene, links=links, points=points), fit


def _refuse_without_times(log: OwnLog, drive: LogDrive) -> None:
    """Refuse a fit, and the rates of a driver without a constant speed. Raises CrankcheckError."""
    if drive == "fitted":
        raise CrankcheckError(
            f"--drive fitted: {log.source} has no column of times, which a speed needs; leave "
            "--drive out to judge it at its angles of the driver"
        )
    rates = [each.channel.column for each in log.readings if each.channel.kind.order]
    if rates and not isinstance(log.scene.driver.law, ConstantSpeed):
        raise CrankcheckError(
            f"{log.source} has no column of times, and the driver of {log.scene.name} no constant "
            f"speed: no rate is known for {few(map(cut, rates), 6)}; log the times, or judge the "
            "geometry alone with --drive logged"
        )


def _compared(log: OwnLog) -> tuple[tuple[str, ...] | None, tuple[str, ...]]:
    """Return the links, None for all, and the points for comparison: moving ones, and for a long
    log those in it, as the reference takes most of the memory."""
    scene = log.scene
    every = dict.fromkeys([*scene.pins, *(slider.point for slider in scene.sliders.values())])
    moving = tuple(name for name in every if name not in scene.ground)
    if log.time_s.size <= MANY:
        return None, moving
    channels = [reading.channel for reading in (*log.readings, *log.copies)]
    named = {
        scene.driver.link,
        scene.driver.base,
        *(c.of for c in channels),
        *(c.relative_to for c in channels),
    }
    links = tuple(name for name in scene.links if name in named)
    return links, tuple(name for name in moving if name in named)


def moved(scene: Scene, speed_rad_s: float, start_rad: float) -> Scene:
    """Return the scene with its driver at a constant speed from a start angle."""
    law = ConstantSpeed(start_rad=start_rad, speed_rad_s=speed_rad_s)
    return replace(scene, driver=replace(scene.driver, law=law))


def _continuous(log: OwnLog, crank: Reading) -> Array:
    """Return the angle of the crank, without the jumps of a wrapped one: it continues like the
    scene's driver, so that samples may be far apart."""
    if not crank.channel.wrapped:
        return crank.values
    if not log.timed:
        return np.unwrap(crank.values)
    led = log.scene.driver.law.at(crank.instants)[0]
    return np.asarray(led + np.unwrap(crank.values - led))


def _of_crank(log: OwnLog, crank: Reading) -> DriveFit:
    """Return speed and start by a straight line through the angles. Raises CrankcheckError."""
    time_s, angle = crank.instants, _continuous(log, crank)
    mean = float(np.mean(time_s))
    centred = time_s - mean
    square = float(centred @ centred)
    speed = float(centred @ (angle - np.mean(angle))) / square
    if abs(speed) * float(np.ptp(time_s)) < STILL:
        raise CrankcheckError(
            f"--drive fitted: {log.scene.driver.link} stands still in {log.source}, or goes round "
            "by whole turns between its rows; use --drive scene or logged"
        )
    start = float(np.mean(angle)) - speed * mean
    rest = angle - (start + speed * time_s)
    sigma = math.sqrt(float(rest @ rest) / max(angle.size - 2, 1))
    doubt = sigma / math.sqrt(square)
    at_start = sigma * math.sqrt(1.0 / angle.size + mean**2 / square)
    by = f"{angle.size} angles of the crank"
    return DriveFit(speed, _within_half_a_turn(start, log.scene), doubt, at_start, by)


def _within_half_a_turn(start_rad: float, scene: Scene) -> float:
    told = float(scene.driver.law.at(np.zeros(1))[0][0])
    return told + math.remainder(start_rad - told, math.tau)


def _of_places(log: OwnLog) -> DriveFit:
    """Return speed and start by least squares over all positions. Raises CrankcheckError."""
    places = [each for each in log.readings if each.channel.kind.order == 0]
    if not places:
        raise CrankcheckError(
            f"--drive fitted: {log.source} has only rates, and no places to fit to; use --drive "
            "scene"
        )
    law = log.scene.driver.law
    assert isinstance(law, ConstantSpeed)
    every = -(-log.time_s.size // FIRST)
    some = [replace(each, values=each.values[::every], instants=each.instants[::every])
            for each in places]  # fmt: skip
    turn = math.tau / STARTS
    tried = [(speed, law.start_rad + n * turn) for speed in speeds(some, law.speed_rad_s)
             for n in range(STARTS)]  # fmt: skip
    sizes = np.array([_size(_rest(log.scene, some, one)) for one in tried])
    if not np.isfinite(sizes).any():
        raise CrankcheckError(
            f"--drive fitted: {log.scene.name} can not be assembled over a turn of its driver; log "
            "the driver's angle, or use --drive scene"
        )
    fits = [_least(log.scene, some, tried[at]) for at in np.argsort(sizes)[:FINALISTS]]
    guess, _ = min(fits, key=lambda fit: _size(_rest(log.scene, some, fit[0])))
    best, doubts = _least(log.scene, places, guess)
    rest = _rest(log.scene, places, best)
    count = sum(each.values.size for each in places)
    channels = "a channel" if len(places) == 1 else f"{len(places)} channels"
    return DriveFit(
        best[0],
        _within_half_a_turn(best[1], log.scene),
        *doubts,
        f"{count} places of {channels}",
        explains=_size(rest) <= EXPLAINED**2 * count,
    )


def _least(
    scene: Scene, readings: Sequence[Reading], guess: tuple[float, float]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return speed and start of the least squares, by Gauss and Newton, with standard errors."""
    last_s = max(float(np.max(np.abs(each.instants))) for each in readings)
    steps = np.array([NUDGE / max(last_s, 1e-9), NUDGE])
    rest = _rest(scene, readings, guess)
    doubts = (math.nan, math.nan)
    for _ in range(ROUNDS):
        if rest is None:
            break
        columns = []
        for at in range(2):
            nudged = np.array(guess)
            nudged[at] += steps[at]
            other = _rest(scene, readings, (float(nudged[0]), float(nudged[1])))
            columns.append(np.zeros_like(rest) if other is None else (other - rest) / steps[at])
        slope = np.stack(columns, axis=-1)
        change, *_ = np.linalg.lstsq(slope, -rest, rcond=None)
        normal = np.linalg.pinv(slope.T @ slope)
        sigma = math.sqrt(float(rest @ rest) / max(rest.size - 2, 1))
        first, second = (sigma * math.sqrt(max(each, 0.0)) for each in np.diag(normal).tolist())
        doubts = first, second
        better = (guess[0] + float(change[0]), guess[1] + float(change[1]))
        after = _rest(scene, readings, better)
        if _size(after) > _size(rest):
            break
        small = abs(change[0]) <= CLOSE * abs(guess[0]) and abs(change[1]) <= CLOSE
        guess, rest = better, after
        if small:
            break
    return guess, doubts


def _rest(
    scene: Scene, readings: Sequence[Reading], parameters: tuple[float, float]
) -> Array | None:
    """Return all errors as pure numbers, one after the other; None if there is no such motion."""
    try:
        truth = Truth(moved(scene, *parameters), bound=False)
        return np.concatenate([
            each.error(truth) / (1.0 if each.channel.kind.turns else scene.longest_m)
            for each in readings
        ])  # fmt: skip
    except (CrankcheckError, ValueError):
        return None


def _size(rest: Array | None) -> float:
    return math.inf if rest is None else float(rest @ rest)


HARMONICS = 3
"""Harmonics of the motion of a linkage that show its period."""
BEST = 8
"""Number of candidate frequencies."""
APART = 0.1
"""Frequencies closer than this over the duration of the log count as one."""
MOST = 3000
"""Number of frequencies that are examined."""
FACTORS = (1.0, 0.5, 0.7, 1.5, 2.0)
"""Factors on the scene's own speed, where the log is too short to repeat."""


def speeds(readings: Sequence[Reading], usual_rad_s: float) -> list[float]:
    """Return speeds of both signs [rad/s]: of repeating readings, then near the scene's own."""
    usual = (abs(usual_rad_s * factor) for factor in FACTORS)
    chosen = dict.fromkeys([*_frequencies(readings), *usual])
    sign = math.copysign(1.0, usual_rad_s)
    return [side * each for each in chosen for side in (sign, -sign)]


def _frequencies(readings: Sequence[Reading]) -> list[float]:
    """Return the circular frequencies with the least residual of a few harmonics [rad/s]."""
    time_s = readings[0].instants
    lasts = float(np.ptp(time_s))
    fastest = math.pi / float(np.median(np.diff(time_s))) / 2.0
    slowest = math.tau / lasts
    if fastest <= slowest or time_s.size < 4 * HARMONICS:
        return []
    step = max(APART * math.tau / lasts, (fastest - slowest) / MOST)
    tried = np.arange(slowest, fastest, step)
    each_signal = [each for reading in readings for each in _signals(reading)]
    signals = np.stack(each_signal, axis=-1) if each_signal else np.zeros((time_s.size, 0))
    left = np.array([_left(time_s, signals, each) for each in tried])
    lows = np.flatnonzero(
        (left <= np.roll(left, 1)) & (left <= np.roll(left, -1)) & np.isfinite(left)
    )
    return [float(tried[at]) for at in lows[np.argsort(left[lows])][:BEST]]


def _signals(reading: Reading) -> list[Array]:
    """Return a reading as periodic numbers, each about its mean and of size 1."""
    kind = reading.channel.kind
    parts = [np.cos(reading.values), np.sin(reading.values)] if kind.turns else [reading.values]
    parts = [part - np.mean(part) for part in parts]
    return [part / size for part in parts if (size := float(np.sqrt(np.mean(part**2)))) > 0.0]


def _left(time_s: Array, signals: Array, frequency: float) -> float:
    """Return the residual of signals (T, n) after harmonics of a frequency."""
    if signals.shape[-1] == 0:
        return math.inf
    turns = frequency * np.outer(time_s - time_s[0], np.arange(1, HARMONICS + 1))
    waves = np.concatenate([np.ones((time_s.size, 1)), np.cos(turns), np.sin(turns)], axis=-1)
    # The normal equations: a tenth of the time of a decomposition, for a mere guess.
    normal = waves.T @ waves + 1e-9 * time_s.size * np.eye(waves.shape[-1])
    weights = np.linalg.solve(normal, waves.T @ signals)
    return float(np.sum((signals - waves @ weights) ** 2))
