"""Motion of a driven mechanism with elastic links: the reference for engines.

The links are described by shapes (`Modes`, `Elements`, or the `Segments` of engines), the joints
are eliminated, and the remaining equations are integrated, or solved for the periodic motion. The
next finer description shows the error of the result.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.elastic.discretisation import Discretisation, ElasticDoubt, Segments, flexible_links
from analytic.elastic.natural import link_modes
from analytic.elastic.periodic import FEWEST, OTHERS, PeriodicMotion, periodic_motion
from analytic.elastic.reduced import Instant, ReducedForm, coordinates, quasi_static_start
from analytic.elastic.released import ReleasedElasticMotion, release_elastic
from analytic.elastic.vibration import VibrationHistory, vibrate
from analytic.kinematics import solve
from analytic.multibody.as_motion import as_motion
from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration, EnergyBalance
from analytic.multibody.dynamics import joint_forces
from analytic.multibody.generalised_forces import GeneralisedForces
from analytic.structure.mobility import refuse_other_than_cranked
from models.array import Array, samples
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from models.scene.elastic import Shape

PER_TURN, PER_CYCLE = 24, 6
"""Windows of the integration in a turn of the driver, and in a cycle of the first mode across: 10
nodes follow the third to 9 digits, and higher ones as far as their part in the motion needs."""

MOST_PER_TURN = 600
"""Faster modes are so stiff that they hardly bend; the method stands it, the doubt shows it."""
MOST_WINDOWS = 50_000
"""Minutes of work."""
MOST_BENT = 0.1
"""Largest deflection over the length of a link: beyond it, slopes are not small."""


@dataclass(frozen=True)
class DrivenElasticMotion:
    """Scene with elastic links, driven by its law from time 0 to ``until_s``; the windows of the
    integration are ``halved`` so many times, and a periodic motion is taken at other instants.
    ``bare`` is the same mechanism with fewer named points, whose motion is sooner found."""

    scene: Scene
    until_s: float
    by: Discretisation
    start: Shape
    stiffened: bool
    halved: int = 0
    bare: DrivenElasticMotion | None = None

    @cached_property
    def form(self) -> ReducedForm:
        """Equations of motion. Raises CrankcheckError for a scene without elastic links, or a drive
        that they can not follow."""
        turn = self.scene.driver.law.period_s if self.start == "periodic" else 0.0
        check_drive(self.scene, max(turn, self.until_s))
        flexible = flexible_links(self.scene, self.by, stiffened=self.stiffened)
        assembly = Assembly(self.scene, flexible)
        start = coordinates(assembly, solve(self.scene, np.zeros(1)))[0]
        return ReducedForm(assembly, GeneralisedForces(assembly, start), self.scene.driver.law)

    @cached_property
    def _start(self) -> tuple[Array, Array]:
        """Return the coefficients and their rates at time 0, (m,)."""
        if self.bare is not None:
            return self.bare._start
        still = np.zeros(self.form.size)
        if self.start == "periodic":
            z, rates, _ = self._periodic.at(np.zeros(1))
            return z[0], rates[0]
        return (still, still) if self.start == "straight" else quasi_static_start(self.form)

    @cached_property
    def _periodic(self) -> PeriodicMotion:
        return periodic_motion(self.form, OTHERS if self.halved % 2 else FEWEST)

    @cached_property
    def history(self) -> PeriodicMotion | VibrationHistory:
        """The coefficients of the shapes over time."""
        if self.bare is not None:
            return self.bare.history
        if self.start == "periodic":
            return self._periodic
        return vibrate(self.form, *self._start, self.until_s, self._windows(), self._kinks)

    @property
    def finer(self) -> DrivenElasticMotion:
        """The motion by more shapes, and in windows half as long, or at other instants."""
        bare = self.bare and self.bare.finer
        return replace(self, by=self.by.finer, halved=self.halved + 1, bare=bare)

    def doubt(self, time_s: Array) -> ElasticDoubt:
        """Return the error estimate of the motion at times [s]."""
        return ElasticDoubt.between(self.at(time_s), self.finer.at(time_s))

    @property
    def first(self) -> Instant:
        """The equations at time 0."""
        z, rates = self._start
        zero = np.zeros(1)
        return self.form.at(zero, z[None], rates[None], self.form.near(zero))

    @property
    def begun(self) -> tuple[Configuration, Array]:
        """The configuration at time 0, and the second derivatives of all coordinates (1, n)."""
        first = self.first
        return first.now, first.all_seconds(first.seconds)

    @property
    def _kinks(self) -> list[float]:
        """The instants [s] at which the driver's law, or a load over time, is not smooth."""
        kinks = list(self.scene.driver.law.kinks_s)
        for load in self.scene.loads.values():
            if load.over == "time":
                kinks += load.characteristic.kinks_between(0.0, self.until_s)
        return kinks

    def _windows(self) -> int:
        first = (e.frequency_rad_s for e in link_modes(self.scene, 1) if e.kind == "across")
        turns = self.until_s / self.scene.driver.law.period_s
        cycles = self.until_s * max(first, default=0.0) / math.tau
        followed = min(PER_CYCLE * cycles, MOST_PER_TURN * turns)
        windows = math.ceil(max(2.0, PER_TURN * turns, followed))
        if windows > MOST_WINDOWS:
            raise CrankcheckError(
                f"{self.scene.name}: {self.until_s:g} s are {windows} windows of the motion of its "
                f"elastic links; {MOST_WINDOWS} are the most: follow them for a shorter time, or "
                'on their periodic motion ([start] shape = "periodic")'
            )
        return int(windows * 2**self.halved)

    def instant(self, time_s: Array) -> tuple[Instant, Array]:
        """Return the equations at times [s] (T,), and the coefficients' second derivatives."""
        z, rates, seconds = self.history.at(time_s)
        return self.form.at(time_s, z, rates, self.form.near(time_s)), seconds

    @property
    def assembly(self) -> Assembly:
        """Its bodies and joints."""
        return self.form.assembly

    def coordinates_at(self, time_s: Array) -> Array:
        """Return the coordinates of the assembly at times [s], (T, n)."""
        return self.instant(time_s)[0].now.q

    def at(self, time_s: Array) -> Motion:
        """Return the motion at times [s], (T,), with its reactions and the driving torque. Raises
        CrankcheckError for times after ``until_s``, unless it is periodic."""
        instants = samples(time_s, "time_s")
        last = float(instants.max(initial=0.0))
        if self.start != "periodic" and last > self.until_s * (1.0 + 1e-12):
            raise CrankcheckError(
                f"{self.scene.name}: {last:g} s requested, and its elastic links are followed up "
                f"to {self.until_s:g} s; request that, or follow them further"
            )
        form, assembly = self.form, self.form.assembly
        now, seconds = self.instant(instants)
        motion = as_motion(assembly, instants, now.now, now.all_seconds(seconds))
        multipliers, torque = form.reactions(instants, now, seconds)
        self._check_slopes(motion)
        return replace(motion, forces=joint_forces(assembly, instants, -multipliers, torque))

    def _check_slopes(self, motion: Motion) -> None:
        """Refuse deflections that are too large for the theory. Raises CrankcheckError."""
        for name, shape in motion.elastic.items():
            share = float(np.abs(shape.middle).max(initial=0.0))
            share /= self.assembly.elastic[name][0].length_m
            if share > MOST_BENT and not isinstance(self.by, Segments):
                raise CrankcheckError(
                    f"{self.scene.name}: {name} bends by {share:.2g} of its length, which is "
                    f"too far for a beam of small slopes (up to {MOST_BENT:g}); make it "
                    "stiffer, or drive slower"
                )


