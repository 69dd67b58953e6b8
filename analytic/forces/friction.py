"""Coulomb's friction of a chunk, from the equilibrium that it is part of.

With its sizes g >= 0 in the m joints, the reactions without it, N0, and those by friction of size 1
in joint k alone, B_k, equilibrium being linear::

    g_j = mu_j |N0_j + sum_k B_jk g_k|        (N a number in a slider, a vector in a pin)

Where the matrix mu_j |B_jk| has a spectral radius below 1 the right side contracts: there is one
solution, and repeated substitution leads to it from anywhere. For given directions of the reactions
the equations are linear, and solving them is Newton's step; of both steps the one with the smaller
residual is taken. Elsewhere there may be no solution, two or more: friction then holds against any
drive, or a mechanism may jam, as the sliding rod of P. Painleve does (C. R. Acad. Sci. 121, 1895).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from analytic.dyads.plane import EPS, Real
from analytic.forces.bounded import Bounded, BoundedVec
from analytic.forces.dyad_balance import torque_of
from analytic.forces.force_elements import Rubbing
from analytic.forces.free_body import Balance, Displaced, FreeBody
from analytic.structure.mobility import Structure
from models.array import Array, Mask
from models.scene import Scene
from models.scene.loads import CoulombFriction


@dataclass(frozen=True)
class LoadedBodies:
    """Chunk with loaded bodies, to be solved for the reactions."""

    scene: Scene
    structure: Structure
    displaced: Displaced
    free: Mapping[str, FreeBody]

    def equilibrium(
        self, friction: Iterable[tuple[Rubbing, Bounded]] = ()
    ) -> tuple[Balance, Bounded]:
        """Return the equilibrium of the loads and of friction, and the driving torque."""
        return self._balance({name: copy(body) for name, body in self.free.items()}, friction)

    def influence(self, rubbing: Rubbing) -> Balance:
        """Return the equilibrium of friction of size 1 in one joint, and of no other force."""
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
    """Return Coulomb's friction in all of its joints, with signs, at the samples of a chunk."""
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
    """Return the friction over the reaction: mu, or the radius of a pin's friction circle."""
    assert isinstance(rubbing.law, CoulombFriction)
    return rubbing.law.mu if rubbing.pair is not None else rubbing.law.arm_m


def _joined(reaction: BoundedVec | Bounded, count: int) -> tuple[Array, Array]:
    """Return a reaction as vectors (T, 2), that of a slider along x, and its error (T,)."""
    if isinstance(reaction, Bounded):
        x, y = reaction.value, 0.0
    else:
        x, y = reaction.v.x, reaction.v.y
    vectors = np.stack([_series(x, count), _series(y, count)], axis=1)
    return vectors, _series(0.0 if reaction.error is None else reaction.error, count)


def _series(values: Real, count: int) -> Array:
    return np.broadcast_to(np.asarray(values, dtype=np.float64), (count,))


MOST = 60
"""Most steps: Newton's take some five; plain ones are as many as a contraction needs."""
SETTLED = 1e-13
"""Change over the largest friction at which iteration ends."""
SEARCHED, SOLVED = 30, 1e-9
"""Number of steps from each of many starts of a search, and the residual of a solution, over
itself."""
MOST_STARTS = 64


