"""A compiled model with its planar linkage."""

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from models.array import Array
from models.mjcf.tree import Freedom, Limb
from models.motion import State
from models.scene import GROUND, Scene
from models.scene.joints import blocks, sliding_angle
from sim.mujoco.own_model.component import PlanarJoint
from sim.mujoco.own_model.driven_loop import WORLD, reading
from sim.mujoco.own_model.linkage import Linkage, Placement, pair, size
from sim.mujoco.own_model.scene import Matter, SceneRead


@dataclass(frozen=True)
class Limbs:
    """Limbs, parents before children, and the joint of each of their freedoms, in this order;
    ``shown`` maps a body of the scene to its limb, ``of`` a limb to its body."""

    limbs: tuple[Limb, ...]
    joints: tuple[PlanarJoint, ...]
    shown: Mapping[str, str]
    of: Mapping[str, str]


def limbs_of(linkage: Linkage, read: SceneRead) -> Limbs:
    """Make the limbs of a linkage: each has the frame of its body in the scene."""
    model = linkage.component.model
    called = {WORLD: GROUND}
    own: dict[int, Placement] = {WORLD: Placement()}
    limbs, shown, of = [], {}, {}
    for body in linkage.component.bodies:
        link, placement = linkage.placements[body.id]
        first = body.id == link
        called[body.id] = read.names[link] if first else f"{read.names[link]}: {body.id}"
        own[body.id] = read.frames[link].after(placement)
        of[called[body.id]] = read.names[link]
        if first:
            shown[read.names[link]] = called[body.id]
        mine, base = own[body.id], own[body.parent]
        freedoms = []
        for joint in body.joints:
            at = joint.columns[0]
            ref = joint.sense * float(model.qpos0[at]) if at < model.nq else 0.0
            axis = 0.0 if joint.kind == "hinge" else cmath.phase(mine.turn * joint.direction)
            freedoms.append(
                Freedom(joint.name, joint.kind, pair(mine(joint.anchor)), axis, ref, 0.0)
            )
        drawn = -mine.shift / mine.turn
        angle = cmath.phase(base.turn / mine.turn)
        limbs.append(
            Limb(called[body.id], called[body.parent], pair(base(drawn)), angle, tuple(freedoms))
        )
    joints = tuple(joint for body in linkage.component.bodies for joint in body.joints)
    return Limbs(tuple(limbs), joints, shown, of)


@dataclass(frozen=True)
class _Moving:
    """A frame in the plane: place, angle, and their first and second rates."""

    place: complex
    theta: float
    speed: complex
    omega: float
    push: complex
    alpha: float


STILL = _Moving(0j, 0.0, 0j, 0.0, 0j, 0.0)


def coordinates(
    limbs: Limbs, scene: Scene, state: State, near: Array
) -> tuple[Array, Array, Array]:
    """Return joint coordinates with their first and second rates at a state, (n,) each, in the
    order of the freedoms and in the senses of the scene; hinges get the whole turns that bring them
    nearest to the coordinates ``near``."""
    moving = {GROUND: STILL} | _moving(scene, state)
    rows: list[Row] = []
    for limb in limbs.limbs:
        base = moving[limbs.of.get(limb.parent, GROUND)]
        rows += _joints(limb, _seen_from(base, moving[limbs.of[limb.body]]))
    q, rate, push = np.array(rows).T
    hinges = [freedom.kind == "hinge" for limb in limbs.limbs for freedom in limb.freedoms]
    turns = np.where(hinges, np.round((near - q) / math.tau), 0.0)
    return q + math.tau * turns, rate, push


def _moving(scene: Scene, state: State) -> dict[str, _Moving]:
    frames: dict[str, _Moving] = {GROUND: STILL}
    for link in scene.links.values():
        theta, omega, alpha = (each[link.name] for each in (state.theta, state.omega, state.alpha))
        point = next((name for name in link.points), None)
        if point is None:
            continue
        arm = complex(*link.points[point]) * cmath.exp(1j * theta)
        frames[link.name] = _placed(state, point, arm, theta, omega, alpha)
    for name, slider in blocks(scene).items():
        guide = frames[slider.on]
        theta = guide.theta + sliding_angle(slider)
        frames[name] = _placed(state, slider.point, 0j, theta, guide.omega, guide.alpha)
    return frames


