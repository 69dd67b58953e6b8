"""Loads, springs with parallel dampers, and friction in joints."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene.characteristics import Characteristic

Over = Literal["time", "angle", "displacement", "speed", "omega"]
Stroke = Literal["both", "forward", "backward"]
UNITS: dict[str, str] = {
    "time": "s",
    "angle": "rad",
    "displacement": "m",
    "speed": "m/s",
    "omega": "rad/s",
}


@dataclass(frozen=True)
class Load:
    """A force at a point of a body, or a torque on it (``point`` is None).

    ``body`` is a link, or a slider's block (`models.scene.joints.block_name`). A force of positive
    magnitude points along ``direction_rad`` in the frame of the ``ground`` or of the ``body``; a
    positive torque is counter-clockwise. The magnitude, a `Characteristic`, is constant or follows
    time, the driver's angle, the displacement or the speed of ``slider``, or, over ``omega``, the
    angular velocity of ``body``: a motor pulls by its speed. The load may act on one stroke of
    ``slider`` only (a cutting tool works on the way out): ``forward`` is motion along its
    direction. Two loads at one point add up.
    """

    name: str
    body: str
    point: str | None
    characteristic: Characteristic
    over: Over = "time"
    slider: str | None = None
    stroke: Stroke = "both"
    direction_rad: float = 0.0
    frame: Literal["ground", "body"] = "ground"

    def magnitude(self, x: Array, speed: Array | None = None) -> Array:
        """Return the force [N] or the torque [N m].

        ``x`` are times [s], driver angles [rad], displacements of the slider [m], its speeds [m/s]
        or angular velocities of the body [rad/s], as ``over`` says; ``speed`` those of the slider
        [m/s], for a load on one stroke only. Raises CrankcheckError for ``x`` beyond the end of a
        table.
        """
        try:
            magnitude = self.characteristic.at(x)
        except ValueError as error:
            raise self._beyond(error) from None
        if self.stroke == "both" or speed is None:
            return magnitude
        return np.where(speed > 0.0 if self.stroke == "forward" else speed < 0.0, magnitude, 0.0)

    def size(
        self,
        time_s: float,
        driver_rad: float,
        sliders: Mapping[str, tuple[float, float]],
        omega_rad_s: float,
    ) -> float:
        """Return the magnitude in one state: the driver at an angle [rad], sliders at displacements
        [m] with speeds [m/s], the body at an angular velocity.

        A table over a displacement or a speed keeps its last value past its end: an engine whose
        slider moves too far is judged by its displacement.

        Raises CrankcheckError as `magnitude`, except for that.
        """
        displacement, speed = (0.0, 0.0) if self.slider is None else sliders[self.slider]
        near = self.characteristic.nearest(displacement)
        x = {
            "time": time_s,
            "angle": driver_rad,
            "displacement": near,
            "speed": self.characteristic.nearest(speed),
            "omega": self.characteristic.nearest(omega_rad_s),
        }[self.over]
        acts = self.stroke == "both" or (speed > 0.0 if self.stroke == "forward" else speed < 0.0)
        try:
            return self.characteristic.at_one(x) if acts else 0.0
        except ValueError as error:
            raise self._beyond(error) from None

    def _beyond(self, error: ValueError) -> CrankcheckError:
        return CrankcheckError(
            f"loads.{self.name}: over the {self.over} [{UNITS[self.over]}] {error}"
        )

    def uncertain(
        self, x: Array, by: Array | float, speed: Array | None, speed_by: Array | float
    ) -> Array:
        """Return a bound on the error of the magnitude, by the errors of ``x`` and the speed."""
        own = self.characteristic
        error = np.asarray(own.steepest(x, by) * by + own.rounding(x))
        if self.stroke == "both" or speed is None:
            return error
        turns = np.abs(speed) <= speed_by  # it may act or not
        return np.where(turns, error + np.abs(own.at(x)), error)


@dataclass(frozen=True)
class _Elastic:
    """Base of all springs: ``rate`` [N/m or N m/rad], ``damping`` [N s/m or N m s], and ``free``,
    the q [m or rad] at which it is slack.

    With q the distance of the points [m], the angle of the second body against the first [rad], or
    the displacement of the slider [m], a spring pulls q back with::

        rate (q - free) + damping q'                 [N], or [N m] in a pin

    and stores the energy rate (q - free)^2 / 2. A rate of 0 makes a damper, a damping of 0 a
    spring.
    """

    name: str
    rate: float
    damping: float
    free: float

    def pull(self, q: float, speed: float) -> float:
        """Return the force or torque that pulls q back [N or N m]."""
        return self.rate * (q - self.free) + self.damping * speed

    def energy(self, q: float) -> float:
        """Return the stored energy [J]."""
        return 0.5 * self.rate * (q - self.free) ** 2


@dataclass(frozen=True)
class LineSpring(_Elastic):
    """A spring between two named points. Each end is fixed to one body that has the point: to the
    ground, else to the first link in the order of the scene, else to a block."""

    points: tuple[str, str]


@dataclass(frozen=True)
class PinSpring(_Elastic):
    """A spring in a pin, between two of its bodies; q is the angle of the second less the angle of
    the first: at the start within half a turn of ``free``, and continuous from there."""

    point: str
    bodies: tuple[str, str]


@dataclass(frozen=True)
class SegmentSpring(PinSpring):
    """A spring in a pin between two segments of an elastic link (`models.scene.cut_scenes`)."""


@dataclass(frozen=True)
class SlideSpring(_Elastic):
    """A spring along the line of a slider, between the sliding body and the body with the line."""

    slider: str


Spring = LineSpring | PinSpring | SlideSpring


@dataclass(frozen=True)
class CoulombFriction:
    """Friction of ``mu`` times the normal force in the pin or slider ``joint``; in a pin it acts at
    ``radius_m`` [m] from its centre, in a slider ``radius_m`` is 0.

    A joint is named as in the scene's file: a slider by its own name, a pin by its point. If a
    slider has the name of its point, the name means the slider; a slider with another name leaves
    the point's name to the pin.
    """

    joint: str
    mu: float
    radius_m: float = 0.0

    @property
    def arm_m(self) -> float:
        """The radius of the friction circle [m]: the couple in a pin over its reaction.

        A pin with play touches its bore along one line. The reaction leans from the normal there by
        the angle of friction, atan(mu), and passes the centre at r sin(atan(mu)): mu r is larger by
        1/cos of that angle. A couple of mu' r times the reaction, as in run-in pins, needs mu =
        tan(asin(mu')).
        """
        return self.radius_m * self.mu / math.hypot(1.0, self.mu)


@dataclass(frozen=True)
class ConstantFriction:
    """Friction of ``size`` against the motion in the pin or slider ``joint``, independent of the
    reaction: a torque [N m] in a pin, a force [N] in a slider."""

    joint: str
    size: float


Friction = CoulombFriction | ConstantFriction