@dataclass(frozen=True)
class CoulombSystem:
    """Equations at T samples: ``alone`` N0 (T, m, 2), ``influence`` B (T, m, m, 2), by joint and by
    rubbing joint, and ``mu`` (m,), [m] in a pin."""

    alone: Array
    influence: Array
    mu: Array

    def reactions(self, g: Array) -> Array:
        return np.asarray(self.alone + np.einsum("tjkx,tk->tjx", self.influence, g))

    def friction(self, g: Array) -> Array:
        """Return the right side of the equations."""
        return np.asarray(self.mu * _length(self.reactions(g)))

    def gains(self) -> Array:
        """Return mu_j |B_jk|, (T, m, m)."""
        return np.asarray(self.mu[:, None] * _length(self.influence))

    def along(self, direction: Array) -> Array:
        """Take Newton's step: the solution where the reactions have these directions, (T, m, 2)."""
        slope = self.mu[:, None] * np.einsum("tjx,tjkx->tjk", direction, self.influence)
        right = self.mu * np.einsum("tjx,tjx->tj", direction, self.alone)
        return solve_small(np.eye(len(self.mu)) - slope, right)

    def at(self, samples: Mask) -> CoulombSystem:
        return CoulombSystem(self.alone[samples], self.influence[samples], self.mu)


@dataclass(frozen=True)
class CoulombSolution:
    """Sizes of friction ``g`` (T, m), NaN where there is no solution; by sample the number of
    solutions (0, 1, 2: two or more), the steps taken and the last change over the largest g."""

    g: Array
    solutions: Array
    iterations: Array
    change: Array


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # dead points, searches that fail
def solve_coulomb(system: CoulombSystem) -> CoulombSolution:
    """Solve for the friction in all joints.

    Without a contraction, solutions are searched from every set of directions (up to `MOST_STARTS`
    of them): all are found in one joint, and in six sliders; with pins among several joints some
    may be missed. Of two the one with the least friction is returned.
    """
    finite = np.isfinite(system.alone).all(axis=(1, 2))
    finite &= np.isfinite(system.influence).all(axis=(1, 2, 3))
    contracts = finite & np.all(weights(system.gains()) > 0.0, axis=1)
    count = len(system.alone)
    g, change = np.full((count, len(system.mu)), np.nan), np.full(count, np.nan)
    solutions, iterations = np.zeros(count), np.zeros(count)
    if contracts.any():
        solutions[contracts] = 1
        part = _contracted(system.at(contracts))
        g[contracts], iterations[contracts], change[contracts] = part
    other = ~contracts & finite
    if other.any():
        g[other], solutions[other], change[other] = _searched(system.at(other))
        iterations[other] = SEARCHED
    solutions[~finite] = 1  # a dead point, which has its own words
    return CoulombSolution(g, solutions, iterations, change)


def weights(gains: Array) -> Array:
    """Return w with (1 - gains) w = 1, (T, m): all above 0 where, and only where, the spectral
    radius of the gains is below 1 (A. Berman, R. J. Plemmons, Nonnegative Matrices, chapter 6)."""
    ones = np.ones(gains.shape[:2])
    return np.nan_to_num(solve_small(np.eye(gains.shape[1]) - gains, ones), nan=-1.0)


def solve_small(matrices: Array, right: Array) -> Array:
    """Return the solutions of small systems (T, m, m) x = (T, m); NaN where one is singular."""
    if right.shape[1] == 1:
        return np.where(matrices[:, :, 0] == 0.0, np.nan, right / matrices[:, :, 0])
    determinants = np.linalg.det(matrices)
    regular = np.isfinite(determinants) & (determinants != 0.0)
    usable = np.where(regular[:, None, None], matrices, np.eye(right.shape[1]))
    x = np.linalg.solve(usable, right[:, :, None])[:, :, 0]
    return np.where(regular[:, None], x, np.nan)


def _contracted(system: CoulombSystem) -> tuple[Array, Array, Array]:
    """Return the one solution where the equations contract, with the steps and the last change."""
    weight = weights(system.gains())

    def left(g: Array) -> Array:
        """Return the residual in the norm in which they contract; not finite is far."""
        off = np.max(np.abs(system.friction(g) - g) / weight, axis=1)
        return np.where(np.isfinite(off), off, np.inf)

    g = system.friction(np.zeros_like(weight))
    iterations, change = np.zeros(len(g)), np.full(len(g), np.inf)
    for _ in range(MOST):
        moving = change > SETTLED
        if not moving.any():
            break
        plain, newton = system.friction(g), system.along(_directions(system.reactions(g)))
        better = left(newton) < left(plain)
        after = np.where((better & moving)[:, None], newton, np.where(moving[:, None], plain, g))
        largest = np.max(np.abs(after), axis=1)
        step = np.max(np.abs(after - g), axis=1) / np.where(largest > 0.0, largest, 1.0)
        change = np.where(moving, step, change)
        iterations += moving
        g = after
    return g, iterations, change


