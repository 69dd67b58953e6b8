"""Driver: free motion, speed held by a controller, and the coordinate of its joint over time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion, State
from models.scene import GROUND, Scene
from models.scene.characteristics import Characteristic, Polynomial
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating
from models.scene.loads import Load, Over

LONGEST_S = 1e6
"""Longest free motion [s]."""


def check_duration(name: str, until_s: float) -> None:
    """Refuse a duration [s] of free motion that is not in range. Raises CrankcheckError."""
    if not 0.0 < until_s <= LONGEST_S:  # or no number
        raise CrankcheckError(
            f"{name}: free for {until_s:g} s; give a time above 0, of at most {LONGEST_S:g} s"
        )


def check_within(scene: Scene, time_s: Array, until_s: float) -> None:
    """Refuse times [s] outside the integrated free motion. Raises CrankcheckError."""
    if time_s.min() < 0.0 or time_s.max() > until_s * (1.0 + 1e-12):
        raise CrankcheckError(
            f"{scene.name}: times from {time_s.min():g} to {time_s.max():g} s; its free motion "
            f"starts at 0, and is integrated up to {until_s:g} s"
        )


@dataclass(frozen=True)
class Released(Law):
    """A driver released at time 0 at an angle, with a speed, which may be 0.

    Its free motion follows from masses and forces (`analytic.free`), not from a law: `at` gives the
    tangent of the start, of which only time 0 belongs to the motion. Its "turn" is the duration
    ``duration_s`` of the free motion.
    """

    is_free: ClassVar[bool] = True
    start_rad: float
    speed_rad_s: float
    duration_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.duration_s > 0.0:
            raise ValueError(f"duration_s is {self.duration_s:g}: give a time above 0")

    @property
    def offset_rad(self) -> float:
        return abs(self.start_rad)

    @property
    def period_s(self) -> float:
        return self.duration_s

    @property
    def peak_speed_rad_s(self) -> float:
        """Speed at the start; from rest, one radian in the whole duration."""
        return abs(self.speed_rad_s) or 1.0 / self.duration_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        # From rest either way is as good to say on which branch it starts.
        theta = self.start_rad + (self.speed_rad_s or self.peak_speed_rad_s) * time_s
        return theta, np.full_like(theta, self.speed_rad_s), np.zeros_like(theta)

    def turned(self, angle_rad: float) -> Released:
        return replace(self, start_rad=self.start_rad + angle_rad)


TURNS = 10.0
"""Turns by its own law for which a driven mechanism moves freely by default."""


def let_go(scene: Scene, duration_s: float | None = None) -> Scene:
    """Return the scene with its driver released, at the angle and speed of its law at time 0, for a
    duration [s]; None keeps that of a released driver, and takes the time of 10 turns of a driver
    that follows a law."""
    law = scene.driver.law
    if isinstance(law, Released):
        return (
            scene if duration_s is None else _with_law(scene, replace(law, duration_s=duration_s))
        )
    theta, omega, _ = (float(each[0]) for each in law.at(np.zeros(1)))
    lasts_s = TURNS * law.period_s if duration_s is None else duration_s
    return _with_law(scene, Released(theta, omega, lasts_s))


def _with_law(scene: Scene, law: Law) -> Scene:
    return replace(scene, driver=replace(scene.driver, law=law))


@dataclass(frozen=True)
class Controlled(ConstantSpeed):
    """Set speed, and the gains kP [N m/rad] and kD [N m s/rad]. Raises ValueError for gains below
    0.

    The torque is the rigid mechanism's driving torque at that speed, less the driver's lead in
    angle and in speed times the gains of a controller::

        tau = tau_d(t) - kP (theta - theta_d(t)) - kD (theta' - theta_d')

    A rigid mechanism that starts on its course stays on it; with elastic links the driver yields,
    and takes energy out of their vibration. Source: Thesis on vibration of planar mechanisms with
    elastic links (2018), control of the crank.
    """

    kp_n_m_rad: float
    kd_n_m_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if min(self.kp_n_m_rad, self.kd_n_m_s) < 0.0:
            raise ValueError(
                f"kp_n_m_rad is {self.kp_n_m_rad:g} and kd_n_m_s {self.kd_n_m_s:g}: a controller "
                "brakes a driver that is ahead; give gains of 0 or more"
            )

    def loads(self, link: str, needed: Characteristic) -> Iterator[Load]:
        """Yield the controller's torque as loads on the released driver ``link``: over time the
        ``needed`` torque; and the gains, over time, over the driver's angle and over its angular
        velocity."""
        kp, kd, speed = self.kp_n_m_rad, self.kd_n_m_s, self.speed_rad_s
        parts: list[tuple[str, Over, Characteristic]] = [("needed", "time", needed)]
        if kp:
            parts += [
                ("asked", "time", Polynomial((kp * self.start_rad, kp * speed))),
                ("angle", "angle", Polynomial((0.0, -kp))),
            ]
        if kd:
            parts.append(("speed", "omega", Polynomial((kd * speed, -kd))))
        for name, over, characteristic in parts:
            yield Load(f"controller-{name}", link, None, characteristic, over)


Course = tuple[Array, Array, Array]
"""A coordinate [rad or m], its rate and its second rate, each (T,)."""


def driver_course(scene: Scene, motion: Motion) -> Course:
    """Return the driver's course: its angle, the angle of its link against its base, or the
    displacement of its slider. Raises KeyError where the motion lacks the bodies for it."""
    driver = scene.driver
    if driver.slider is not None:
        slider = motion.sliders[driver.slider]
        return slider.displacement, slider.speed, slider.acceleration
    link = motion.links[driver.link]
    if driver.base == GROUND:
        return link.theta, link.omega, link.alpha
    base = motion.links[driver.base]
    return link.theta - base.theta, link.omega - base.omega, link.alpha - base.alpha


def driver_place(scene: Scene, motion: Motion) -> Array | None:
    """Return the driver's coordinate [rad or m], (T,); None where the motion lacks it."""
    try:
        return driver_course(scene, motion)[0]
    except KeyError:
        return None


