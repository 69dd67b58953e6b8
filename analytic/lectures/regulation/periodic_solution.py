"""Kinetic energy of a machine over a cycle that it repeats, in cells of its angle.

With T = J w^2 / 2 the equation of the machine is dT/du = M(u, w) + D; D is a constant torque of the
drive. In every cell T is a polynomial that satisfies it in Gauss's nodes; each Newton step solves
the linear equation of the residual, cell by cell, with T at the start and D open, and these follow
from T(cycle) = T(0) and, if given, a mean speed.

Mean speed is (w_max + w_min) / 2, that of the coefficient of fluctuation.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.regulation.angle_cells import (
    INSIDE,
    LEGENDRE,
    WHOLE,
    AngleCells,
    integrals_to,
    rated_breaks,
)
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.array import Array
from models.errors import CrankcheckError


class StallError(CrankcheckError):
    """The machine stops on its way round, for want of inertia."""


@dataclass(frozen=True)
class PeriodicSolution:
    """Energy T [J] at the nodes (C, NODES) and borders (C + 1,) of cells, the torque M there and
    the constant one of the drive, D [N m]; ``gain`` is the growth of a change of T at the start in
    a cycle."""

    machine: TurningMachine
    cells: AngleCells
    flywheel: float
    inertia: Array

    energy: Array
    at_borders: Array
    torque: Array
    drive: float
    gain: float

    @property
    def speed(self) -> Array:
        """Speed w at the nodes [rad/s]."""
        return np.asarray(np.sqrt(2.0 * self.energy / self.inertia))

    @property
    def roughness(self) -> Array:
        """Energy in the highest polynomial of the torque in a cell, over the largest energy, (C,):
        the truncation is less. If a wave has none of that polynomial the one before counts, as if
        each had the same share of the one before it."""
        parts = np.abs(self.torque @ LEGENDRE)
        size = np.maximum(parts.max(axis=1), np.finfo(float).tiny)
        last = np.maximum(parts[:, -1], size * (parts[:, -2] / size) ** (4.0 / 3.0))
        return np.asarray(self.cells.widths * last / float(np.max(self.energy)))

    def energy_at(self, u: Array) -> Array:
        """Return T at angles (T,) [J]."""
        cell, share = self.cells.places(u)
        torque = self.torque[cell] + self.drive
        inner = np.sum(integrals_to(share) * torque, axis=1)
        return np.asarray(self.at_borders[cell] + self.cells.widths[cell] * inner)

    def inertia_at(self, u: Array) -> Array:
        """Return J with the flywheel [kg m^2]."""
        return self.machine.inertia(u)[0] + self.flywheel

    def speed_at(self, u: Array) -> Array:
        """Return w at angles (T,) [rad/s]."""
        return np.asarray(np.sqrt(2.0 * self.energy_at(u) / self.inertia_at(u)))


@dataclass(frozen=True)
class WantedSpeed:
    """Mean speed ``mean_rad_s``, kept by a constant torque, or None for a machine under its torques
    alone; ``extremes`` are the angles of the largest and the smallest speed, where known."""

    mean_rad_s: float | None
    extremes: tuple[float, float] | None = None


MOST_STEPS = 80
LEFT = 0.2
"""Least share of the energy that a Newton step leaves anywhere: an energy is above 0."""
DONE = 1e-13
"""Size of the last step, over the largest energy."""
RESTING = 1e-4
"""Least speed over the largest, below which a machine is at rest."""
NUDGE = 1e-6
"""Relative change of a speed for the slope of torques over it."""


def repeated(
    machine: TurningMachine,
    cells: AngleCells,
    flywheel: float,
    guess: PeriodicSolution | float,
    wanted: WantedSpeed,
) -> PeriodicSolution:
    """Find the solution that the machine repeats. ``guess`` is a speed [rad/s] to begin with, or a
    solution, in cells of its own. Raises StallError where the energy runs out on the way,
    CrankcheckError for tables of loads that end before."""
    return _Newton(machine, cells, flywheel, wanted).solved(guess)


class _Newton:
    """Newton's method for a solution that repeats."""

    def __init__(
        self, machine: TurningMachine, cells: AngleCells, flywheel: float, wanted: WantedSpeed
    ) -> None:
        self.machine, self.cells, self.flywheel, self.wanted = machine, cells, flywheel, wanted
        self.inertia = machine.inertia(cells.nodes)[0] + flywheel
        self.at_borders = machine.inertia(cells.borders)[0] + flywheel
        self.steady = machine.steady_torque(cells.nodes)
        if not np.all(self.at_borders > 0.0):
            where = math.degrees(machine.theta(cells.borders[self.at_borders <= 0.0])[0]) % 360.0
            raise StallError(
                f"{machine.scene.name}: no mass moves with the driver at {where:.6g} deg, so that "
                "no energy carries the machine on; give masses, or a flywheel"
            )

    def solved(self, guess: PeriodicSolution | float) -> PeriodicSolution:
        solution = self._begun(guess)
        last = np.inf
        for _ in range(MOST_STEPS):
            full = self._step(solution)
            pairs = (full.energy, solution.energy), (full.at_borders, solution.at_borders)
            change = max(float(np.max(np.abs(new - old))) for new, old in pairs)
            change /= float(np.max(np.abs(solution.energy)))
            least = min(float(np.min(new / old)) for new, old in pairs)
            if least >= LEFT:
                if change <= DONE or (change < 1e-9 and change >= 0.5 * last):
                    if self._holds(full):
                        return full
                    break
                last = change
            share = 1.0 if least >= LEFT else (1.0 - LEFT) / (1.0 - least)
            solution = self._mixed(solution, full, share)
        raise StallError(self._stalled(solution))

    def _begun(self, guess: PeriodicSolution | float) -> PeriodicSolution:
        if isinstance(guess, float):
            square = 0.5 * guess**2
            return self._solution(square * self.inertia, square * self.at_borders, 0.0, 1.0)
        nodes = self.cells.nodes
        energy = guess.energy_at(nodes.ravel()).reshape(nodes.shape)
        return self._solution(energy, guess.energy_at(self.cells.borders), guess.drive, guess.gain)

    def _holds(self, solution: PeriodicSolution) -> bool:
        """True if a solution belongs to a machine that goes on, at the wanted speed; the steps may
        also end where it nearly stops."""
        (_, *high), (_, *low) = self._extremes(solution)
        fast, slow = (math.sqrt(2.0 * energy / inertia) for energy, inertia in (high, low))
        mean = self.wanted.mean_rad_s
        return slow > RESTING * fast and (
            mean is None or abs(0.5 * (fast + slow) - mean) <= 1e-9 * mean
        )

    def _solution(
        self, energy: Array, at_borders: Array, drive: float, gain: float
    ) -> PeriodicSolution:
        """Return the solution with the torque at the nodes. Raises CrankcheckError."""
        torque = self.steady
        if self.machine.is_rated:
            speed = np.sqrt(2.0 * energy / self.inertia)
            torque = torque + self.machine.rated_torque(self.cells.nodes, speed)
        return PeriodicSolution(
            self.machine, self.cells, self.flywheel, self.inertia,
            energy, at_borders, torque, drive, gain,
        )  # fmt: skip

    def _mixed(
        self, solution: PeriodicSolution, full: PeriodicSolution, share: float
    ) -> PeriodicSolution:
        """Take a share of the way; less of it where a table of a load would end."""
        why: CrankcheckError | None = None
        for _ in range(40):
            try:
                return self._solution(
                    solution.energy + share * (full.energy - solution.energy),
                    solution.at_borders + share * (full.at_borders - solution.at_borders),
                    solution.drive + share * (full.drive - solution.drive),
                    full.gain,
                )
            except CrankcheckError as error:
                share, why = 0.5 * share, why or error
        assert why is not None
        raise why

    def _slope(self, solution: PeriodicSolution) -> Array:
        """Return dM/dT at the nodes [1]."""
        if not self.machine.is_rated:
            return np.zeros_like(solution.energy)
        speed, nodes = solution.speed, self.cells.nodes
        low = self.machine.rated_torque(nodes, speed * (1.0 - NUDGE))
        by_speed = (solution.torque - self.steady - low) / (NUDGE * speed)
        return np.asarray(by_speed / (self.inertia * speed))

    def _step(self, solution: PeriodicSolution) -> PeriodicSolution:
        """Solve the equation that is linear about a solution."""
        slope, wide = self._slope(solution), self.cells.widths[:, None]
        left = solution.torque - slope * solution.energy  # M = left + slope T
        matrix = np.eye(INSIDE.shape[0]) - wide[:, :, None] * INSIDE * slope[:, None, :]
        right = np.stack([np.ones_like(left), wide * (left @ INSIDE.T),
                          wide * (np.ones_like(left) @ INSIDE.T)], axis=2)  # fmt: skip
        # T at the nodes of a cell, from T at its first border, from the rest, and from D.
        within = np.linalg.solve(matrix, right)
        torques = slope[:, :, None] * within
        torques[:, :, 1] += left
        torques[:, :, 2] += 1.0
        over = wide * np.einsum("j,cjk->ck", WHOLE, torques)
        start = np.zeros((len(over) + 1, 3))
        start[0, 0] = 1.0  # T at the borders, from T(0), from the residual, and from D
        for k, row in enumerate(over):
            start[k + 1] = start[k] * (1.0 + row[0])
            start[k + 1, 1:] += row[1:]
        first, drive = self._open(solution, start, torques)
        known = np.array([first, 1.0, drive])
        borders = start @ known
        energy = within[:, :, 0] * borders[:-1, None] + within[:, :, 1] + drive * within[:, :, 2]
        torque = torques[:, :, 0] * borders[:-1, None] + torques[:, :, 1]
        torque = torque + drive * (torques[:, :, 2] - 1.0)
        gain = float(start[-1, 0])
        return replace(
            solution, energy=energy, at_borders=borders, torque=torque, drive=drive, gain=gain
        )

    def _open(
        self, solution: PeriodicSolution, start: Array, torques: Array
    ) -> tuple[float, float]:
        """Return T at the start and D, from the periodicity and the mean speed."""
        gain, gained, driven = start[-1]
        mean = self.wanted.mean_rad_s
        if mean is None:
            return float(gained / (1.0 - gain)), 0.0
        periodic = np.array([gain - 1.0, driven])
        row, right = np.zeros(2), mean
        for u, energy, inertia in self._extremes(solution):
            speed = np.sqrt(2.0 * energy / inertia)
            weights = self._weights(u, start, torques)
            row += 0.5 * weights[[0, 2]] / (inertia * speed)
            right -= 0.5 * (speed + (weights[1] - energy) / (inertia * speed))
        first, drive = np.linalg.solve(np.array([periodic, row]), np.array([-gained, right]))
        return float(first), float(drive)

    def _weights(self, u: float, start: Array, torques: Array) -> Array:
        """Return T at an angle, from T(0), from the rest, and from D."""
        cell, share = (each[0] for each in self.cells.places(np.array([u])))
        inner = self.cells.widths[cell] * (integrals_to(np.array(share)) @ torques[cell])
        found = start[cell] * (1.0 + inner[0])
        found[1:] += inner[1:]
        return np.asarray(found)

    def _extremes(self, solution: PeriodicSolution) -> list[tuple[float, float, float]]:
        """Return angle, energy and inertia where the speed is largest, and where smallest."""
        if self.wanted.extremes is not None:
            u = np.array(self.wanted.extremes)
            energy, inertia = solution.energy_at(u), solution.inertia_at(u)
        else:
            u = self.cells.nodes.ravel()
            energy, inertia = solution.energy.ravel(), self.inertia.ravel()
            square = energy / inertia
            at = [int(np.argmax(square)), int(np.argmin(square))]
            u, energy, inertia = u[at], energy[at], inertia[at]
        return list(zip(u.tolist(), energy.tolist(), inertia.tolist(), strict=True))

    def _stalled(self, solution: PeriodicSolution) -> str:
        scene, worst = self.machine.scene, int(np.argmin(solution.energy / self.inertia))
        where = np.degrees(self.machine.theta(self.cells.nodes.ravel()[worst])) % 360.0
        mean = self.wanted.mean_rad_s
        of = "" if mean is None else f" with a mean speed of {mean:.6g} rad/s"
        return (
            f"{scene.name}: no steady cycle{of}: its masses hold too little energy, and it "
            f"comes to rest near {scene.driver.link} {where:.4g} deg; add a flywheel, as large "
            "as the requested coefficient of fluctuation needs"
        )


