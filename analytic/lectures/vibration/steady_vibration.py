"""Vibration of elastic links under a driver of constant speed: natural frequencies, the periodic
motion, the linear theories for comparison, its stability.

At the same angles of the driver M does not change with its speed, C and K and h are polynomials of
it, of the second degree where no load depends on speeds otherwise. So the equations at hundreds of
speeds follow from those at three, checked at a fourth.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.elastic import periodic
from analytic.elastic.discretisation import Discretisation, Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.natural import NaturalModes, natural_modes
from analytic.elastic.reduced import ReducedForm
from analytic.lectures.vibration.floquet import Stability, stability_of
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.laws import ConstantSpeed

INSTANTS = 65
"""Instants of a turn: orders up to half as many are distinct."""
SAME = 1e-6
"""Error of the polynomials at another speed than their own, over the largest entry."""
PARTS = ("mass", "damping", "stiffness", "force")


def at_speed(scene: Scene, speed_rad_s: float) -> Scene:
    """Return the scene with its driver at another speed, in its own sense of rotation. Raises
    CrankcheckError where the scene is not driven at a constant speed."""
    law = scene.driver.law
    if not isinstance(law, ConstantSpeed):
        raise CrankcheckError(
            f"{scene.name}: vibration over speeds is that of a driver at a constant one; found "
            'another law of motion: use [driver] law = "constant", with speed_rad_s'
        )
    speed = math.copysign(speed_rad_s, law.speed_rad_s)
    return replace(scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=speed)))


@dataclass(frozen=True)
class AnySpeed:
    """Scene with elastic links at speeds from ``slowest`` to ``fastest`` [rad/s], both above 0."""

    scene: Scene
    by: Discretisation
    slowest: float
    fastest: float
    stiffened: bool = True

    def form(self, speed_rad_s: float) -> ReducedForm:
        """Return the equations of motion at a speed."""
        scene = at_speed(self.scene, speed_rad_s)
        return DrivenElasticMotion(scene, 1.0, self.by, "periodic", self.stiffened).form

    def linear(self, speed_rad_s: float) -> periodic.LinearForm:
        """Return the linearised equations at a speed."""
        if self._series is None:
            return self._direct(speed_rad_s)
        return self._summed(self._series, speed_rad_s)

    def still(self) -> tuple[Array, Array]:
        """Return M and K (N, m, m) with the driver held still at the same angles: without the
        effect of its turning."""
        some = self.linear(self.slowest)
        if self._series is not None:
            return some.mass, self._series["stiffness"][0]
        return some.mass, np.broadcast_to(self.form(self.slowest).stiffness, some.mass.shape)

    @cached_property
    def _series(self) -> Mapping[str, Array] | None:
        """Coefficients of the polynomials (3, N, ...), or None where these do not hold."""
        low, high = self.slowest, self.fastest
        if high - low < 0.2 * high:  # too near each other to make polynomials of
            low, high = 0.8 * high, 1.2 * high
        speeds = np.linspace(low, high, 3)
        forms = [self._direct(speed) for speed in speeds]
        inverse = np.linalg.inv(np.vander(speeds / high, 3, increasing=True))
        to_powers = (high ** -np.arange(3.0))[:, None] * inverse
        series = {
            part: np.tensordot(to_powers, np.stack([vars(each)[part] for each in forms]), 1)
            for part in PARTS
        }
        between = low + 0.3 * (high - low)
        off = apart(self._summed(series, between), self._direct(between))
        return None if off > SAME else series

    def _direct(self, speed: float) -> periodic.LinearForm:
        form = self.form(speed)
        periodic.check_periodic(form)
        time_s = periodic.instants(INSTANTS, form.period_s)
        return periodic.linearise(form, time_s, periodic.FIRST * self.scene.longest_m)

    def _summed(self, series: Mapping[str, Array], speed: float) -> periodic.LinearForm:
        powers = speed ** np.arange(3.0)
        parts = {part: np.tensordot(powers, series[part], 1) for part in PARTS}
        return periodic.LinearForm(periodic.instants(INSTANTS, math.tau / speed), **parts)


def apart(one: periodic.LinearForm, other: periodic.LinearForm) -> float:
    """Return the difference of linearised equations, each part over its largest entry; damping over
    the critical one where it is but rounding."""
    largest = {part: float(np.abs(vars(other)[part]).max()) for part in PARTS}
    critical = math.sqrt(largest["mass"] * largest["stiffness"])
    largest["damping"] = max(largest["damping"], 1e-3 * critical)
    return max(
        float(np.abs(vars(one)[part] - vars(other)[part]).max()) / (largest[part] or 1.0)
        for part in PARTS
    )


PLACES = 41
"""Number of places along a link where the largest deflection is searched."""


@dataclass(frozen=True)
class VibrationSwing:
    """Swing of a link at N instants of a period: deflection of its middle and extension [m], (N,).
    ``largest_m`` is the largest deflection of any place on a link that bends, ``place_m`` from its
    first pin, at the instant ``when``; for a link that only stretches, the extension at its end."""

    link: str
    length_m: float
    bends: bool
    middle: Array
    extension: Array
    largest_m: float
    place_m: float
    when: int

    @property
    def series(self) -> Array:
        """Series of its spectrum [m], (N,): the deflection of the middle, or the extension of a
        link that does not bend."""
        return self.middle if self.bends else self.extension

    @property
    def share(self) -> float:
        """Largest deflection over the length."""
        return self.largest_m / self.length_m

    @property
    def amplitudes(self) -> Array:
        """Amplitudes of `series` at orders 0, 1, 2, ... of the period [m]."""
        return spectrum(self.series)


def swings(form: ReducedForm, z: Array) -> dict[str, VibrationSwing]:
    """Return the swings of the elastic links with coefficients (N, m) over a period, by name."""
    found, every = {}, form.about_origin(z)
    for name, (body, own) in form.assembly.elastic.items():
        q = every[:, own]
        bends = form.assembly.scene.elastic[name].bends
        x, length = np.linspace(0.0, body.length_m, PLACES), body.length_m
        across, extension = body.deflections(q, x), body.extension(q)
        away = np.abs(across) if bends else np.abs(extension)[:, None]
        when, place = np.unravel_index(int(away.argmax()), away.shape)
        found[name] = VibrationSwing(
            name, length, bends, across[:, PLACES // 2], extension,
            float(away[when, place]), float(x[place]) if bends else length, int(when),
        )  # fmt: skip
    return found


def spectrum(series: Array) -> Array:
    """Return amplitudes of a periodic series (N,), N odd, at orders 0 to N // 2 of its period."""
    amplitudes = np.abs(np.fft.rfft(series)) / len(series)
    amplitudes[1:] *= 2.0
    return np.asarray(amplitudes)


