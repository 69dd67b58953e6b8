"""Random four-bars with a crank, and the paths that their coupler points go along."""

from __future__ import annotations

import math

import numpy as np

from analytic.synthesis.path.candidate import Candidate
from analytic.synthesis.path.coupler_curve import CouplerCurve
from analytic.synthesis.path.task import PathTask
from models.array import Array

LEAST_TRANSMISSION = math.radians(15.0)
LARGEST = 10.0
"""Of a link, over the radius of the coupler curve, and of the points on it."""


def random_curve(rng: np.random.Generator) -> CouplerCurve:
    """A four-bar whose crank turns fully, with a transmission angle of 15 degrees or more and links
    that are no more than ten times as long as its curve is wide."""
    while True:
        a, b, c = np.exp(rng.uniform(math.log(0.1), math.log(5.0), 3)).tolist()
        angle, radius = rng.uniform(0.0, math.tau), 1.8 * math.sqrt(rng.random())
        arm = b * (0.5 + radius * complex(math.cos(angle), math.sin(angle)))
        one = CouplerCurve(0j, 1.0 + 0j, a, b, c, arm, 1 if rng.random() < 0.5 else -1)
        if one.family == "limited":
            continue
        turn = np.linspace(0.0, math.tau, 100)
        good = Candidate(one, turn, np.zeros(100)).least_sine > math.sin(LEAST_TRANSMISSION)
        if good and one.size < LARGEST * float(np.std(one.at(turn))):
            return one.moved(complex(*rng.normal(size=2)), complex(*rng.normal(size=2)))


def random_path(
    seed: int, count: int, *, timed: bool, closed: bool, noise: float = 0.0
) -> tuple[CouplerCurve, Array, PathTask]:
    """A four-bar, its crank's angles [rad], and the points it goes through there, each moved by a
    share of their spread; of links no longer than ten times the radius of these points."""
    rng = np.random.default_rng(seed)
    while True:
        one = random_curve(rng)
        span = math.tau * (1.0 - 1.0 / count) if closed else rng.uniform(1.0, 5.0)
        angles = rng.uniform(0.0, math.tau) + np.linspace(0.0, span, count)
        angles *= 1.0 if rng.random() < 0.5 else -1.0
        if one.size < LARGEST * float(np.std(one.at(angles))):
            break
    points = one.at(angles)
    off = rng.normal(size=count) + 1j * rng.normal(size=count)
    points += noise * np.std(points) * off
    crank = tuple((angles - 3.0).tolist()) if timed else None
    return one, angles, PathTask(tuple(points.tolist()), crank, closed)