RESOLVED, MOST_HALVINGS, MOST_CELLS = 1e-8, 16, 12_000
"""Share of the highest polynomial of a cell in the largest energy, of which the truncation is a
hundredth; most halvings of cells for it, and most cells."""


def resolved(solution: PeriodicSolution, wanted: WantedSpeed) -> PeriodicSolution:
    """Refine the cells until their polynomials follow the solution: a machine that comes quickly to
    the speed of its motor, or a load of short waves, takes narrower ones. Raises CrankcheckError
    where no cells are narrow enough."""
    machine = solution.machine
    for _ in range(MOST_HALVINGS):
        rough = np.flatnonzero(solution.roughness > RESOLVED)
        if not rough.size:
            return solution
        if len(solution.cells.widths) + rough.size > MOST_CELLS:
            break
        own = solution.cells
        more = [own.borders, own.borders[rough] + 0.5 * own.widths[rough]]
        if machine.is_rated:
            more.append(rated_breaks(machine, solution.speed_at))
        cells = AngleCells.of(machine.cycle_rad, np.concatenate(more))
        solution = repeated(machine, cells, solution.flywheel, solution, wanted)
    where = machine.theta(solution.cells.borders[np.argmax(solution.roughness)])
    raise CrankcheckError(
        f"{machine.scene.name}: no steady cycle is found: near {machine.scene.driver.link} "
        f"{np.degrees(where) % 360.0:.4g} deg torques change too fast for {MOST_CELLS} cells of a "
        "cycle; give loads of longer waves, or a motor that is less steep over the speed"
    )