@dataclass(frozen=True)
class SteadyVibration:
    """Scene with elastic links on its periodic motion. Properties raise CrankcheckError without
    one."""

    scene: Scene
    by: Modes

    @cached_property
    def form(self) -> ReducedForm:
        """Equations of motion."""
        return self._form(stiffened=True)

    def _form(self, *, stiffened: bool) -> ReducedForm:
        return DrivenElasticMotion(self.scene, 1.0, self.by, "periodic", stiffened).form

    @property
    def speed_rad_s(self) -> float:
        """Size of the driver's speed."""
        return self.scene.driver.law.peak_speed_rad_s

    @cached_property
    def motion(self) -> periodic.PeriodicMotion:
        """Periodic motion of the full equations."""
        return periodic.periodic_motion(self.form)

    @cached_property
    def stability(self) -> Stability:
        return stability_of(self.form, self.motion)

    @cached_property
    def swings(self) -> dict[str, VibrationSwing]:
        """Swing of each link."""
        return swings(self.form, self.motion.z)

    @cached_property
    def theories(self) -> dict[str, dict[str, VibrationSwing]]:
        """Swings by equations that are linear in the deflections: with the stiffness that links
        gain by being pulled, and without, as in the thesis."""
        found = {}
        for name, stiffened in (("linear", True), ("linear, not stiffened", False)):
            form = self._form(stiffened=stiffened)
            scale = periodic.FIRST * self.scene.longest_m
            motion = periodic.linear_motion(
                form, periodic.linearise(form, self.motion.time_s, scale)
            )
            found[name] = swings(form, motion.z)
        return found

    @cached_property
    def natural(self) -> NaturalModes:
        """Natural frequencies with the driver held still at the angles of the linear theory."""
        speed = self.speed_rad_s
        return natural_modes(*AnySpeed(self.scene, self.by, 0.5 * speed, speed).still())

    @property
    def angles(self) -> Array:
        """Driver's angles at the instants of the motion [rad], (N,)."""
        return np.asarray(self.scene.driver.law.at(self.motion.time_s)[0])


def steady_vibration(scene: Scene, by: Modes) -> SteadyVibration:
    """Return the vibration of a scene that may have one. Raises CrankcheckError for no elastic
    links; a driver whose speed is not constant."""
    check_vibrates(scene)
    return SteadyVibration(scene, by)


def check_vibrates(scene: Scene) -> None:
    """Refuse a scene without elastic links or a constant speed. Raises CrankcheckError."""
    if not scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: no link of it is elastic; give one a table [elastic.LINK], or take a "
            "scene that has (crankcheck scenes)"
        )
    if type(scene.driver.law) is not ConstantSpeed:  # a controlled driver gives way
        found = "it is in free motion" if scene.is_free else "its driver follows another law"
        raise CrankcheckError(
            f"{scene.name}: vibration needs a driver at constant speed; found that {found}: use "
            '[driver] law = "constant", with speed_rad_s'
        )