def driver_rates(scene: Scene, state: State) -> tuple[float, float]:
    """Return the rate and the second rate of the driver's coordinate in a state."""
    driver = scene.driver
    if driver.slider is not None:  # of which a state has no acceleration
        return state.speed[driver.slider], float(driver.law.at(np.array([state.time_s]))[2][0])
    omega, alpha = state.omega[driver.link], state.alpha[driver.link]
    if driver.base == GROUND:
        return omega, alpha
    return omega - state.omega[driver.base], alpha - state.alpha[driver.base]


def driver_place_in(scene: Scene, state: State) -> float:
    """Return the driver's coordinate in a state [rad or m]."""
    driver = scene.driver
    if driver.slider is not None:
        return state.displacement[driver.slider]
    return state.theta[driver.link] - (state.theta[driver.base] if driver.is_inner else 0.0)


def place_in_words(place: float, unit: str, degrees: str = ".6g") -> str:
    """Format a driver's coordinate [rad or m] by its ``unit``; angles by ``degrees``."""
    return f"{place:.6g} m" if unit == "m" else f"{math.degrees(place):{degrees}} deg"


def driver_unit(scene: Scene) -> str:
    """Return the unit of `driver_shown`: deg or m."""
    return "deg" if scene.driver.slider is None else "m"


def driver_axis(scene: Scene) -> str:
    """Return the label of an axis of `driver_shown`."""
    what = "angle" if scene.driver.slider is None else "place"
    return f"{what} of {scene.driver.joint} [{driver_unit(scene)}]"


def driver_shown(scene: Scene, motion: Motion) -> Array:
    """Return the driver's coordinate in a motion [deg or m], (T,). KeyError as `driver_course`."""
    place = driver_course(scene, motion)[0]
    return place if scene.driver.slider is not None else np.asarray(np.degrees(place))


