"""Torques on all members of a gear train at its speeds, with losses in the teeth.

A pair carries one number, its load lambda, the torque on a gear over its teeth. Without losses it
loads its three bodies by lambda times their coefficients in its relation; these sum to 0, and so
the torques of each mesh, and of the whole, are in balance. With losses the driven gear, seen from
the carrier, gets less by the efficiency eta of the mesh:

    gear 0 drives: (z0, eta s z1, -(z0 + eta s z1))      gear 1 drives: with 1/eta

Which gear drives follows from the loads, and these from who drives: found by trial, all choices if
need be. Source: Mueller, Epicyclic Drive Trains (1982): rolling power, self-locking.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice, product

import numpy as np

from analytic.gears.trains import Train
from models.errors import CrankcheckError
from models.scene import GROUND
from models.scene.pairs import Gear

MOST_TRIED = 4096
"""Choices of the driving gears, two of each pair with losses, that are tried."""
NOTHING = 1e-12
"""Power of a mesh, over the largest, that counts as none."""


@dataclass(frozen=True)
class MeshLoad:
    """Torques of a mesh on its gears and its carrier, ``on_n_m`` by body, and its powers seen from
    the carrier: ``rolling_w`` goes from the driving gear into the teeth, ``loss_w`` stays there.
    It ``drives`` by its first gear (1) or its second (-1)."""

    gear: Gear
    on_n_m: Mapping[str, float]
    rolling_w: float
    loss_w: float
    drives: int

    def tangential_n(self, module_m: float) -> float:
        """Return the tangential force between the teeth at the working pitch circles [N], that on
        the driving gear, for the module of these circles."""
        sides = zip(self.gear.bodies, self.gear.teeth, strict=True)
        return max(2.0 * abs(self.on_n_m[body]) / (z * module_m) for body, z in sides)


@dataclass(frozen=True)
class TrainTorques:
    """Speeds [rad/s] and torques from outside [N m] by body, the ground first, and the meshes."""

    speeds_rad_s: Mapping[str, float]
    torques_n_m: Mapping[str, float]
    meshes: tuple[MeshLoad, ...]

    @property
    def powers_w(self) -> Mapping[str, float]:
        """Power from outside into each body."""
        return {b: torque * self.speeds_rad_s[b] for b, torque in self.torques_n_m.items()}

    @property
    def input_w(self) -> float:
        """Power that goes in: the sum over bodies that are driven."""
        return sum(power for power in self.powers_w.values() if power > 0.0)

    @property
    def efficiency(self) -> float | None:
        """Power out over power in; None where nothing goes in."""
        out = -sum(power for power in self.powers_w.values() if power < 0.0)
        return out / self.input_w if self.input_w > 0.0 else None

    @property
    def circulating(self) -> Mapping[str, float]:
        """Rolling power over the input power of pairs where it is above 1: power that circulates
        in the train, so that its losses are those of more than its input."""
        most = self.input_w * (1.0 + 1e-9)
        return {
            mesh.gear.name: mesh.rolling_w / self.input_w
            for mesh in self.meshes
            if 0.0 < most < mesh.rolling_w
        }


def torques(train: Train, inputs: Mapping[str, float], loads: Mapping[str, float]) -> TrainTorques:
    """Find the torques on all members in steady motion; those of the inputs close the balance.

    ``inputs`` are speeds of independent bodies [rad/s], as many as the mobility, and ``loads`` the
    known torques from outside [N m], counter-clockwise positive; others are 0. Equal planets share
    a load evenly: the least sum of squares among all loads in balance.

    Raises CrankcheckError for inputs as `Train.influence`, a load on an input or on a body that the
    train lacks, and a self-locking train.
    """
    closing, speeds = tuple(inputs), train.speeds(inputs)
    for body in loads:
        if body not in train.bodies or body in closing:
            open_bodies = [one for one in train.bodies if one not in closing]
            why = "closes the balance" if body in closing else "is no moving body of the train"
            raise CrankcheckError(f"torque on {body}: it {why}; use {', '.join(open_bodies)}")
    seen: set[tuple[int, ...]] = set()
    # Who drives by pair: 1 the first gear, -1 the second, 0 without losses.
    choices = product(*((1, -1) if gear.efficiency < 1.0 else (0,) for gear in train.gears))
    for drives in islice(choices, MOST_TRIED):
        way = drives
        while way not in seen:  # the driving gears of the last loads are the next choice
            seen.add(way)
            found = _balanced(train, speeds, loads, closing, way)
            drawn = _driving(found, way)
            if drawn == way:
                return found
            way = drawn
    raise CrankcheckError(
        f"the train locks itself: with the losses of its teeth no torque on "
        f"{' and '.join(closing)} keeps it moving at these speeds against these loads; drive it at "
        "another body, turn it the other way, or raise the efficiency of its pairs"
    )


def _balanced(
    train: Train,
    speeds: Mapping[str, float],
    loads: Mapping[str, float],
    closing: tuple[str, ...],
    way: tuple[int, ...],
) -> TrainTorques:
    bodies = (GROUND, *train.bodies)
    rows = [_coefficients(gear, drives) for gear, drives in zip(train.gears, way, strict=True)]
    unknown = np.zeros((len(bodies), len(rows) + 1 + len(closing)))
    for n, body in enumerate(bodies):
        unknown[n, : len(rows)] = [row.get(body, 0.0) for row in rows]
    for k, body in enumerate((GROUND, *closing), start=len(rows)):
        unknown[bodies.index(body), k] = 1.0
    known = np.array([loads.get(body, 0.0) for body in bodies])
    solution = np.linalg.lstsq(unknown, -known, rcond=None)[0]
    size, outside = solution[: len(rows)], dict(zip(bodies, known.tolist(), strict=True))
    outside |= zip((GROUND, *closing), solution[len(rows) :].tolist(), strict=True)
    meshes = []
    for gear, row, load in zip(train.gears, rows, size.tolist(), strict=True):
        on = {body: load * c for body, c in row.items()}
        into = [-on[body] * (speeds[body] - speeds[gear.carrier]) for body in gear.bodies]
        meshes.append(MeshLoad(gear, on, max(into), sum(into), 1 if into[0] > 0.0 else -1))
    return TrainTorques(speeds, outside, tuple(meshes))


def _coefficients(gear: Gear, drives: int) -> Mapping[str, float]:
    first, second = float(gear.teeth[0]), gear.second * gear.efficiency**drives
    return {gear.bodies[0]: first, gear.bodies[1]: second, gear.carrier: -(first + second)}


def _driving(found: TrainTorques, way: tuple[int, ...]) -> tuple[int, ...]:
    """Return who drives by the loads found; a mesh without power keeps its choice."""
    nothing = NOTHING * max(mesh.rolling_w for mesh in found.meshes)
    return tuple(
        mesh.drives if drives and mesh.rolling_w > nothing else drives
        for mesh, drives in zip(found.meshes, way, strict=True)
    )
