"""The positions of a mechanism in one of its assemblies, between two limits of its driver."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.free.limit_position import LimitPosition
from analytic.kinematics import solve_driven
from analytic.prepared import Prepared, prepared
from analytic.reach import ranges
from models.array import Array
from models.errors import CrankcheckError
from models.released import Released
from models.scene import Scene

BEYOND = (1e-9, 1e-6, 1e-4, 1e-2)
"""How far beyond a limit is looked which dyad is open there [rad]."""


@dataclass(frozen=True, eq=False)
class Arc:
    """A scene in one assembly; ``limits`` of its driver's range, the lower one first, or none."""

    scene: Scene
    limits: tuple[LimitPosition, LimitPosition] | None

    @staticmethod
    def of(scene: Scene, driver_rad: float) -> Arc:
        """The arc on which the driver stands at an angle. Raises CrankcheckError where the
        mechanism cannot be assembled there, or its way ends at infinity."""
        ready = prepared(scene)
        spans = ranges(ready.stretched, ready.looked_turns)
        span = _range_about(spans, driver_rad)
        if span is None:
            ready.chunk(np.array([driver_rad]), 0.0, 0.0, None)  # says where it is open
            raise CrankcheckError(f"{scene.name}: no range of its driver holds {driver_rad:g} rad")
        low, high = span
        if spans == [(-math.pi, math.pi)] or (ready.looked_turns == 1 and high - low >= math.tau):
            return Arc(scene, None)
        return Arc(scene, (_limit(scene, span, -1), _limit(scene, span, 1)))

    @property
    def length_rad(self) -> float:
        """Of the driver's range."""
        assert self.limits is not None
        low, high = self.limits
        return high.driver_rad - low.driver_rad

    def nearest(self, driver_rad: float) -> LimitPosition | None:
        """The limit that is nearest to a driver angle."""
        if self.limits is None:
            return None
        return min(self.limits, key=lambda limit: abs(limit.driver_rad - driver_rad))

    def beyond(self, limit: LimitPosition) -> Arc:
        """The arc of the other assembly, into which the motion passes at one of the limits. Raises
        CrankcheckError where it is not to be told."""
        scene = self.scene
        if ready := prepared(scene).passages:
            raise CrankcheckError(
                f"{scene.name}: {scene.driver.link} passes a limit, at "
                f"{math.degrees(limit.driver_rad):.6g} deg, in a mechanism that has change points "
                f"too (of {', '.join(ready)}); only one of them is followed: change a length"
            )
        branch = {**scene.branch, limit.dyad: -scene.branch.get(limit.dyad, 1)}
        law = scene.driver.law
        assert isinstance(law, Released)

        def started(start_rad: float) -> Scene:
            driver = replace(scene.driver, law=replace(law, start_rad=start_rad))
            return replace(scene, branch=branch, driver=driver)

        span = _range_about(ranges(prepared(started(limit.driver_rad)).stretched), limit.driver_rad)
        assert span is not None
        return Arc.of(started(0.5 * sum(span)), 0.5 * sum(span))

    def link_angles(self, driver_rad: float) -> Mapping[str, float]:
        """The angles of all links at a driver angle, whole turns as `analytic.kinematics` counts
        them for this scene."""
        still = np.zeros(1)
        found = solve_driven(
            self.scene, np.array([driver_rad]), still, still, points=(), sliders=(), bound=False
        )
        return {name: float(link.theta[0]) for name, link in found.links.items()}


def _range_about(spans: list[tuple[float, float]], driver_rad: float) -> tuple[float, float] | None:
    """The range that holds an angle, but for rounding, moved by whole turns to it."""
    room = 1e-9
    for low, high in spans:
        turns = math.tau * math.ceil((driver_rad - high - room) / math.tau)
        if low + turns - room <= driver_rad:
            return low + turns, high + turns
    return None


def _limit(scene: Scene, span: tuple[float, float], side: int) -> LimitPosition:
    """The limit at one end of a range. Raises CrankcheckError where no dyad is stretched or folded
    there, or two are."""
    ready, driver_rad = prepared(scene), span[1] if side > 0 else span[0]
    beyond = driver_rad + side * np.array(BEYOND)
    shortages = ready.stretched(beyond).shortage
    at_limit = ready.stretched(np.array([driver_rad]))
    open_ = [key for key, value in shortages.items() if _is_open(value)]
    for key in open_[:1]:  # what hangs on it is open with it
        closure = at_limit.closures.get(key)
        if closure is not None and closure.root is not None:
            exact = _zero_of_root(ready, key, driver_rad, -side * 1e-3 * (span[1] - span[0]))
            return LimitPosition(scene, exact, side, key, span[1] - span[0])
    raise CrankcheckError(
        f"{scene.name}: the range of {scene.driver.link} ends at {math.degrees(driver_rad):.6g} "
        "deg, where no dyad is stretched or folded: its free motion is not followed there"
    )


def _zero_of_root(ready: Prepared, key: str, driver_rad: float, inwards_rad: float) -> float:
    """The driver angle at which the square of a dyad's root is 0, to rounding: a range ends where
    the dyad is open by more than that."""

    def square(theta: float) -> float:
        values = np.asarray(ready.stretched(np.array([theta])).closures[key].square)
        return float(values.ravel()[0])

    slope = (square(driver_rad + inwards_rad) - square(driver_rad)) / inwards_rad
    for _ in range(5):
        driver_rad -= square(driver_rad) / slope
    return driver_rad


def _is_open(short: Array) -> bool:
    """Whether a dyad is open at once beyond a limit."""
    values = np.broadcast_to(np.asarray(short), (len(BEYOND),))
    return bool(np.all(np.nan_to_num(values[1:], nan=1.0) > 0.0))