JUMP = 1e-6
"""Change of the speed over its peak, from which on it is a jump."""


def check_drive(scene: Scene, until_s: float) -> None:
    """Refuse a drive that elastic links can not follow from time 0 to ``until_s``.

    Raises
    ------
    CrankcheckError
        No elastic link; a driver other than a crank; a change point on the way, where a bent link
        takes the other branch as well; a speed of the driver that jumps, which is a blow.
    """
    if not scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: no link of it is elastic; give one a table [elastic.LINK]"
        )
    refuse_other_than_cranked(scene, "the motion of elastic links")
    for crossing in solve(scene, np.array([0.0, until_s])).crossings:
        raise CrankcheckError(
            f"{scene.name}: with its driver at {math.degrees(crossing.driver_rad):.6g} deg the "
            f"dyad of {crossing.dyad} goes through a change point, from which links that bend "
            "continue in either branch; change a length"
        )
    law = scene.driver.law
    for kink in law.kinks_s:
        beside = np.nextafter(kink, [-np.inf, np.inf])
        omega = law.at(beside)[1]
        if kink < until_s and abs(omega[1] - omega[0]) > JUMP * law.peak_speed_rad_s:
            raise CrankcheckError(
                f"{scene.name}: at {kink:g} s the driver's speed jumps from {omega[0]:g} to "
                f"{omega[1]:g} rad/s, an impact on elastic links; give it a rise_s above 0"
            )


