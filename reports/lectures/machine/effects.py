"""Effects of dimensions on a link, a slider or a point over a period of the driver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.gradients.dimensions import Dimension, dimensions
from analytic.gradients.gradient import Gradient
from analytic.gradients.gradient import gradient as gradient_of
from models.array import Array
from models.errors import CrankcheckError, suggestion
from models.scene import GROUND, Scene
from models.scene.driver import driver_stands

SAMPLES = 361
"""Instants of a period, both ends included."""
NO_EFFECT = 1e-12
"""Change by rounding, over the largest one."""


def period_of(scene: Scene) -> Array:
    """Return instants of a period of the driver [s]."""
    return np.linspace(0.0, scene.driver.law.period_s, SAMPLES)


@dataclass(frozen=True)
class Effects:
    """Effect of dimensions on ``of`` over a period of the driver.

    ``slopes`` (P, T) are derivatives of an angle [rad] or a place [m] by each of ``dimensions``, in
    m or rad, not a number where none is certain; ``tolerances`` (P,) are in m or rad.
    """

    gradient: Gradient
    of: str
    turns: bool
    dimensions: Sequence[Dimension]
    slopes: Array
    tolerances: Array

    @property
    def unit(self) -> str:
        """Unit in tables: deg or mm."""
        return "deg" if self.turns else "mm"

    @property
    def scale(self) -> float:
        return math.degrees(1.0) if self.turns else 1e3

    @property
    def at_tolerance(self) -> Array:
        """Change by each dimension at its tolerance (P, T) [deg or mm]."""
        return np.asarray(self.scale * self.slopes * self.tolerances[:, None])

    def rows(self) -> list[dict[str, Any]]:
        """The dimensions that have an effect, the largest first, in the units of tables."""
        found, changes = [], self.at_tolerance
        least = NO_EFFECT * np.nanmax(np.abs(changes), initial=0.0)
        for one, series, tolerance in zip(self.dimensions, changes, self.tolerances, strict=True):
            size = np.abs(series)
            if not np.nanmax(size, initial=0.0) > least:
                continue
            at = int(np.nanargmax(size))
            scale = 1e3 if one.unit == "m" else math.degrees(1.0)
            found.append(
                {
                    "dimension": one.name,
                    "words": one.words,
                    "value": one.value * scale,
                    "unit": "mm" if one.unit == "m" else "deg",
                    "tolerance": tolerance * scale,
                    "largest": float(series[at]),
                    "at": driver_stands(self.gradient.scene, self.gradient.motion, at),
                    "rms": float(np.sqrt(np.nanmean(size**2))),
                    "of_1_percent": float(size[at] * 0.01 * abs(one.value) / tolerance)
                    if one.unit == "m"
                    else None,
                }
            )
        return sorted(found, key=lambda row: -abs(row["largest"]))


def effects(
    scene: Scene, of: str, by: Sequence[str], tolerance_m: float, tolerance_rad: float
) -> Effects:
    """Return the effects of some dimensions (none: all) on a link, a slider or a point ("": the
    follower), at tolerances. Raises CrankcheckError as `gradient`, and for an unknown name."""
    found, of = gradient_of(scene, period_of(scene), by or None), followed(scene, of)
    if not found.by:
        held = ", ".join(found.locked) or "nothing"
        raise CrankcheckError(f"{scene.name}: --by: {held} has no effect to show; name a dimension")
    slopes = np.array([_series(of, found, name) for name in found.by])
    known = [dimensions(scene)[name] for name in found.by]
    tolerances = np.array([tolerance_m if d.unit == "m" else tolerance_rad for d in known])
    return Effects(found, of, of in scene.links, known, slopes, tolerances)


def _series(of: str, found: Gradient, name: str) -> Array:
    """Return the derivative of an angle or a displacement, or the length of that of a place."""
    own = found.by[name]
    assert own.bound is not None
    if of in own.links:
        value, bound = own.links[of].theta, own.bound.links[of].theta
    elif of in own.sliders:
        value, bound = own.sliders[of].displacement, own.bound.sliders[of].displacement
    else:
        value, bound = np.hypot(*own.points[of].position.T), own.bound.points[of].position
    return np.where(np.isfinite(bound), value, np.nan)


def followed(scene: Scene, of: str) -> str:
    """Return a link, a slider or a point by its name, the follower for "". Raises CrankcheckError
    for an unknown name."""
    points = dict.fromkeys(point for own in scene.points_of.values() for point in own)
    names = (*scene.links, *scene.sliders, *points)
    of = of or _follower(scene)
    if of not in names:
        raise CrankcheckError(f"--of {of}: {suggestion(of, names, 'there are')}")
    return of


def _follower(scene: Scene) -> str:
    """Return the output of a mechanism: a slider on the ground, else a link that is pinned there,
    the last in its file; the last link where there is neither."""
    driver = scene.driver
    sliders = [n for n, one in scene.sliders.items() if one.on == GROUND and n != driver.slider]
    links = [n for n in scene.links if n != driver.link]
    pinned = [n for n in links if any(p in scene.ground for p in scene.links[n].points)]
    every: list[str] = [*(links or scene.links), *pinned, *sliders]
    return every[-1]
