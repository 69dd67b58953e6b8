"""Kinetostatics: the driving torque and the reactions in all joints of a known motion.

What acts on each body, its inertia among it, is put on free-body diagrams; the Assur groups are
solved in the reverse of their order of placing, in closed form (`analytic.forces.balance`), in
chunks as their motion was. Source: I. I. Artobolevskii, Theory of Mechanisms, on kinetostatics.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from analytic.dyads.chunk import Chunk
from analytic.dyads.driven import told
from analytic.dyads.plane import Real
from analytic.forces.applied_loads import apply_loads
from analytic.forces.balance import Balance
from analytic.forces.bounded import Bounded
from analytic.forces.dyad_balance import torque_of
from analytic.forces.force_arrays import ForceArrays
from analytic.forces.free_body import free_bodies
from analytic.forces.friction import LoadedBodies, coulomb_friction
from analytic.forces.given_motion import chunks_of
from analytic.forces.rubbing import Rubbing, put_constant_friction, rubbing_joints
from analytic.forces.springs import apply_springs
from analytic.forces.virtual_power import torque_by_power
from analytic.kinematics import chunks, unit_chunk
from analytic.structure.mobility import Structure, analyse
from models.array import Array
from models.errors import CrankcheckError, few
from models.forces import Forces
from models.friction import ConstantFriction
from models.motion import Motion
from models.samples import samples
from models.scene import Scene


def forces(
    scene: Scene,
    when: ArrayLike | Motion,
    *,
    bound: bool = True,
    skip_dead_points: bool = False,
) -> Forces:
    """The driving torque, and the reaction in every pin and slider.

    Parameters
    ----------
    scene : Scene
        The mechanism with its masses, gravity, loads and springs.
    when : ArrayLike or Motion
        Times [s], (T,), at which it follows its driver's law, or a motion of it, whole and with
        accelerations: one by `analytic.kinematics.solve_driven`, say.
    bound : bool
        Carry error bounds, which go on from those of the motion.
    skip_dead_points : bool
        Have no numbers (NaN), and infinite bounds, in dead points, and where friction locks the
        mechanism, instead of raising.

    Returns
    -------
    Forces
        With redundant links the torque alone, by virtual power: how such links share the load is
        not for statics to say. Friction of the scene is in torque and reactions; in a joint that
        does not move it is anywhere within its limits, taken as 0, and the bound says so.
        ``friction_solution`` says where Coulomb's has two equilibria; bounds are infinite where
        it is not shown to have one alone.

    Raises
    ------
    StructureError, ReachError
        As `analytic.kinematics.solve`.
    CrankcheckError
        A driver in a dead point, where torque and reactions are not determined, or where friction
        locks the mechanism; Coulomb's friction with redundant links; a scene without mass and load;
        a table of a load that does not reach as far as the motion; a motion that
        lacks something.
    """
    structure = analyse(scene)
    _check_loaded(scene)
    _check_friction(scene, structure)
    if isinstance(when, Motion):
        time_s, parts = when.time_s, chunks_of(scene, when, bound=bound)
    else:
        time_s = samples(when, "time_s")
        parts = chunks(scene, time_s, bound=bound)
    result = ForceArrays(time_s, structure, scene.sliders, scene.friction, bound=bound)
    for span, chunk in parts:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # singular positions
            _write(result, span, scene, structure, chunk)
        if result.locked(span).any() and not skip_dead_points:
            raise CrankcheckError(
                _locked(scene, chunk, time_s[span], int(np.argmax(result.locked(span))))
            )
        dead = result.not_finite(span)
        if not structure.redundant:
            for sine in chunk.sines.values():
                dead |= sine == 0.0
        if skip_dead_points:
            result.leave_out(span, dead)
        elif dead.any():
            raise CrankcheckError(_dead_point(scene, chunk, time_s[span], int(np.argmax(dead))))
    return result.forces(_undetermined(structure), scene.driver.effort_unit)


def _write(
    result: ForceArrays, span: slice, scene: Scene, structure: Structure, chunk: Chunk
) -> None:
    """The forces of a chunk."""
    free = free_bodies(scene, chunk)
    if scene.loads:
        apply_loads(scene, chunk, result.time_s[span], free)
    if scene.springs:
        apply_springs(scene, chunk, free)
    displaced = {
        name: Bounded(one.s, None if one.error is None else one.error.displacement)
        for name, one in chunk.sliders.items()
    }
    joints: list[Rubbing] = []
    if scene.friction:
        joints = list(rubbing_joints(scene, structure, chunk, free, displaced))
    friction = put_constant_friction(joints, free)
    left = [each for each in joints if each.law.joint not in friction]
    if structure.redundant:
        unit = unit_chunk(scene, chunk.theta, bound=chunk.certified)
        result.write(span, torque_by_power(free, unit, chunk), {}, {}, friction)
    elif not left:
        balance = Balance(scene, structure, free, displaced)
        result.write(span, torque_of(balance), balance.pins, balance.sliders, friction)
    else:
        bodies = LoadedBodies(scene, structure, displaced, free)
        sizes, solution = coulomb_friction(
            bodies, left, chunk.theta.size, certified=chunk.certified
        )
        balance, torque = bodies.equilibrium(zip(left, sizes, strict=True))
        friction |= {each.law.joint: size for each, size in zip(left, sizes, strict=True)}
        result.write(span, torque, balance.pins, balance.sliders, friction)
        result.write_solution(span, solution)


def _undetermined(structure: Structure) -> str:
    """Why there are no reactions, where there are none."""
    if not structure.redundant:
        return ""
    return (
        f"how redundant links ({structure.spare}) share the load depends on their stiffness and "
        "fit: statics leaves the reactions open, and determines the driving torque alone"
    )


def _check_loaded(scene: Scene) -> None:
    """Refuse a scene in which nothing makes a force."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    rubs = any(isinstance(one, ConstantFriction) for one in scene.friction.values())
    if not scene.loads and not scene.springs and not any(masses) and not rubs:
        raise CrankcheckError(
            f"{scene.name}: no link or slider has a mass and nothing loads them, so every force is "
            "0; give mass_kg to a link, or a [loads.NAME] table"
        )


