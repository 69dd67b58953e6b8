"""The kinetic energy of a machine over a cycle that it repeats, in cells of its angle.

With T = J w^2 / 2 the equation of the machine is dT/du = M(u, w) + D; D is a constant torque of the
drive.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.lectures.regulation.angle_cells import LEGENDRE, AngleCells, integrals_to
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.array import Array
from models.errors import CrankcheckError


class StallError(CrankcheckError):
    """A machine that stops on its way round, for want of inertia."""


@dataclass(frozen=True)
class PeriodicSolution:
    """The energy T [J] at the nodes (C, NODES) and borders (C + 1,) of cells, the torque M there
    and the constant one of the drive, D [N m]; ``gain`` is what a change of T at the start becomes
    in a cycle."""

    machine: TurningMachine
    cells: AngleCells
    flywheel: float
    inertia: Array
    inertia_at_borders: Array
    energy: Array
    at_borders: Array
    torque: Array
    drive: float
    gain: float

    @property
    def speed(self) -> Array:
        """w at the nodes [rad/s]."""
        return np.asarray(np.sqrt(2.0 * self.energy / self.inertia))

    @property
    def roughness(self) -> Array:
        """What the highest polynomial of the torque in a cell has of the energy, over the largest
        energy, (C,): what that leaves out is less. Where a wave has none of that polynomial the one
        before tells, as if each had the same share of the one before it."""
        parts = np.abs(self.torque @ LEGENDRE)
        size = np.maximum(parts.max(axis=1), np.finfo(float).tiny)
        last = np.maximum(parts[:, -1], size * (parts[:, -2] / size) ** (4.0 / 3.0))
        return np.asarray(self.cells.widths * last / float(np.max(self.energy)))

    def energy_at(self, u: Array) -> Array:
        """T at angles (T,) [J]."""
        cell, share = self.cells.places(u)
        torque = self.torque[cell] + self.drive
        inner = np.sum(integrals_to(share) * torque, axis=1)
        return np.asarray(self.at_borders[cell] + self.cells.widths[cell] * inner)

    def inertia_at(self, u: Array) -> Array:
        """J with the flywheel [kg m^2]."""
        return self.machine.inertia(u)[0] + self.flywheel

    def speed_at(self, u: Array) -> Array:
        """w at angles (T,) [rad/s]."""
        return np.asarray(np.sqrt(2.0 * self.energy_at(u) / self.inertia_at(u)))


@dataclass(frozen=True)
class WantedSpeed:
    """``mean_rad_s``, a mean speed to be kept by a constant torque, or None for a machine left to
    its torques; ``extremes`` are the angles of the largest and the smallest speed, where known."""

    mean_rad_s: float | None
    extremes: tuple[float, float] | None = None
