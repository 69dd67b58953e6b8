"""With what shape the elastic links of a mechanism start that is let go.

Straight ones begin to ring at once. In the quasi-static shape the forces of elasticity are what the
links need to go along with the motion as if they were rigid: the second derivatives of all their
coefficients are 0 at the start, as their rates are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from analytic.multibody.assembly import Assembly
from analytic.multibody.dynamics import Dynamics
from analytic.multibody.outset import INDEPENDENT, Outset
from analytic.multibody.saddle import Saddle
from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import State

MOST_ROUNDS = 100
CLOSE = 1e-15
"""What a round may change a coefficient by, over the longest link, after which none is made."""


def bent_start(dynamics: Dynamics, near: State | None) -> tuple[Array, Array]:
    """Coordinates and rates (n,) of the start with links in their quasi-static shape.

    Raises
    ------
    CrankcheckError
        As `Outset.find`; links that are so soft that no such shape is found; links that the joints
        hold as they are.
    """
    assembly, outset = dynamics.assembly, Outset(dynamics.assembly)
    free, inverse = assembly.coefficients, np.linalg.inv(elastic_stiffness(assembly))
    q, rates = outset.find(near)
    _check_free(dynamics, q)
    last = np.inf
    for _ in range(MOST_ROUNDS):
        step = inverse @ _held(dynamics, free, q, rates)
        size = float(np.abs(step).max())
        if not size < assembly.scene.longest_m:
            break
        bent = q.copy()
        bent[free] += step
        q, rates = outset.find(near, bent)
        # Rounding of the forces over the stiffness is the least that a step is.
        floor = CLOSE * assembly.scene.longest_m
        if size <= floor or (size <= 1e3 * floor and size >= 0.5 * last):
            return q, rates
        last = size
    raise CrankcheckError(
        f"{assembly.scene.name}: its elastic links are too soft for a quasi-static shape to start "
        'with; give them shape = "straight" in [start]'
    )


def _check_free(dynamics: Dynamics, q: Array) -> None:
    """Raises CrankcheckError where the joints leave elastic links no shape to choose: more links
    than the motion needs, whose lengths say those of each other."""
    assembly = dynamics.assembly
    rows = assembly.joints.jacobian(assembly.at_rest(q[None]))[0]
    rows[:, assembly.coefficients] = 0.0
    if np.linalg.matrix_rank(assembly.scaled(rows), tol=INDEPENDENT) < dynamics.rank:
        raise CrankcheckError(
            f"{assembly.scene.name}: its joints hold {few(assembly.elastic, 6)} in shape, which is "
            'then not quasi-static of its own; give shape = "straight" in [start]'
        )


def _held(dynamics: Dynamics, free: NDArray[np.intp], q: Array, rates: Array) -> Array:
    """The forces on coefficients (k,) that keep their second derivatives 0."""
    assembly, at = dynamics.assembly, np.zeros(1)
    now = assembly.at_rates(q[None], rates[None])
    mass, right = assembly.weigh(now.q, now.rates)
    right += dynamics.forces.on(at, now)
    rows = np.zeros((assembly.joints.count + len(free), assembly.size))
    rows[: assembly.joints.count] = assembly.joints.jacobian(now)[0]
    rows[range(assembly.joints.count, len(rows)), free] = 1.0
    saddle = Saddle(mass[0], rows, redundant=dynamics.redundant)
    bottom = np.concatenate([assembly.joints.gamma(now)[0], np.zeros(len(free))])
    return saddle.solve(right[0], bottom)[1][assembly.joints.count :]


def elastic_stiffness(assembly: Assembly) -> Array:
    """Of all elastic links, for their coefficients, (k, k)."""
    each = [body.stiffness for body, _ in assembly.elastic.values()]
    whole, first = np.zeros((sum(map(len, each)),) * 2), 0
    for own in each:
        last = first + len(own)
        whole[first:last, first:last] = own
        first = last
    return whole
