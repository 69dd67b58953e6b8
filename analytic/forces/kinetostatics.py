"""Kinetostatics: the driving torque and the reactions in all joints of a known motion.

All forces on each body, with its inertia, are put on free-body diagrams; the Assur groups are
solved in the reverse of their order of placing, in closed form (`analytic.forces.free_body`), in
the chunks of their motion. Source: I. I. Artobolevskii, Theory of Mechanisms, on kinetostatics.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from numpy.typing import ArrayLike

from analytic.dyads.chunk import Chunk, told
from analytic.dyads.plane import sample
from analytic.forces.bounded import Bounded, BoundedVec
from analytic.forces.dyad_balance import torque_of
from analytic.forces.force_elements import (
    Rubbing,
    apply_springs,
    put_constant_friction,
    rubbing_joints,
    slide_stretch,
)
from analytic.forces.free_body import Balance, apply_loads, free_bodies
from analytic.forces.friction import CoulombSolution, LoadedBodies, coulomb_friction
from analytic.forces.given_motion import chunks_of
from analytic.forces.virtual_power import torque_by_power
from analytic.kinematics import chunks, unit_chunk
from analytic.result import put_bound
from analytic.structure.mobility import Structure, analyse
from models.array import Array, Mask, samples
from models.errors import CrankcheckError, few
from models.motion import ForceBound, Forces, FrictionSolution, Motion, SliderForces
from models.scene import Scene
from models.scene.loads import ConstantFriction, CoulombFriction, Friction


def forces(
    scene: Scene, when: ArrayLike | Motion, *, bound: bool = True, skip_dead_points: bool = False
) -> Forces:
    """Return the driving torque, and the reaction in every pin and slider.

    Parameters
    ----------
    scene : Scene
        The mechanism with its masses, gravity, loads and springs.
    when : ArrayLike or Motion
        Times [s], (T,), of its driver's law, or a whole motion with accelerations: one by
        `analytic.kinematics.solve_driven`, say.
    bound : bool
        Carry error bounds, which go on from those of the motion.
    skip_dead_points : bool
        Have no numbers (NaN), and infinite bounds, in dead points, and where friction locks the
        mechanism, instead of raising.

    Returns
    -------
    Forces
        With redundant links the torque alone, by virtual power: statics leaves open how such links
        share the load. Friction of the scene is in torque and reactions; in a joint that does not
        move it is anywhere within its limits, taken as 0, and the bound shows it.
        ``friction_solution`` marks two equilibria of Coulomb's friction; bounds are infinite where
        it is not shown to have one alone.

    Raises
    ------
    StructureError, ReachError
        As `analytic.kinematics.solve`.
    CrankcheckError
        A driver in a dead point, where torque and reactions are not determined, or where friction
        locks the mechanism; Coulomb's friction with redundant links; a scene without mass and load;
        a table of a load that does not reach as far as the motion; an incomplete motion.
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
    free = free_bodies(scene, chunk)
    if scene.loads:
        apply_loads(scene, chunk, result.time_s[span], free)
    if scene.springs:
        apply_springs(scene, chunk, free)
    displaced = {name: slide_stretch(chunk, name)[0] for name in chunk.sliders}
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
    if not structure.redundant:
        return ""
    return (
        f"how redundant links ({structure.spare}) share the load depends on their stiffness and "
        "fit: statics leaves the reactions open, and determines the driving torque alone"
    )


def _check_loaded(scene: Scene) -> None:
    masses = [link.mass_kg or link.inertia_kg_m2 for link in scene.links.values()]
    masses += [slider.mass_kg or slider.inertia_kg_m2 for slider in scene.sliders.values()]
    rubs = any(isinstance(one, ConstantFriction) for one in scene.friction.values())
    if not scene.loads and not scene.springs and not any(masses) and not rubs:
        raise CrankcheckError(
            f"{scene.name}: no link or slider has a mass and nothing loads them, so every force is "
            "0; give mass_kg to a link, or a [loads.NAME] table"
        )


def _check_friction(scene: Scene, structure: Structure) -> None:
    """Refuse friction that depends on reactions which statics does not determine."""
    if structure.redundant and scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: friction.{scene.coulomb_joints[0]}: Coulomb's friction follows from "
            f"the reactions, and how redundant links ({structure.spare}) share them is open, so "
            "it can not be computed; give torque_n_m or force_n, or leave the redundant links "
            "out"
        )


def _dead_point(scene: Scene, chunk: Chunk, time_s: Array, index: int) -> str:
    place = told(scene, sample(chunk.theta, index))
    where = f"{scene.driver.joint} at {place} (t = {time_s[index]:.6g} s)"
    if all(abs(sample(sine, index)) > 0.0 for sine in chunk.sines.values()):
        return (
            f"{scene.name}: {where}: forces are larger than numbers go; take smaller loads, masses "
            "or lengths"
        )
    worst = min(
        chunk.sines,
        key=lambda key: np.nan_to_num(abs(sample(chunk.sines[key], index)), nan=0.0),
        default="",
    )
    dyad = f"the dyad at {worst} is singular there" if worst else "a dyad is singular there"
    return (
        f"{scene.name}: {where} stands in a dead point: {dyad}, so the driving torque and the "
        "reactions are not determined; leave that instant out, or drive another link"
    )