def driver_stands(scene: Scene, motion: Motion, index: int) -> str:
    """Return the driver's position at a sample, as in "crank at 30 deg"."""
    value = float(driver_shown(scene, motion)[index])
    if scene.driver.slider is not None:
        return f"{scene.driver.joint} at {value:.3g} m"
    turns = not isinstance(scene.driver.law, Oscillating)
    return f"{scene.driver.joint} at {value % 360.0 if turns else value:.0f} deg"


ROUNDING = 1e-12
"""Rounding of a square: a rounded angle in degrees is still the end of a swing."""


def passing(
    law: Law, theta_rad: float, *, clockwise: bool = False, slides: bool = False
) -> tuple[float, float]:
    """Return the angular velocity [rad/s] and acceleration [rad/s^2] of the driver at an angle;
    where it ``slides``, speed [m/s] and acceleration [m/s^2] at a displacement [m].

    A start from rest is taken after its rise. Where the law passes an angle both ways, an
    oscillating driver is taken counter-clockwise and an accelerating driver at its first passage;
    ``clockwise`` takes the way of falling angle. A driver of constant speed is then turned round.

    Raises ValueError where the law does not reach that angle, or not that way; the message names a
    remedy.
    """
    if isinstance(law, Oscillating):
        return _swinging(law, theta_rad, clockwise=clockwise, slides=slides)
    if isinstance(law, Accelerating):
        return _accelerating(law, theta_rad, clockwise=clockwise, slides=slides)
    if isinstance(law, ConstantSpeed | FromRest):
        return -abs(law.speed_rad_s) if clockwise else law.speed_rad_s, 0.0
    raise ValueError("has a law without a speed at an angle; give --turns")


def _swinging(
    law: Oscillating, theta: float, *, clockwise: bool, slides: bool
) -> tuple[float, float]:
    swing = theta - law.centre_rad
    rest = law.amplitude_rad**2 - swing**2
    if rest < -ROUNDING * law.amplitude_rad**2:
        low, high = sorted(law.centre_rad + s * law.amplitude_rad for s in (-1.0, 1.0))
        if slides:
            raise ValueError(f"goes from {low:.6g} to {high:.6g} m; give a place between")
        low, high = math.degrees(low), math.degrees(high)
        raise ValueError(f"swings from {low:.6g} to {high:.6g} deg; give an angle between")
    frequency = abs(law.frequency_rad_s)
    omega = frequency * math.sqrt(max(rest, 0.0))
    return -omega if clockwise else omega, -(frequency**2) * swing


def _accelerating(
    law: Accelerating, theta: float, *, clockwise: bool, slides: bool
) -> tuple[float, float]:
    """Solve omega^2 = speed^2 + 2 alpha (theta - start), at a time that is not before 0."""
    start, alpha, turned = law.speed_rad_s, law.acceleration_rad_s2, theta - law.start_rad
    square = start**2 + 2.0 * alpha * turned
    size = math.sqrt(max(square, 0.0)) if turned else abs(start)
    times = {omega: (omega - start) / alpha for omega in (size, -size)}
    rounded = -ROUNDING * (start**2 + 2.0 * abs(alpha * turned))
    comes = [w for w, time_s in times.items() if square >= rounded and time_s >= 0.0]
    down = [w for w in comes if w < 0.0]
    if not comes and slides:
        raise ValueError(f"never gets there from {law.start_rad:g} m on")
    if not comes:
        way = math.copysign(math.tau, alpha)
        same = theta + way * math.ceil(-turned / way)
        raise ValueError(
            f"never gets there; it reaches the same driver angle at {math.degrees(same):.6g} deg"
        )
    if clockwise and not down:
        raise ValueError("does not turn clockwise there; leave out --clockwise")
    return min(down if clockwise else comes, key=times.__getitem__), alpha
