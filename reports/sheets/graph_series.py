"""What graphs are drawn of: an angle, a displacement or a coordinate, with its exact rates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError, suggestion
from models.motion import Motion
from models.scene import Scene

AXES = {"x": 0, "y": 1}


@dataclass(frozen=True)
class GraphSeries:
    """A quantity over time [s], (n,): its value, rate and second rate, with symbols and units."""

    name: str
    time_s: Array
    values: tuple[Array, Array, Array]
    symbols: tuple[str, str, str]
    units: tuple[str, str, str]


def graph_series(scene: Scene, name: str, time_s: Array) -> GraphSeries:
    """The quantity ``name`` of a scene: a link (its angle), a slider (its displacement), or a
    coordinate of a point (C.x). Raises CrankcheckError for what the scene has not."""
    return series_of(scene, name, solve(scene, time_s, bound=False))


def series_of(scene: Scene, name: str, motion: Motion) -> GraphSeries:
    """As `graph_series`, of a motion."""
    point, _, axis = name.partition(".")
    if name in motion.links:
        link = motion.links[name]
        values = link.theta, link.omega, link.alpha
        return GraphSeries(
            name, motion.time_s, values, ("phi", "omega", "epsilon"), ("rad", "rad/s", "rad/s²")
        )
    if name in motion.sliders:
        slider = motion.sliders[name]
        values = slider.displacement, slider.speed, slider.acceleration
    elif point in motion.points and axis in AXES:
        at, k = motion.points[point], AXES[axis]
        values = at.position[:, k], at.velocity[:, k], at.acceleration[:, k]
    else:
        known = [*motion.links, *motion.sliders, *(f"{p}.{a}" for p in motion.points for a in AXES)]
        raise CrankcheckError(f"--of {name}: {suggestion(name, known, 'there are')}")
    return GraphSeries(name, motion.time_s, values, ("s", "v", "a"), ("m", "m/s", "m/s²"))


def sampled(scene: Scene, name: str, divisions: int, dense: int) -> tuple[GraphSeries, GraphSeries]:
    """The quantity at the ends of equal parts of the driver's period, and closely."""
    period = scene.driver.law.period_s
    return (
        graph_series(scene, name, np.linspace(0.0, period, divisions + 1)),
        graph_series(scene, name, np.linspace(0.0, period, dense)),
    )