ElasticHistory = DrivenElasticMotion | ReleasedElasticMotion
"""Driven and free motions."""
TOGETHER = 2000
"""Instants computed at once: some 100 MB."""


def sampled(motion: ElasticHistory, time_s: Array) -> Motion:
    """Return the motion at times [s], (T,), in any order."""
    order = np.argsort(time_s, kind="stable")
    whole = Motion.joined([motion.at(time_s[part]) for part in _parts(order)])
    if np.array_equal(order, np.arange(order.size)):
        return whole
    back = np.argsort(order)
    asked = replace(whole, time_s=time_s, forces=None).each_series(lambda series: series[back])
    return replace(asked, forces=whole.forces and whole.forces.stretch(back))


def bent(motion: ElasticHistory, time_s: Array, shares: Array) -> dict[str, Array]:
    """Return the deflections of elastic links from the line between their pins, by name [m], (T,
    K), at times [s] (T,) in ascending order, and at shares (K,) of the length between them."""
    found: dict[str, list[Array]] = {}
    for part in _parts(np.arange(time_s.size)):
        q = motion.coordinates_at(time_s[part])
        for name, (body, own) in motion.assembly.elastic.items():
            places = body.deflections(q[:, own], shares * body.length_m)
            found.setdefault(name, []).append(places)
    return {name: np.concatenate(each) for name, each in found.items()}


def energies(motion: ReleasedElasticMotion, time_s: Array) -> EnergyBalance:
    """Return the energies of a free motion at times [s], (T,) in ascending order."""
    parts = [motion.energy(time_s[part]) for part in _parts(np.arange(time_s.size))]
    return EnergyBalance.joined(parts)


def _parts(order: NDArray[np.intp]) -> Iterator[NDArray[np.intp]]:
    yield from np.array_split(order, max(1, -(-order.size // TOGETHER)))


def fastest_rad_s(scene: Scene, by: Discretisation) -> float:
    """Return the highest angular frequency of the links in the position of the start, unloaded, or
    the fastest decay rate where damping_s makes that larger still."""
    by_place, by_rate = _of_released(scene, by) if scene.is_free else _of_driven(scene, by)
    highest = math.sqrt(float(np.linalg.eigvals(-by_place).real.max()))
    links = scene.elastic.values()
    if not any(own.damping_s for own in links):
        return highest
    still, one = np.zeros_like(by_place), np.eye(len(by_place))
    whole = np.block([[still, one], [by_place, by_rate]])
    return max(highest, float(np.abs(np.linalg.eigvals(whole)).max()))


def _of_driven(scene: Scene, by: Discretisation) -> tuple[Array, Array]:
    """Return the derivatives of the coefficients' accelerations by these and their rates."""
    motion = DrivenElasticMotion(scene, 1.0, by, "straight", stiffened=True)
    form, mass = motion.form, motion.first.mass[0]
    return -np.linalg.solve(mass, form.stiffness), -np.linalg.solve(mass, form.damping)


def _of_released(scene: Scene, by: Discretisation) -> tuple[Array, Array]:
    """Return the same for a free motion, by the driver's angle too."""
    straight = replace(scene, start=replace(scene.start, shape="straight"))
    motion = release_elastic(straight, 1.0, by)
    form, tangent = motion.form, motion.form.tangent(motion.start[0])
    still = np.zeros(tangent.free.shape[1])
    derived = form.derivatives(0.0, tangent, still, still)
    return derived[:, : still.size], derived[:, still.size :]