def _searched(system: CoulombSystem) -> tuple[Array, Array, Array]:
    """Return the solution of least friction, the number of solutions, and its relative residual."""
    count = len(system.alone)
    least, open_ = np.full((count, len(system.mu)), np.nan), np.full(count, np.nan)
    solutions = np.zeros(count)
    for start in _starts(system):
        g = start
        for _ in range(SEARCHED):
            g = system.along(_directions(system.reactions(g)))
        size = np.max(np.abs(g), axis=1)
        off = np.max(np.abs(system.friction(g) - g), axis=1) / np.where(size > 0.0, size, 1.0)
        valid = (off <= SOLVED) & np.all(g >= -SOLVED * size[:, None], axis=1)
        total, known = np.sum(g, axis=1), np.sum(least, axis=1)
        new = valid & ~(np.abs(total - known) <= 1e-6 * np.abs(known))
        solutions += new & (solutions < 2)
        lower = new & ~(total > known)
        least[lower], open_[lower] = g[lower], off[lower]
    return least, solutions, open_


def _starts(system: CoulombSystem) -> list[Array]:
    """Return the starts: no friction; endless friction, the same in all joints; and the solutions
    for directions along and against the reactions without friction, in every mixture of joints."""
    own, count = _directions(system.alone), len(system.mu)
    signs = itertools.islice(itertools.product((1.0, -1.0), repeat=count), MOST_STARTS)
    starts = [system.along(own * np.array(each)[:, None]) for each in signs]
    endless = system.along(_directions(np.sum(system.influence, axis=2)))
    return [np.zeros_like(endless), endless, *starts]


def _directions(vectors: Array) -> Array:
    """Return unit vectors, and 0 for vectors without a direction."""
    length = _length(vectors)[..., None]
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def _length(vectors: Array) -> Array:
    return np.asarray(np.hypot(vectors[..., 0], vectors[..., 1]))


@dataclass(frozen=True)
class CoulombErrors:
    """Errors of the equations: ``alone`` (T, m), ``influence`` (T, m, m), and the directions of
    friction, ``against`` (T, m), whose size counts in ``influence`` as 1."""

    alone: Array
    influence: Array
    against: Array


def coulomb_bound(system: CoulombSystem, errors: CoulombErrors, g: Array, sizes: Array) -> Array:
    """Return the error bound of the friction ``g``, (T, m); infinite without a contraction.

    The equations give e <= D e + b for the error e of g, with the largest gains D, and b for the
    residual of g and the errors of its equations. Any e > 0 with (1 - D) e >= b is a bound.
    ``sizes`` (T, m, m) is |B_jk| whatever the directions of friction are.
    """
    reach = sizes + errors.influence
    gains = system.mu[:, None] * (1.0 + 8 * EPS) * reach
    moved = np.einsum("tjk,tk->tj", reach, errors.against * g)
    moved += np.einsum("tjk,tk->tj", errors.influence, g) + errors.alone
    rounded = 8 * EPS * (_length(system.alone) + np.einsum("tjk,tk->tj", sizes, g))
    left = np.abs(system.friction(g) - g)
    b = 1.001 * (system.mu * (moved + rounded) + left) + 1e-300
    error = 1.001 * solve_small(np.eye(g.shape[1]) - gains, b)
    holds = (error > 0.0) & (error - np.einsum("tjk,tk->tj", gains, error) >= b)
    return np.where(np.all(holds, axis=1)[:, None], error, np.inf)
