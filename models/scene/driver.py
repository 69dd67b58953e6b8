"""The driver: let go, held to a speed by a torque, and the coordinate of its joint over time."""

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
"""For which a mechanism may be left free [s]."""


def check_duration(name: str, until_s: float) -> None:
    """Raises CrankcheckError for a time [s] for which the scene of a name cannot be left free."""
    if not 0.0 < until_s <= LONGEST_S:  # or no number
        raise CrankcheckError(
            f"{name}: free for {until_s:g} s; give a time above 0, of at most {LONGEST_S:g} s"
        )


def check_within(scene: Scene, time_s: Array, until_s: float) -> None:
    """Raises CrankcheckError for times [s] at which a motion that was let go is not known."""
    if time_s.min() < 0.0 or time_s.max() > until_s * (1.0 + 1e-12):
        raise CrankcheckError(
            f"{scene.name}: times from {time_s.min():g} to {time_s.max():g} s; it was let go at 0, "
            f"and integrated up to {until_s:g} s"
        )


@dataclass(frozen=True)
class Released(Law):
    """A driver that is let go at time 0 at an angle, with a speed, which may be 0.

    What it does then follows from masses and forces (`analytic.free`), and not from a law: `at`
    gives the tangent of the start, of which only time 0 belongs to the motion. Its "turn" is the
    time ``duration_s`` for which the scene is left free.
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
        """The speed of the start; of a start from rest, one radian in the whole duration."""
        return abs(self.speed_rad_s) or 1.0 / self.duration_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        # From rest either way is as good to say on which branch it starts.
        theta = self.start_rad + (self.speed_rad_s or self.peak_speed_rad_s) * time_s
        return theta, np.full_like(theta, self.speed_rad_s), np.zeros_like(theta)

    def turned(self, angle_rad: float) -> Released:
        return replace(self, start_rad=self.start_rad + angle_rad)


TURNS = 10.0
"""Of its own law, for which a driven mechanism is left free where nothing else is said."""


def let_go(scene: Scene, duration_s: float | None = None) -> Scene:
    """The scene with its driver let go, at the angle and with the speed that its law has at time 0.

    Parameters
    ----------
    duration_s : float or None
        For how long [s]; None for that of a scene whose driver is let go already, and for the time
        of 10 turns of a driver that follows a law.
    """
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
    """The speed that is asked for, and the gains kP [N m/rad] and kD [N m s/rad]. Raises ValueError
    for gains below 0.

    The torque is what the rigid mechanism needs at that speed, less what the driver is ahead of it,
    in angle and in speed, times the gains of a controller::

        tau = tau_d(t) - kP (theta - theta_d(t)) - kD (theta' - theta_d')

    A rigid mechanism that starts on its way keeps to it; with elastic links the driver gives way,
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
                "drives back what is ahead; give gains of 0 or more"
            )

    def loads(self, link: str, needed: Characteristic) -> Iterator[Load]:
        """The torque of the controller as loads on the driver, ``link``, that is let go: over time
        what is ``needed``; and the gains, over time, over the driver's angle and over its angular
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
    """What the driver did: its angle, the angle of its link against its base, or the displacement
    of its slider. KeyError where the motion has not what that is worked out of."""
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
    """The driver's coordinate [rad or m], (T,); None where the motion does not tell it."""
    try:
        return driver_course(scene, motion)[0]
    except KeyError:
        return None


def driver_rates(scene: Scene, state: State) -> tuple[float, float]:
    """The rate and the second rate of the driver's coordinate in a state."""
    driver = scene.driver
    if driver.slider is not None:  # of which a state has no acceleration
        return state.speed[driver.slider], float(driver.law.at(np.array([state.time_s]))[2][0])
    omega, alpha = state.omega[driver.link], state.alpha[driver.link]
    if driver.base == GROUND:
        return omega, alpha
    return omega - state.omega[driver.base], alpha - state.alpha[driver.base]


def driver_place_in(scene: Scene, state: State) -> float:
    """The driver's coordinate in a state [rad or m]."""
    driver = scene.driver
    if driver.slider is not None:
        return state.displacement[driver.slider]
    return state.theta[driver.link] - (state.theta[driver.base] if driver.is_inner else 0.0)


def place_in_words(place: float, unit: str, degrees: str = ".6g") -> str:
    """A driver's coordinate [rad or m] as it is told, by its ``unit``; angles formatted so."""
    return f"{place:.6g} m" if unit == "m" else f"{math.degrees(place):{degrees}} deg"


def driver_unit(scene: Scene) -> str:
    """Of `driver_shown`: deg or m."""
    return "deg" if scene.driver.slider is None else "m"


def driver_axis(scene: Scene) -> str:
    """What stands along an axis of `driver_shown`."""
    what = "angle" if scene.driver.slider is None else "place"
    return f"{what} of {scene.driver.joint} [{driver_unit(scene)}]"


def driver_shown(scene: Scene, motion: Motion) -> Array:
    """The driver's coordinate over a motion [deg or m], (T,). KeyError as `driver_course`."""
    place = driver_course(scene, motion)[0]
    return place if scene.driver.slider is not None else np.asarray(np.degrees(place))


def driver_stands(scene: Scene, motion: Motion, index: int) -> str:
    """Where the driver is at a sample, as in "crank at 30 deg"."""
    value = float(driver_shown(scene, motion)[index])
    if scene.driver.slider is not None:
        return f"{scene.driver.joint} at {value:.3g} m"
    turns = not isinstance(scene.driver.law, Oscillating)
    return f"{scene.driver.joint} at {value % 360.0 if turns else value:.0f} deg"


ROUNDING = 1e-12
"""Of a square: an angle in degrees that is rounded is still the end of a swing."""


def passing(
    law: Law, theta_rad: float, *, clockwise: bool = False, slides: bool = False
) -> tuple[float, float]:
    """Angular velocity [rad/s] and acceleration [rad/s^2] of the driver at an angle; where it
    ``slides``, speed [m/s] and acceleration [m/s^2] at a displacement [m].

    A start from rest is taken after its rise. Where the law passes an angle both ways, an
    oscillating one is taken counter-clockwise and an accelerating one for the first time;
    ``clockwise`` takes the way of falling angle. A driver of one speed is then turned round.

    Raises
    ------
    ValueError
        The law does not come to that angle, or not that way; the message names what would do.
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
    """From omega^2 = speed^2 + 2 alpha (theta - start), at a time that is not before 0."""
    start, alpha, turned = law.speed_rad_s, law.acceleration_rad_s2, theta - law.start_rad
    square = start**2 + 2.0 * alpha * turned
    size = math.sqrt(max(square, 0.0)) if turned else abs(start)
    times = {omega: (omega - start) / alpha for omega in (size, -size)}
    rounded = -ROUNDING * (start**2 + 2.0 * abs(alpha * turned))
    comes = [w for w, time_s in times.items() if square >= rounded and time_s >= 0.0]
    down = [w for w in comes if w < 0.0]
    if not comes and slides:
        raise ValueError(f"never comes there from {law.start_rad:g} m on")
    if not comes:
        way = math.copysign(math.tau, alpha)
        same = theta + way * math.ceil(-turned / way)
        raise ValueError(
            f"never comes there; it comes to the same driver angle at {math.degrees(same):.6g} deg"
        )
    if clockwise and not down:
        raise ValueError("does not turn clockwise there; leave out --clockwise")
    return min(down if clockwise else comes, key=times.__getitem__), alpha