def _check_friction(scene: Scene, structure: Structure) -> None:
    """Refuse friction that hangs on reactions which statics does not determine."""
    if structure.redundant and scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: friction.{scene.coulomb_joints[0]}: Coulomb's friction follows from "
            f"the reactions, and how redundant links ({structure.spare}) share them is open, so "
            "it can not be worked out; give torque_n_m or force_n, or leave the redundant links out"
        )


def _dead_point(scene: Scene, chunk: Chunk, time_s: Array, index: int) -> str:
    """Where the torque is not determined, by which dyad, and what would work."""
    place = told(scene, _at(chunk.theta, index))
    where = f"{scene.driver.joint} at {place} (t = {time_s[index]:.6g} s)"
    if all(abs(_at(sine, index)) > 0.0 for sine in chunk.sines.values()):
        return (
            f"{scene.name}: {where}: forces are larger than numbers go; take smaller loads, masses "
            "or lengths"
        )
    worst = min(
        chunk.sines,
        key=lambda key: np.nan_to_num(abs(_at(chunk.sines[key], index)), nan=0.0),
        default="",
    )
    dyad = f"the dyad at {worst} is singular there" if worst else "a dyad is singular there"
    return (
        f"{scene.name}: {where} stands in a dead point: {dyad}, so the driving torque and the "
        "reactions are not determined; leave that instant out, or drive another link"
    )


def _locked(scene: Scene, chunk: Chunk, time_s: Array, index: int) -> str:
    """Where friction holds against any torque, and what would work."""
    place = told(scene, _at(chunk.theta, index))
    return (
        f"{scene.name}: {scene.driver.joint} at {place} (t = {time_s[index]:.6g} s) locks "
        f"itself: friction in {few(scene.coulomb_joints, 6)} grows by more than what overcomes it, "
        "so no finite torque keeps it moving; leave that instant out, lessen mu, or drive another "
        "link"
    )


def _at(values: Real, index: int) -> float:
    return float(np.ravel(values)[index if np.size(values) > 1 else 0])
