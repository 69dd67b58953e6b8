"""Vibration over the speed of the driver: deflection, spectrum, multipliers, critical speeds.

The linearised equations include the stiffness of pulled links: next to a resonance they show its
place, and not the deflection there.

The mass that a coupler moves sets its pull and push in a turn, and so its stiffness: with a heavy
rocker the turning feeds the vibration itself. Source: Thesis on vibration of planar mechanisms with
elastic links (2018), chapter 4.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from analytic.elastic import natural
from analytic.elastic.discretisation import Modes
from analytic.elastic.periodic import LinearForm
from analytic.elastic.reduced import ReducedForm
from analytic.lectures.vibration import floquet
from analytic.lectures.vibration.steady_vibration import AnySpeed, VibrationSwing, swings
from models.array import Array
from models.errors import CrankcheckError, cut
from models.scene import Scene

HIGHEST = 24
"""Highest order of critical speeds: the driver hardly excites higher ones."""
ASIDE, ROUNDS = 1e-3, 4
"""Distance from a critical speed at which the strength of the resonance is taken; rounds until one
is found to less than that."""


@dataclass(frozen=True)
class AtSpeed:
    """Vibration at a speed [rad/s]: swings of the links, map of deviations over a period,
    sensitivity to stiffness. ``ratio`` is the lowest natural frequency of a link over the speed."""

    speed_rad_s: float
    ratio: float
    swings: Mapping[str, VibrationSwing]
    stability: floquet.Stability
    sensitivity: natural.FrequencySensitivity

    @property
    def deviations(self) -> tuple[floquet.Deviation, ...]:
        return self.stability.deviations

    @property
    def share(self) -> float:
        """Largest deflection of a link over its length."""
        return max(swing.share for swing in self.swings.values())


@dataclass(frozen=True)
class CriticalSpeed:
    """Speed at which the driver meets an order of a mode, and the relative distance from it up to
    which the motion is too sensitive to stiffness (`natural.MOST`)."""

    speed_rad_s: float
    ratio: float
    mode: int
    order: int
    band: float


@dataclass(frozen=True)
class OverSpeeds:
    """Vibration of a scene at ascending speeds."""

    every: AnySpeed
    form: ReducedForm
    points: tuple[AtSpeed, ...]

    @property
    def scene(self) -> Scene:
        return self.every.scene

    @property
    def speeds(self) -> Array:
        """Speeds [rad/s], (S,)."""
        return np.array([point.speed_rad_s for point in self.points])

    @cached_property
    def critical(self) -> list[CriticalSpeed]:
        """Critical speeds between them, where an excited mode resonates, the widest band first."""
        found = []
        for one, other in pairwise(self.points):
            for k, (before, after) in enumerate(zip(one.deviations, other.deviations, strict=True)):
                for order in _between(before.order, after.order):
                    speed = self._met(k, order, (one, before.order), (other, after.order))
                    hangs = self._sensitivity((1.0 + ASIDE) * speed)
                    if hangs.order == order:
                        band = math.sqrt(hangs.size / natural.MOST) * ASIDE
                        ratio = one.ratio * one.speed_rad_s / speed
                        found.append(CriticalSpeed(speed, ratio, before.mode, order, band))
        return sorted(found, key=lambda each: -each.band)

    def _met(
        self, k: int, order: int, low: tuple[AtSpeed, float], high: tuple[AtSpeed, float]
    ) -> float:
        """Return the speed between two, each with the order of a mode, at which that is whole."""
        (a, before), (b, after) = ((at.speed_rad_s, own - order) for at, own in (low, high))
        speed = b
        for _ in range(ROUNDS):
            if before == after:
                break
            speed = a - before * (b - a) / (after - before)
            linear = self.every.linear(speed)
            off = floquet.stability(linear, math.tau / speed, HIGHEST).deviations[k].order - order
            if not math.isfinite(off) or off == 0.0:
                break
            if off * before > 0.0:
                a, before = speed, off
            else:
                b, after = speed, off
        return speed

    def _sensitivity(self, speed: float) -> natural.FrequencySensitivity:
        return _solved(self.form, self.every.linear(speed), math.tau / speed)[2]


def _solved(
    form: ReducedForm, linear: LinearForm, period_s: float
) -> tuple[Array, floquet.Stability, natural.FrequencySensitivity]:
    """Return coefficients at the instants of linearised equations (N, m), stability, sensitivity.
    Windows have matrices of their own: the one large matrix of harmonic balance
    (`periodic.linear_motion`) takes ten times as long where processors are busy."""
    count = len(linear.force)
    modes = natural.natural_modes(linear.mass, linear.stiffness)
    each = math.ceil(floquet.window_count(modes, period_s, HIGHEST) / count)
    windows = floquet.Windows.of(linear, period_s, each * count)
    monodromy = windows.over(linear.force)
    z = windows.periodic(linear.force, monodromy)[::each]
    asked = z @ form.stiffness
    pushed = floquet.Monodromy(monodromy.matrix, windows.over(asked).particular)
    change = windows.periodic(asked, pushed)[::each]
    stable = floquet.looked_at(monodromy, each * count, linear, modes, period_s)
    return z, stable, natural.sensitivity(form, z, change)


def over_speeds(scene: Scene, by: Modes, speeds: Array) -> OverSpeeds:
    """Compute the vibration at ascending speeds [rad/s], (S,), all above 0. Raises CrankcheckError
    for loads that do not repeat each turn at these speeds; joints that can not be closed."""
    every = AnySpeed(scene, by, float(speeds[0]), float(speeds[-1]))
    form, lowest = every.form(float(speeds[0])), natural.lowest_rad_s(scene)
    found = []
    for speed in map(float, speeds):
        z, own, hangs = _solved(form, every.linear(speed), math.tau / speed)
        found.append(AtSpeed(speed, lowest / speed, swings(form, z), own, hangs))
    return OverSpeeds(every, form, tuple(found))


def _between(before: float, after: float) -> Iterator[int]:
    if math.isfinite(before) and math.isfinite(after):
        low, high = min(before, after), max(before, after)
        yield from range(max(math.ceil(low), 1), min(math.floor(high), HIGHEST) + 1)


def spectra(over: OverSpeeds, link: str) -> Array:
    """Return the amplitudes of a link over its length at all speeds and orders, (S, orders)."""
    each = [point.swings[link] for point in over.points]
    return np.array([swing.amplitudes / swing.length_m for swing in each])


@dataclass(frozen=True)
class InertiaMap:
    """Vibration with a ``link`` that is ``factors`` (F,) times as heavy, over speeds each."""

    link: str
    factors: Array
    over: tuple[OverSpeeds, ...]

    @property
    def scene(self) -> Scene:
        """Scene with the heaviest link."""
        return self.over[-1].scene

    @property
    def speeds(self) -> Array:
        return self.over[0].speeds

    @property
    def shares(self) -> Array:
        """Largest deflection over the length, (F, S)."""
        return np.array([[point.share for point in one.points] for one in self.over])

    @property
    def multipliers(self) -> Array:
        """Size of the largest multiplier, (F, S)."""
        return np.array([[point.stability.largest for point in one.points] for one in self.over])


def with_inertia(scene: Scene, body: str, factor: float) -> Scene:
    """Return the scene with a rigid link, or the block of a slider, so many times as heavy. Raises
    CrankcheckError for no such body; one that is elastic, or the driver, or without mass."""
    links = {
        name: own
        for name, own in scene.links.items()
        if name not in scene.elastic and name != scene.driver.link and own.mass_kg
    }
    blocks = {name: own for name, own in scene.sliders.items() if own.mass_kg and name not in links}
    if body in links:
        own = links[body]
        heavy = replace(own, mass_kg=factor * own.mass_kg, inertia_kg_m2=factor * own.inertia_kg_m2)
        return replace(scene, links={**scene.links, body: heavy})
    if body in blocks:
        block = blocks[body]
        mass, inertia = factor * block.mass_kg, factor * block.inertia_kg_m2
        heavier = replace(block, mass_kg=mass, inertia_kg_m2=inertia)
        return replace(scene, sliders={**scene.sliders, body: heavier})
    use = ", ".join((*links, *blocks)) or "a scene with a rigid link of mass beside the driver"
    why = _unchanged(scene, body)
    raise CrankcheckError(f"{scene.name}: inertia of {cut(body)}: {why}; use {use}")


def _unchanged(scene: Scene, body: str) -> str:
    if body in scene.elastic:
        return "it is elastic, and its own mass is that of the beam"
    if body == scene.driver.link:
        return "its speed is given, whatever its inertia"
    if body in scene.links or body in scene.sliders:
        return "it has no mass"
    return "no link or slider of that name"


def over_inertia(scene: Scene, by: Modes, speeds: Array, link: str, factors: Array) -> InertiaMap:
    """Compute the vibration with a link so many times as heavy, for each factor at all speeds.
    Raises CrankcheckError as `with_inertia` and `over_speeds`."""
    heavier = [with_inertia(scene, link, float(factor)) for factor in factors]
    return InertiaMap(link, factors, tuple(over_speeds(each, by, speeds) for each in heavier))