def _locked(scene: Scene, chunk: Chunk, time_s: Array, index: int) -> str:
    place = told(scene, sample(chunk.theta, index))
    return (
        f"{scene.name}: {scene.driver.joint} at {place} (t = {time_s[index]:.6g} s) locks "
        f"itself: friction in {few(scene.coulomb_joints, 6)} grows by more than the torque "
        "against it, so no finite torque keeps it moving; leave that instant out, reduce mu, "
        "or drive another link"
    )


class ForceArrays:
    """Arrays of forces while they are filled; of redundant scenes the torque alone."""

    def __init__(
        self,
        time_s: Array,
        structure: Structure,
        sliders: Iterable[str],
        friction: Mapping[str, Friction],
        *,
        bound: bool,
    ) -> None:
        self.time_s, self.certified = time_s, bound
        count = len(time_s)
        held = {} if structure.redundant else structure.pins
        slid = () if structure.redundant else tuple(sliders)
        self.torque = np.empty(count)
        self.pins = {p: {b: np.empty((2, count)).T for b in names} for p, names in held.items()}
        self.sliders = {s: SliderForces(np.empty(count), np.empty(count)) for s in slid}
        self.friction = {joint: np.empty(count) for joint in friction}
        self.solution: FrictionSolution | None = None
        if any(isinstance(law, CoulombFriction) for law in friction.values()):
            self.solution = FrictionSolution(*(np.zeros(count) for _ in range(3)))
        if bound:
            self.bound = ForceBound(
                {p: {b: np.empty(count) for b in names} for p, names in held.items()},
                {s: SliderForces(np.empty(count), np.empty(count)) for s in slid},
                np.empty(count),
                {joint: np.empty(count) for joint in friction},
            )

    def write(
        self,
        span: slice,
        torque: Bounded,
        pins: Mapping[str, Mapping[str, BoundedVec]],
        sliders: Mapping[str, tuple[Bounded, Bounded]],
        friction: Mapping[str, Bounded],
    ) -> None:
        """Store the forces of a chunk."""
        self.torque[span] = torque.value
        for joint, series in self.friction.items():
            series[span] = friction[joint].value
        for point, by_body in self.pins.items():
            for body, array in by_body.items():
                v = pins[point][body].v
                array[span, 0], array[span, 1] = v.x, v.y
        for name, one in self.sliders.items():
            one.normal[span], one.moment[span] = (each.value for each in sliders[name])
        if not self.certified:
            return
        put_bound(self.bound.torque[span], torque.error)
        for point, limits in self.bound.pins.items():
            for body, limit in limits.items():
                put_bound(limit[span], pins[point][body].error)
        for name, most in self.bound.sliders.items():
            for array, each in zip((most.normal, most.moment), sliders[name], strict=True):
                put_bound(array[span], each.error)
        for joint, limit in self.bound.friction.items():
            put_bound(limit[span], friction[joint].error)

    def write_solution(self, span: slice, found: CoulombSolution) -> None:
        """Store the solution of a chunk's friction."""
        assert self.solution is not None
        self.solution.solutions[span] = found.solutions
        self.solution.iterations[span] = found.iterations
        self.solution.change[span] = found.change

    def locked(self, span: slice) -> Mask:
        """Return the samples of a chunk at which no finite torque overcomes the friction."""
        if self.solution is None:
            return np.zeros(len(self.torque[span]), np.bool_)
        return np.asarray(self.solution.solutions[span] == 0.0)

    def not_finite(self, span: slice) -> Mask:
        """Return the samples of a chunk at which a force is not finite, by the sum of them; two
        forces of a pin that are opposite count once."""
        total = self.torque[span].copy()
        for by_body in self.pins.values():
            array = next(iter(by_body.values()))
            total += array[span, 0]
            total += array[span, 1]
        for one in self.sliders.values():
            total += one.normal[span]
            total += one.moment[span]
        return np.asarray(~np.isfinite(total))

    def leave_out(self, span: slice, samples: Mask) -> None:
        """Set NaN at some samples of a chunk, and infinite bounds."""
        for array in _arrays(self):
            array[span][samples] = np.nan
        if self.certified:
            for array in _arrays(self.bound):
                array[span][samples] = np.inf

    def forces(self, undetermined: str, drive_unit: str) -> Forces:
        """Return the filled arrays as forces."""
        bound = self.bound if self.certified else None
        return Forces(
            self.time_s,
            self.pins,
            self.sliders,
            self.torque,
            bound,
            undetermined,
            self.friction,
            self.solution,
            drive_unit=drive_unit,
        )


def _arrays(of: ForceArrays | ForceBound) -> Iterator[Array]:
    yield of.torque
    for by_body in of.pins.values():
        yield from by_body.values()
    for one in of.sliders.values():
        yield from (one.normal, one.moment)
    yield from of.friction.values()