def _placed(
    state: State, point: str, arm: complex, theta: float, omega: float, alpha: float
) -> _Moving:
    """Return the frame from which a point of its body is at ``arm``."""
    place, speed, push = (
        complex(*each[point]) for each in (state.position, state.velocity, state.acceleration)
    )
    speed, push = speed - 1j * omega * arm, push - (1j * alpha - omega**2) * arm
    return _Moving(place - arm, theta, speed, omega, push, alpha)


def _seen_from(base: _Moving, body: _Moving) -> _Moving:
    back = cmath.exp(-1j * base.theta)
    place = body.place - base.place
    turning = 1j * base.omega
    speed = body.speed - base.speed - turning * place
    push = body.push - base.push - (1j * base.alpha - base.omega**2) * place - 2 * turning * speed
    return _Moving(
        back * place,
        body.theta - base.theta,
        back * speed,
        body.omega - base.omega,
        back * push,
        body.alpha - base.alpha,
    )


Row = tuple[float, float, float]
"""A joint coordinate, and its first and second rates."""


def _joints(limb: Limb, seen: _Moving) -> list[Row]:
    """Return the joint coordinates of a limb, from their refs on, by its motion in its parent."""
    turn = math.remainder(seen.theta - limb.angle_rad, math.tau)
    angle, place = limb.angle_rad, complex(*limb.offset)
    pivot, after = place, False
    axes: list[complex] = []
    late: list[bool] = []
    for freedom in limb.freedoms:
        frame = cmath.exp(1j * angle)
        if freedom.kind == "slide":
            axes.append(frame * complex(*freedom.axis))
            late.append(after)
            continue
        pivot = place + frame * complex(*freedom.anchor)
        angle += turn
        place = pivot - cmath.exp(1j * angle) * complex(*freedom.anchor)
        after = True
    slid = _split(axes, seen.place - place)
    # The pivot moves with the slides before the hinge; those after it turn with it.
    moved = pivot + sum((x * d for x, d, own in zip(slid, axes, late, strict=True) if not own), 0j)
    arm = seen.place - moved
    spin = 1j * seen.omega if after else 0j
    sped = _split(axes, seen.speed - spin * arm)
    turning = sum((v * d for v, d, own in zip(sped, axes, late, strict=True) if own), 0j)
    swing = (1j * seen.alpha - seen.omega**2) * arm if after else 0j
    pushed = _split(axes, seen.push - swing - 2 * spin * turning)
    slides = iter(zip(slid, sped, pushed, strict=True))
    turned = turn, seen.omega, seen.alpha
    rows = [turned if freedom.kind == "hinge" else next(slides) for freedom in limb.freedoms]
    refs = [freedom.ref for freedom in limb.freedoms]
    return [(ref + x, v, a) for ref, (x, v, a) in zip(refs, rows, strict=True)]


def _split(axes: Sequence[complex], vector: complex) -> list[float]:
    """Split the vector along axes. A part that no axis reaches stays; `sim.run.check` sees it."""
    if not axes:
        return []
    matrix = np.array([[axis.real for axis in axes], [axis.imag for axis in axes]])
    solution, *_ = np.linalg.lstsq(matrix, np.array([vector.real, vector.imag]), rcond=None)
    return [float(each) for each in solution]


APART_RAD = 1e-3
"""Distance from the file's own pose beyond which a hinge does not keep its whole turns."""
PAST = 1e-3
"""Distance beyond a range [rad], or over the size of the linkage, that is more than rounding."""


