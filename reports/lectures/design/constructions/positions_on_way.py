"""Where on the way of a mechanism its precision positions are."""

from __future__ import annotations

import math

import numpy as np

from models.array import Array
from models.motion import Motion
from reports.lectures.design.constructions.construction_view import ConstructionView

TOUCHED = 1e-3
"""A driver that turns back this near to a position [rad] is in it."""


def positions_on_way(view: ConstructionView, motion: Motion) -> list[float | None]:
    """The samples at which a motion first goes through the precision positions, parts of samples
    counted; None of a position on another branch, and of one that the driver does not reach."""
    scene = view.examined.scene
    theta = motion.links[scene.driver.link].theta
    return [
        _first(theta, position.driver_rad)
        if placed is not None and placed.scene.branch == scene.branch
        else None
        for position, placed in zip(view.examined.positions, view.placements, strict=True)
    ]


def _first(theta: Array, angle: float) -> float | None:
    """Where angles (T,) first pass one, whole turns apart."""
    off = (theta - angle + math.pi) % math.tau - math.pi
    if abs(off[0]) < TOUCHED:
        return 0.0
    before, after = off[:-1], off[1:]
    passes = (before * after <= 0.0) & (np.abs(after - before) < math.pi)
    if passes.any():
        k = int(np.argmax(passes))
        return k + float(before[k] / (before[k] - after[k]))
    nearest = int(np.argmin(np.abs(off)))
    return float(nearest) if abs(off[nearest]) < TOUCHED else None
