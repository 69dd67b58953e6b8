"""The motion of a driven mechanism with elastic links: the reference of what engines are held to.

The links are described by shapes (`Modes`, `Elements`, or the `Segments` that engines have), the
joints are solved for, and what is left is integrated, or found as the periodic motion. How far the
result is to be trusted is seen from the next finer description.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.elastic.discretisation import Discretisation, flexible_links
from analytic.elastic.periodic import PeriodicMotion, periodic_motion
from analytic.elastic.reduced import Instant, ReducedForm, quasi_static
from analytic.elastic.vibration import VibrationHistory, vibrate
from analytic.multibody.as_motion import as_motion
from analytic.multibody.assembly import Assembly
from analytic.multibody.generalised_forces import GeneralisedForces
from analytic.multibody.joint_forces import joint_forces
from models.array import Array
from models.elastic import Shape
from models.motion import ElasticMotion as LinkShape
from models.motion import Motion
from models.samples import samples
from models.scene import Scene

PER_CYCLE = 2.0
"""Windows of the integration in the shortest period of its shapes."""


@dataclass(frozen=True)
class DrivenElasticMotion:
    """A scene with elastic links, driven by its law from time 0 to ``until_s``."""

    scene: Scene
    until_s: float
    by: Discretisation
    start: Shape
    stiffened: bool

    @cached_property
    def form(self) -> ReducedForm:
        """The equations of motion."""
        flexible = flexible_links(self.scene, self.by, stiffened=self.stiffened)
        assembly = Assembly(self.scene, flexible)
        return ReducedForm(
            assembly, GeneralisedForces(assembly, np.zeros(assembly.size)), self.scene.driver.law
        )

    @cached_property
    def _start(self) -> tuple[Array, Array]:
        """The coefficients and their rates at time 0, (m,)."""
        still = np.zeros(self.form.size)
        if self.start == "periodic":
            z, rates, _ = self._periodic.at(np.zeros(1))
            return z[0], rates[0]
        return (still if self.start == "straight" else quasi_static(self.form, 0.0)), still

    @cached_property
    def _periodic(self) -> PeriodicMotion:
        return periodic_motion(self.form)

    @cached_property
    def history(self) -> PeriodicMotion | VibrationHistory:
        """The coefficients of the shapes over time."""
        if self.start == "periodic":
            return self._periodic
        return vibrate(self.form, *self._start, self.until_s, self._windows())

    @property
    def first(self) -> Instant:
        """The equations at time 0."""
        z, rates = self._start
        zero = np.zeros(1)
        return self.form.at(zero, z[None], rates[None], self.form.near(zero))

    def _windows(self) -> int:
        """Of the integration."""
        squares = np.linalg.eigvals(np.linalg.solve(self.first.mass[0], self.form.stiffness)).real
        fastest = math.sqrt(float(squares.max()))
        return max(8, math.ceil(self.until_s * PER_CYCLE * fastest / math.tau))

    def instant(self, time_s: Array) -> tuple[Instant, Array]:
        """The equations at times [s] (T,), and the second derivatives of the coefficients there."""
        z, rates, seconds = self.history.at(time_s)
        return self.form.at(time_s, z, rates, self.form.near(time_s)), seconds

    def at(self, time_s: Array) -> Motion:
        """The motion at times [s], (T,), with its reactions and the driving torque."""
        instants = samples(time_s, "time_s")
        form, assembly = self.form, self.form.assembly
        now, seconds = self.instant(instants)
        motion = as_motion(assembly, instants, now.now, now.all_seconds(seconds))
        multipliers, torque = form.reactions(instants, now, seconds)
        forces = joint_forces(
            self.scene, assembly.joints.pin_pairs(), instants, -multipliers, torque
        )
        return replace(motion, forces=forces, elastic=self._shapes(now.now.q))

    def _shapes(self, q: Array) -> dict[str, LinkShape]:
        """How the links are bent and stretched at coordinates (T, n)."""
        return {
            name: LinkShape(
                body.deflections(q[:, own], np.array([0.5 * body.length_m]))[:, 0],
                body.extension(q[:, own]),
            )
            for name, (body, own) in self.form.assembly.elastic.items()
        }