@dataclass(frozen=True, eq=False)
class PlanarModel:
    """A model with its linkage and scene, from ``keyframe`` on, None for the pose as drawn."""

    model: Any
    linkage: Linkage
    read: SceneRead
    limbs: Limbs
    keyframe: int | None

    @property
    def driven(self) -> int:
        """Driven joint."""
        return self.linkage.component.driven

    @property
    def loops(self) -> list[int]:
        """Equalities that close loops, or are part of a link."""
        return [each.index for each in self.linkage.component.closures]

    @property
    def inertia_kg_m2(self) -> float:
        """Largest inertia on a joint of the linkage in the model as drawn; the mass on a slide
        counts at the size of the linkage."""
        model, extent = self.model, size(self.linkage)
        return max(
            float(model.dof_M0[model.jnt_dofadr[joint.index]])
            * (1.0 if joint.kind == "hinge" else extent**2)
            for joint in self.limbs.joints
        )

    @cached_property
    def _columns(self) -> tuple[list[int], list[int], Array]:
        """Columns of the freedoms in qpos and in qvel, and -1 where MuJoCo counts clockwise."""
        positions, rates = zip(*(joint.columns for joint in self.limbs.joints), strict=True)
        return [*positions], [*rates], np.array([joint.sense for joint in self.limbs.joints])

    def seen(self, q: Array, rate: Array, push: Array) -> tuple[Array, Array, Array]:
        """Return coordinates, rates and accelerations of the freedoms in the senses of the scene,
        (T, n) each, from those of the model, (T, nq) and (T, nv)."""
        rods = [rod.seen(q, rate, push) for rod in self.linkage.component.rods]
        q, rate, push = map(np.hstack, zip((q, rate, push), *rods, strict=True))
        at, dofs, senses = self._columns
        return q[:, at] * senses, rate[:, dofs] * senses, push[:, dofs] * senses

    def put(self, data: Any, q: Array, rate: Array) -> None:
        """Set the freedoms of ``data`` to coordinates and rates in the senses of the scene."""
        model = self.model
        every, rates = (np.append(each, np.zeros(len(q))) for each in (data.qpos, data.qvel))
        at, dofs, senses = self._columns
        every[at], rates[dofs] = senses * q, senses * rate
        data.qpos[:], data.qvel[:] = every[: model.nq], rates[: model.nv]
        first = 0
        for rod in self.linkage.component.rods:
            own = slice(first, first + rod.count)
            rod.put(data, every[model.nq :][own], rates[model.nv :][own])
            first += rod.count

    def pose(self) -> Array:
        """Return the coordinates of the freedoms in the model's own pose."""
        still = np.zeros((1, self.model.nv))
        return np.asarray(self.seen(self.qpos[None], still, still)[0][0])

    def start(self, scene: Scene, state: State) -> tuple[Array, Array, Array]:
        """Return `coordinates` nearest to the model's own pose. A hinge that the assembly leads
        away from that pose gets the whole turns that bring it within its range, if any do."""
        near = self.pose()
        q, rate, push = coordinates(self.limbs, scene, state, near)
        for at, (joint, low, high) in enumerate(self._ranges()):
            moved = joint.kind == "hinge" and abs(q[at] - near[at]) > APART_RAD
            if moved and joint.index != self.driven and not low <= q[at] <= high:
                first = q[at] + math.tau * math.ceil((low - q[at]) / math.tau)
                last = q[at] + math.tau * math.floor((high - q[at]) / math.tau)
                q[at] = (first if q[at] < low else last) if first <= high else q[at]
        return q, rate, push

    def _ranges(self) -> Iterator[tuple[PlanarJoint, float, float]]:
        """Yield the joint of each freedom with its range, in the sense of the scene."""
        for joint in self.limbs.joints:
            limited = self.model.jnt_limited[joint.index] and joint.columns[0] < self.model.nq
            ends = self.model.jnt_range[joint.index] if limited else (-math.inf, math.inf)
            low, high = sorted(joint.sense * float(end) for end in ends)
            yield joint, low, high

    def outside(self, scene: Scene, state: State) -> list[str]:
        """Describe the joints beside the driven one that a state puts outside their ranges."""
        told = []
        for x, (joint, low, high) in zip(self.start(scene, state)[0], self._ranges(), strict=True):
            hinge = joint.kind == "hinge"
            least = PAST * (1.0 if hinge else size(self.linkage))
            if joint.index != self.driven and not low - least <= x <= high + least:
                span = sorted(joint.sense * each for each in (low, high))
                ends = " to ".join(reading(end, hinge) for end in span)
                read = reading(joint.sense * x, hinge)
                told.append(f"joint {joint.name} reads {read}, outside its range of {ends}")
        return told

    @property
    def qpos(self) -> Array:
        """All joint coordinates of the model in its own pose."""
        model = self.model
        return np.array(model.qpos0 if self.keyframe is None else model.key_qpos[self.keyframe])

    def matter(self, body: str) -> Matter:
        """Return mass and inertia of a body of the scene, the sum of its bodies in the model."""
        link = next(link for link, name in self.read.names.items() if name == body and link)
        return self.read.parts.matter[link]
