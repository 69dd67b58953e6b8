"""Free motion of a mechanism of any mobility, by the equations of motion of all its bodies."""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.assembly import RIGID, Assembly
from analytic.multibody.bodies import Flexible
from analytic.multibody.dynamics import Dynamics, Saddle
from analytic.multibody.generalised_forces import GeneralisedForces
from analytic.multibody.multibody_motion import Method, MultibodyMotion, Projection
from analytic.multibody.outset import INDEPENDENT, Outset
from models.array import Array
from models.errors import CrankcheckError, few
from models.motion import State
from models.scene import Scene
from models.scene.driver import check_duration

Acting = Callable[[Assembly, Array], GeneralisedForces]
PROJECTED = Projection()
LIGHT = 1e-12
"""Mass of a freedom over that of the heaviest, below which it counts as none."""


def release_multibody(
    scene: Scene,
    until_s: float,
    method: Method = PROJECTED,
    *,
    near: State | None = None,
) -> MultibodyMotion:
    """Prepare the free motion of a scene of rigid links from its start.

    Parameters
    ----------
    scene : Scene
        A mechanism of any mobility, with its masses. A driver that follows a law is released at
        time 0 of it.
    until_s : float
        Duration [s].
    method : Method
        `Projection` is good to about 1e-11 times the sensitivity; `Baumgarte` shows its cost.
    near : State or None
        First guess of the start's position; None for a scene that names the angles of its links in
        ``[start]``.

    Raises
    ------
    CrankcheckError
        A start that is open, incomplete, or in a change point; speeds that contradict each other; a
        freedom without mass; friction; an invalid time; an integration that fails.
    """
    check_duration(scene.name, until_s)
    if scene.cams:
        raise CrankcheckError(
            f"{scene.name}: cams ({', '.join(scene.cams)}) are not among the equations of all "
            "bodies; take a mechanism of one freedom, which is solved group by group"
        )
    dynamics, q, rates = ready(scene, near)
    return MultibodyMotion(dynamics, method, float(until_s), (q, rates))


def ready(
    scene: Scene,
    near: State | None,
    flexible: Mapping[str, Flexible] = RIGID,
    acting: Acting = GeneralisedForces,
) -> tuple[Dynamics, Array, Array]:
    """Return the equations of a scene, and its coordinates and rates (n,) at the start.

    ``flexible`` makes the bodies of its elastic links (`analytic.elastic.discretisation`), by name,
    ``acting`` the forces on an assembly at its start (n,); the rest as in `release_multibody`.
    """
    if scene.friction:
        raise CrankcheckError(
            f"{scene.name}: friction in {', '.join(scene.friction)}, which the equations of motion "
            "with multipliers do not have here; leave it out, or give dampers"
        )
    _check_elastic(scene, flexible)
    assembly = Assembly(scene, flexible)
    outset = Outset(assembly)
    q, rates = outset.find(near)
    free = outset.freedoms(q)
    dynamics = Dynamics(assembly, acting(assembly, q), assembly.size - len(free))
    _check_start(dynamics, q, free)
    if flexible and scene.start.shape != "straight":
        q, rates = bent_start(dynamics, near)
    return dynamics, q, rates


def _check_elastic(scene: Scene, flexible: Mapping[str, Flexible]) -> None:
    """Raise CrankcheckError for elastic links without a description, a start of driven scenes."""
    if missing := [name for name in scene.elastic if name not in flexible]:
        raise CrankcheckError(
            f"{scene.name}: {few(missing, 6)} is elastic, and would be taken as rigid here; solve "
            "it with analytic.elastic.released, or take [elastic] out"
        )
    if flexible and scene.start.shape == "periodic":
        raise CrankcheckError(
            f'{scene.name}: free motion has no known period; give shape = "quasi-static" or '
            '"straight" in [start]'
        )


def _check_start(dynamics: Dynamics, q: Array, directions: Array) -> None:
    """Refuse a start in a change point, and a freedom without mass. Raises CrankcheckError."""
    assembly, count = dynamics.assembly, len(directions)
    if count == 0:
        raise CrankcheckError(f"{assembly.scene.name}: nothing can move; it has no freedom")
    mass = assembly.mass(q[None])[0]
    masses = np.linalg.eigvalsh(directions @ mass @ directions.T)
    # In the units of coordinates: small mechanisms have small moments of inertia.
    heaviest = np.abs(mass * np.outer(assembly.units, assembly.units)).max()
    if masses[0] <= LIGHT * max(masses[-1], heaviest):
        raise CrankcheckError(
            f"{assembly.scene.name}: {int((masses <= LIGHT * masses[-1]).sum()) or 1} of its "
            f"{count} freedoms moves nothing that has a mass; give links or sliders a mass"
        )
    if dynamics.redundant and _freer(dynamics, q, directions):
        raise CrankcheckError(
            f"{assembly.scene.name}: it starts in a change point, where it can continue in "
            "several ways, and its accelerations are not determined; start beside it"
        )


def _freer(dynamics: Dynamics, q: Array, directions: Array) -> bool:
    """True if a position has more freedoms than those next to it."""
    outset = Outset(dynamics.assembly)
    for direction in directions:
        beside = dynamics.closed((q + 1e-3 * direction)[None], np.zeros((1, len(q))))[0][0]
        if len(outset.freedoms(beside)) < len(directions):
            return True
    return False


MOST_ROUNDS = 100
CLOSE = 1e-15
"""Largest change of a coefficient in the last round, over the longest link."""


def bent_start(dynamics: Dynamics, near: State | None) -> tuple[Array, Array]:
    """Return coordinates and rates (n,) of the start with links in their quasi-static shape.

    Raises
    ------
    CrankcheckError
        As `Outset.find`; links too soft for such a shape; links whose shape the joints hold.

    Straight links begin to ring at once. In the quasi-static shape the elastic forces move the
    links along as if they were rigid: the second derivatives of all their coefficients are 0 at the
    start, as their rates are.
    """
    assembly, outset = dynamics.assembly, Outset(dynamics.assembly)
    stiffness = block_diag(*(body.stiffness for body, _ in assembly.elastic.values()))
    free, inverse = assembly.coefficients, np.linalg.inv(stiffness)
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
        # The least step is rounding of the forces over the stiffness.
        floor = CLOSE * assembly.scene.longest_m
        if size <= floor or (size <= 1e3 * floor and size >= 0.5 * last):
            return q, rates
        last = size
    raise CrankcheckError(
        f"{assembly.scene.name}: its elastic links are too soft for a quasi-static shape to start "
        'with; give them shape = "straight" in [start]'
    )


def _check_free(dynamics: Dynamics, q: Array) -> None:
    """Refuse joints that leave elastic links no free shape: more links than the motion needs, whose
    lengths determine each other. Raises CrankcheckError."""
    assembly = dynamics.assembly
    rows = assembly.joints.jacobian(assembly.at_rest(q[None]))[0]
    rows[:, assembly.coefficients] = 0.0
    if np.linalg.matrix_rank(assembly.scaled(rows), tol=INDEPENDENT) < dynamics.rank:
        raise CrankcheckError(
            f"{assembly.scene.name}: its joints hold {few(assembly.elastic, 6)} in shape, which is "
            'then not quasi-static of its own; give shape = "straight" in [start]'
        )


def _held(dynamics: Dynamics, free: NDArray[np.intp], q: Array, rates: Array) -> Array:
    """Return the forces on coefficients (k,) that keep their second derivatives 0."""
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
