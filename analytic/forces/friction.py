"""Coulomb's friction of a chunk, from the equilibrium that it is part of."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from analytic.dyads.plane import Real
from analytic.forces.balance import Balance, Displaced
from analytic.forces.bounded import Bounded, BoundedVec
from analytic.forces.coulomb import (
    CoulombErrors,
    CoulombSolution,
    CoulombSystem,
    coulomb_bound,
    solve_coulomb,
)
from analytic.forces.dyad_balance import torque_of
from analytic.forces.free_body import FreeBody
from analytic.forces.rubbing import Rubbing
from analytic.structure.mobility import Structure
from models.array import Array
from models.friction import CoulombFriction
from models.scene import Scene


@dataclass(frozen=True)
class LoadedBodies:
    """A chunk whose bodies are loaded, to be solved for what else acts on them."""

    scene: Scene
    structure: Structure
    displaced: Displaced
    free: Mapping[str, FreeBody]

    def equilibrium(
        self, friction: Iterable[tuple[Rubbing, Bounded]] = ()
    ) -> tuple[Balance, Bounded]:
        """The equilibrium of the loads and of friction, and the driving torque."""
        return self._balance({name: copy(body) for name, body in self.free.items()}, friction)

    def influence(self, rubbing: Rubbing) -> Balance:
        """The equilibrium of friction of size 1 in one joint, and of nothing else."""
        bare = {name: FreeBody(body.body, body.centre) for name, body in self.free.items()}
        return self._balance(bare, [(rubbing, Bounded(1.0))])[0]

    def _balance(
        self, free: dict[str, FreeBody], friction: Iterable[tuple[Rubbing, Bounded]]
    ) -> tuple[Balance, Bounded]:
        for rubbing, size in friction:
            rubbing.put(free, size)
        balance = Balance(self.scene, self.structure, free, self.displaced)
        return balance, torque_of(balance)


def coulomb_friction(
    bodies: LoadedBodies, joints: Sequence[Rubbing], count: int, *, certified: bool
) -> tuple[list[Bounded], CoulombSolution]:
    """Coulomb's friction in all of its joints, with signs, at the samples of a chunk."""
    alone, _ = bodies.equilibrium()
    base = [_joined(rubbing.reaction(alone), count) for rubbing in joints]
    by_joint = [bodies.influence(rubbing) for rubbing in joints]
    rows = [[_joined(one.reaction(of), count) for of in by_joint] for one in joints]
    signs = np.stack([rubbing.against.value for rubbing in joints], axis=1)
    unsigned = np.stack([np.stack([v for v, _ in row], axis=1) for row in rows], axis=1)
    influence = unsigned * signs[:, None, :, None]
    mu = np.array([_factor(rubbing) for rubbing in joints])
    system = CoulombSystem(np.stack([v for v, _ in base], axis=1), influence, mu)
    solution = solve_coulomb(system)
    values = signs * solution.g
    if not certified:
        return [Bounded(values[:, k], None) for k in range(len(joints))], solution
    errors = CoulombErrors(
        np.stack([error for _, error in base], axis=1),
        np.stack([np.stack([error for _, error in row], axis=1) for row in rows], axis=1),
        np.stack([_series(rubbing.against.error, count) for rubbing in joints], axis=1),
    )
    sizes = np.hypot(unsigned[..., 0], unsigned[..., 1])
    off = coulomb_bound(system, errors, solution.g, sizes) + errors.against * solution.g
    return [Bounded(values[:, k], off[:, k]) for k in range(len(joints))], solution


def _factor(rubbing: Rubbing) -> float:
    """The friction over the reaction: mu of a slider, the radius of a pin's friction circle."""
    assert isinstance(rubbing.law, CoulombFriction)
    return rubbing.law.mu if rubbing.pair is not None else rubbing.law.arm_m


def _joined(reaction: BoundedVec | Bounded, count: int) -> tuple[Array, Array]:
    """A reaction as vectors (T, 2), that of a slider along x, and what it may be wrong by (T,)."""
    if isinstance(reaction, Bounded):
        x, y = reaction.value, 0.0
    else:
        x, y = reaction.v.x, reaction.v.y
    vectors = np.stack([_series(x, count), _series(y, count)], axis=1)
    return vectors, _series(0.0 if reaction.error is None else reaction.error, count)


def _series(values: Real, count: int) -> Array:
    return np.broadcast_to(np.asarray(values, dtype=np.float64), (count,))
