"""Singular positions: where the driver's angle no longer determines the motion."""

from __future__ import annotations

import math

import numpy as np

from analytic.kinematics import solve_driven
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.series import Array

SINGULAR = 1e-6
"""A sine of a transmission angle below which velocities are lost: rounding is over its square."""
GRID = 721
ZOOMS = 5
FINER = 65
"""Looks at a range, and at the neighbourhood of every smallest sine in each zoom."""
SHOWN = 4


def refuse_singular(scene: Scene, duration_s: float) -> None:
    """Refuse a run through a position in which the motion is not determined.

    The sine of a dyad falls and rises like the letter V there, mostly between two samples: its
    smallest values over the driver's range are looked for, and refined.

    Raises
    ------
    CrankcheckError
        Scene, driver angle and dyad. Also a ReachError, for an angle that cannot be reached.
    """
    low, high = _range(scene, duration_s)
    theta = np.linspace(low, high, GRID)
    for key, sine in _sines(scene, theta).items():
        places = theta[_valleys(sine)]
        smallest = np.full_like(places, np.inf)
        width = (high - low) / (GRID - 1)
        for _ in range(ZOOMS if places.size else 0):
            near = np.clip(places[:, None] + np.linspace(-width, width, FINER), low, high)
            sines = _sines(scene, near.ravel())[key].reshape(near.shape)
            best = np.arange(len(near)), np.argmin(sines, axis=1)
            places, smallest = near[best], sines[best]
            width *= 2.0 / (FINER - 1)
        lost = places[smallest < SINGULAR]
        if lost.size:
            raise CrankcheckError(
                f"{scene.name}: at driver {math.degrees(float(lost[0])):.6g} deg the dyad of {key} "
                "is singular: the motion is not determined there, and no engine can be held to "
                "it; choose lengths, or a range of the driver, away from it"
            )


def singular_note(scene: Scene, motion: Motion) -> str:
    """Which samples of a reference are singular, for the reader of a table; "" where none is."""
    driver = np.degrees(motion.links[scene.driver.link].theta)
    places = [
        f"{angle:.6g} deg ({key})"
        for key, sine in motion.conditioning.items()
        for angle in driver[np.abs(sine) < SINGULAR]
    ]
    if not places:
        return ""
    more = f" and {len(places) - SHOWN} more" if len(places) > SHOWN else ""
    return f"singular at {', '.join(places[:SHOWN])}{more}: rates are not determined there"


def _range(scene: Scene, duration_s: float) -> tuple[float, float]:
    """The driver angles of a run, a whole turn at most [rad]."""
    theta = scene.driver.law.at(np.linspace(0.0, duration_s, GRID))[0]
    low = float(np.min(theta))
    return low, min(float(np.max(theta)), low + math.tau)


def _sines(scene: Scene, theta: Array) -> dict[str, Array]:
    """The sine of every dyad at driver angles."""
    one, zero = np.ones_like(theta), np.zeros_like(theta)
    motion = solve_driven(scene, theta, one, zero, links=(), points=(), sliders=(), bound=False)
    return {key: np.abs(sine) for key, sine in motion.conditioning.items()}


def _valleys(sine: Array) -> Array:
    """Where a series is no larger than its neighbours and smaller than one of them, (T,) bool."""
    before = np.concatenate([[np.inf], sine[:-1]])
    after = np.concatenate([sine[1:], [np.inf]])
    return np.asarray((sine <= before) & (sine <= after) & ((sine < before) | (sine < after)))
