"""The equation of the driver: the coordinate of the joint that is driven, over the bodies' own."""

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.scene import GROUND, Point, Scene
from models.scene.joints import local_point, turned


@dataclass(frozen=True)
class _Frame:
    """A body at given coordinates, with rates if it has any."""

    x: float
    y: float
    theta: float
    rates: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def place(self, local: Point) -> tuple[Array, Array, Array]:
        """A point of the body, its arm turned by +90 deg (its derivative by the angle), and its
        velocity."""
        arm = np.array(turned(local, self.theta))
        across = np.array([-arm[1], arm[0]])
        drift = np.array(self.rates[:2]) + self.rates[2] * across
        return np.array([self.x, self.y]) + arm, across, drift


@dataclass(frozen=True)
class DriverRow:
    """The driver's coordinate [rad or m] as a function of q, where each body's coordinates are
    ``at`` their places."""

    scene: Scene
    at: dict[str, int]

    def _frame(self, body: str, q: Array, rates: Array | None = None) -> _Frame:
        if body == GROUND:
            return _Frame(0.0, 0.0, 0.0)
        i = self.at[body]
        own = (0.0, 0.0, 0.0) if rates is None else tuple(float(r) for r in rates[i : i + 3])
        return _Frame(float(q[i]), float(q[i + 1]), float(q[i + 2]), (own[0], own[1], own[2]))

    def off(self, q: Array, wanted: float) -> float:
        """The coordinate less what it should be; of two moving links but for whole turns."""
        driver = self.scene.driver
        if driver.slider is not None:
            along, away, *_ = self._line(q, None)
            return float(along @ away) - wanted
        if driver.base == GROUND:
            return float(q[self.at[driver.link] + 2]) - wanted
        off = self._frame(driver.link, q).theta - self._frame(driver.base, q).theta - wanted
        return math.remainder(off, math.tau)

    def gradient(self, q: Array) -> Array:
        """Its derivatives by the coordinates (n,)."""
        driver, row = self.scene.driver, np.zeros(len(q))
        if driver.slider is None:
            row[self.at[driver.link] + 2] = 1.0
            if driver.base != GROUND:
                row[self.at[driver.base] + 2] = -1.0
            return row
        along, away, (tip, foot), _, _ = self._line(q, None)
        for body, across, sign in ((driver.link, tip, 1.0), (driver.base, foot, -1.0)):
            if body != GROUND:
                i = self.at[body]
                row[i : i + 2] += sign * along
                row[i + 2] += sign * float(along @ across)
        if driver.base != GROUND:
            row[self.at[driver.base] + 2] += float(np.array([-along[1], along[0]]) @ away)
        return row

    def quadratic(self, q: Array, rates: Array) -> float:
        """Its second derivative by time where the second rates of the coordinates are 0."""
        if self.scene.driver.slider is None:
            return 0.0
        along, away, (tip, foot), drift, (turning, carried) = self._line(q, rates)
        across = np.array([-along[1], along[0]])
        # The arms are pulled in; the line turns with what carries it.
        pull = turning**2 * np.array([-tip[1], tip[0]]) - carried**2 * np.array([-foot[1], foot[0]])
        return float(along @ pull + 2.0 * carried * (across @ drift) - carried**2 * (along @ away))

    def _line(
        self, q: Array, rates: Array | None
    ) -> tuple[Array, Array, tuple[Array, Array], Array, tuple[float, float]]:
        """The line's direction; the slider's point from the line's, their turned arms, how fast
        that goes, and how fast both bodies turn."""
        driver = self.scene.driver
        assert driver.slider is not None
        slider = self.scene.sliders[driver.slider]
        body, on = self._frame(driver.link, q, rates), self._frame(driver.base, q, rates)
        tip = body.place(local_point(self.scene, driver.link, slider.point))
        foot = on.place(slider.through_m)
        angle = on.theta + slider.direction_rad
        along = np.array([math.cos(angle), math.sin(angle)])
        turning = body.rates[2], on.rates[2]
        return along, tip[0] - foot[0], (tip[1], foot[1]), tip[2] - foot[2], turning
