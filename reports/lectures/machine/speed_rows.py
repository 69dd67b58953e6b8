"""What is told of vibration over speeds: critical speeds, unstable ones, the map over inertia."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.lectures.vibration.over_inertia import InertiaMap
from analytic.lectures.vibration.over_speeds import HIGHEST, OverSpeeds
from reports.output.numbers import readable

MOST_ROWS = 12
"""Critical speeds on a terminal; files hold all."""


@dataclass(frozen=True)
class Unstable:
    """Speeds next to each other at which the motion is unstable [rad/s], and the largest
    multiplier in them."""

    low_rad_s: float
    high_rad_s: float
    multiplier: float


def unstable_speeds(over: OverSpeeds) -> list[Unstable]:
    """Where deviations grow."""
    found, own = [], list[tuple[float, float]]()
    for point in over.points:
        if point.stability.is_stable:
            found += list(_run(own))
            own = []
        else:
            own.append((point.speed_rad_s, point.stability.largest))
    return found + list(_run(own))


def _run(own: list[tuple[float, float]]) -> Iterator[Unstable]:
    if own:
        yield Unstable(own[0][0], own[-1][0], max(size for _, size in own))


def heading(over: OverSpeeds) -> str:
    low, high = over.points[0], over.points[-1]
    return (
        f"{over.scene.name}: steady vibration at {len(over.points)} speeds of "
        f"{over.scene.driver.link} from {low.speed_rad_s:.6g} to {high.speed_rad_s:.6g} rad/s, "
        f"frequency ratio {low.ratio:.4g} to {high.ratio:.4g}"
    )


def notes(over: OverSpeeds) -> list[str]:
    """What there is to know of them."""
    told = [
        f"Unstable from {each.low_rad_s:.6g} to {each.high_rad_s:.6g} rad/s: a turn multiplies "
        f"deviations by up to {readable(each.multiplier)}."
        for each in unstable_speeds(over)
    ] or ["At none of these speeds deviations grow."]
    told.append(
        f"Critical speeds: a mode vibrates at a whole order, up to {HIGHEST}, that the driver "
        "excites; within the band the motion hangs on the stiffness too much to be told. By "
        "equations linear in the deflection, with the stiffness that pull gives."
    )
    return told


def map_heading(found: InertiaMap) -> str:
    low, high = found.factors[0], found.factors[-1]
    return (
        f"{found.scene.name}: steady vibration with {found.link} {low:g} to {high:g} times as "
        f"heavy, at {len(found.speeds)} speeds from {found.speeds[0]:.6g} to "
        f"{found.speeds[-1]:.6g} rad/s"
    )


@dataclass(frozen=True)
class InertiaRow:
    """With a link so many times as heavy: the median over the speeds of the largest deflection over
    the length, the largest multiplier with the speed at which it is [rad/s], and at how many speeds
    the motion is unstable."""

    factor: float
    share: float
    multiplier: float
    at_rad_s: float
    unstable: int


def inertia_rows(found: InertiaMap) -> list[InertiaRow]:
    rows = []
    for factor, over in zip(found.factors, found.over, strict=True):
        worst = max(over.points, key=lambda point: point.stability.largest)
        rows.append(
            InertiaRow(
                float(factor),
                float(np.median([point.share for point in over.points])),
                worst.stability.largest,
                worst.speed_rad_s,
                sum(not point.stability.is_stable for point in over.points),
            )
        )
    return rows
