"""The vibration of elastic links that a driver of constant speed keeps up, with all that is asked
of it: natural frequencies, the periodic motion and the linear theories beside it, its stability."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.natural import NaturalModes, natural_modes
from analytic.elastic.periodic import (
    FIRST,
    PeriodicMotion,
    linear_motion,
    linearise,
    periodic_motion,
)
from analytic.elastic.reduced import ReducedForm
from analytic.lectures.vibration.any_speed import AnySpeed
from analytic.lectures.vibration.floquet import Stability, stability_of
from analytic.lectures.vibration.swing import Swing, swings
from models.array import Array
from models.errors import CrankcheckError
from models.laws import ConstantSpeed
from models.scene import Scene


@dataclass(frozen=True)
class SteadyVibration:
    """A scene with elastic links on its periodic motion. Each raises CrankcheckError where there is
    none."""

    scene: Scene
    by: Modes

    @cached_property
    def form(self) -> ReducedForm:
        """The equations of motion."""
        return self._form(stiffened=True)

    def _form(self, *, stiffened: bool) -> ReducedForm:
        return DrivenElasticMotion(self.scene, 1.0, self.by, "periodic", stiffened).form

    @property
    def speed_rad_s(self) -> float:
        """Of the driver, as a size."""
        return self.scene.driver.law.peak_speed_rad_s

    @cached_property
    def motion(self) -> PeriodicMotion:
        """The periodic motion, unlinearised."""
        return periodic_motion(self.form)

    @cached_property
    def stability(self) -> Stability:
        return stability_of(self.form, self.motion)

    @cached_property
    def swings(self) -> dict[str, Swing]:
        """How each link swings."""
        return swings(self.form, self.motion.z)

    @cached_property
    def theories(self) -> dict[str, dict[str, Swing]]:
        """The same by equations that are linear in the deflections: with the stiffness that links
        gain by being pulled, and without, as in the thesis."""
        found = {}
        for name, stiffened in (("linear", True), ("linear, not stiffened", False)):
            form = self._form(stiffened=stiffened)
            scale = FIRST * self.scene.longest_m
            motion = linear_motion(form, linearise(form, self.motion.time_s, scale))
            found[name] = swings(form, motion.z)
        return found

    @cached_property
    def natural(self) -> NaturalModes:
        """Natural frequencies with the driver held still at the angles of the linear theory."""
        speed = self.speed_rad_s
        return natural_modes(*AnySpeed(self.scene, self.by, 0.5 * speed, speed).still())

    @property
    def angles(self) -> Array:
        """Of the driver at the instants of the motion [rad], (N,)."""
        return np.asarray(self.scene.driver.law.at(self.motion.time_s)[0])


def steady_vibration(scene: Scene, by: Modes) -> SteadyVibration:
    """The vibration of a scene that may have one.

    Raises
    ------
    CrankcheckError
        No elastic links; a driver whose speed is not constant.
    """
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
        found = "it is let go" if scene.is_free else "its driver follows another law"
        raise CrankcheckError(
            f"{scene.name}: vibration is told of a driver at constant speed; found that {found}: "
            'use [driver] law = "constant", with speed_rad_s'
        )
