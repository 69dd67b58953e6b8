"""The bodies whose motion no integrator follows exactly.

What moves evenly with the driver comes out right to rounding however an engine steps: a link that
turns with it, a link of a parallelogram, a point on either. All else is off by what a step leaves
out, and the more, the further it is from moving evenly: from the driver's angle times a number for
links and sliders, from the ellipse that its pin could draw for points.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.motion import Motion
from models.scene import Scene
from reports.quantities.quantity import BodyKind

Series = dict[tuple[BodyKind, str], Array]
LEAST_SAMPLES = 8
LEAST_TURN_RAD = 0.2
"""Over less of a turn of the driver no error comes to its size."""
EVEN = 1e-3
"""A departure that is none: rounding is far below it, and errors that belong to it below those of
rounding."""


def uneven(scene: Scene, reference: Motion, driver_rad: Array) -> dict[tuple[BodyKind, str], float]:
    """How far each body departs from moving evenly with the driver, without those that do not:
    links in radians, sliders and points in longest links, 1 at most.

    ``driver_rad`` is the commanded angle of the driver at the samples of the reference, (T,).
    """
    if driver_rad.size < LEAST_SAMPLES or np.ptp(driver_rad) < LEAST_TURN_RAD:
        return {}
    ones, turn = np.ones_like(driver_rad), np.exp(1j * driver_rad)
    straight: Series = {("link", name): link.theta for name, link in reference.links.items()} | {
        ("slider", name): slider.displacement / scene.longest_m
        for name, slider in reference.sliders.items()
    }
    round_: Series = {
        ("point", name): (point.position[:, 0] + 1j * point.position[:, 1]) / scene.longest_m
        for name, point in reference.points.items()
    }
    far = {
        **_departures(straight, np.stack([ones, driver_rad - np.mean(driver_rad)], axis=-1)),
        **_departures(round_, np.stack([ones, turn, turn.conj()], axis=-1)),
    }
    return {body: min(size, 1.0) for body, size in far.items() if size > EVEN}


def unevenly_turned(
    scene: Scene, uneven: Mapping[tuple[BodyKind, str], float]
) -> frozenset[tuple[BodyKind, str]]:
    """Of the uneven bodies those whose rates are too: links, and what is carried by such a link or
    slides on it. What rides on links that all turn evenly has the right speed in an engine."""
    links = {name for kind, name in uneven if kind == "link"}
    carried = {point for name in links for point in scene.links[name].points}
    slides = {
        name
        for name, slider in scene.sliders.items()
        if slider.on in links or slider.link in links or slider.point in carried
    }
    turned: dict[BodyKind, set[str]] = {"link": links, "point": carried, "slider": slides}
    return frozenset(body for body in uneven if body[1] in turned[body[0]])


def _departures(series: Series, even: NDArray[np.inexact]) -> dict[tuple[BodyKind, str], float]:
    """The largest distance of each series (T,) from what the columns ``even`` (T, n) add up to."""
    moved = np.stack(list(series.values()), axis=-1)
    # The normal equations of two or three columns: a hundredth of the time of a decomposition.
    across = even.conj().T
    weights = np.linalg.solve(across @ even, across @ moved)
    return dict(zip(series, np.max(np.abs(moved - even @ weights), axis=0).tolist(), strict=True))
