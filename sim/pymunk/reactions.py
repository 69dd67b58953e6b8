"""Reactions in pymunk: vectors from the momentum of the bodies, checked against pymunk's impulses.

Chipmunk reports the magnitude of a constraint's impulse in the last step, and no direction. A step
moves the positions first and solves for the velocities there, so its impulses belong to its end,
where the arms are: over the step they are the forces at the logged sample, to second order.

A run starts with closed joints, and continues with joints that the curvature of paths in a step
opens. The first two steps make up for that, and their forces are wrong by 0.1 to 0.5 of the largest
at any step size (every shipped scene except one that starts at rest); the third is of first order,
the fourth as all after it. The error dies off slowly where iterations do not converge: with 150 on
the shaper, whose ram is heavy, within ten samples, with 1000 in the second.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import pymunk
import pymunk.batch

from models.array import Array
from models.motion import Forces
from models.scene import GROUND
from models.scene.joints import centre_of, mass_of, turned
from sim.engine.acting import Push, Pushes
from sim.engine.measure import across, arms
from sim.engine.momentum_balance import (
    JointPushes,
    MomentumGain,
    by_name,
    forces_by_body,
    joint_pushes,
)
from sim.pymunk.native import moves_freely
from sim.pymunk.space import SpaceModel

BEFORE = (
    pymunk.batch.BodyFields.VELOCITY
    | pymunk.batch.BodyFields.ANGULAR_VELOCITY
    | pymunk.batch.BodyFields.FORCE
    | pymunk.batch.BodyFields.TORQUE
)
"""Input of a step: vx, vy, omega, and the given force and torque."""
SAME = 1e-6
"""Largest difference of a joint's impulse over a step from the momentum balance, over the largest
force (for moments, times the longest link), that counts as none. On the shipped scenes it is 2e-12
at most, with either profile and every drive; rounding of velocities grows with the steps in a turn,
and near dead points. Where anchors are bent for arcs, arms are off by half the square of a turn."""


class Reactions:
    """Forces in the joints of a space, from the readings at each logged step."""

    def __init__(self, model: SpaceModel, rows: Mapping[str, int], dt_s: float, *, bent: bool):
        self._bent = bent
        self._scene, self._model, self._rows, self._dt = model.scene, model, rows, dt_s
        joints = (*model.hinges.values(), *model.lines.values(), *model.gears.values())
        self._constraints = [one for one in (*joints, model.motor) if one is not None]
        self._driven = model.motor is not None or not moves_freely(model.crank)
        self._impulses: list[list[float]] = []
        self._braked: list[list[float]] = []
        self._on_blocks: list[Mapping[str, Push]] = []
        self._rubbed: list[Mapping[str, float]] = []
        self._pulled: list[Mapping[str, Push]] = []

    def read(self, pulled: Pushes, rubbed: Mapping[str, float]) -> None:
        """Record the impulses of the last step, the forces of the space's own springs on bodies,
        all actions on slider blocks without mass, and the friction of sliders."""
        self._impulses.append([constraint.impulse for constraint in self._constraints])
        self._braked.append([one.motor.impulse if one.motor else 0.0 for one in self._model.rubs])
        self._on_blocks.append(pulled.on_blocks)
        self._rubbed.append(rubbed)
        self._pulled.append(pulled.on_bodies)

    @np.errstate(all="ignore")  # open joints may overflow; they are judged, not warned of
    def forces(self, before: Array, after: Array, time_s: Array) -> Forces:
        """Return the forces at logged steps, with the contradictions by pymunk's impulses.

        Parameters
        ----------
        before : Array
            Input of each logged step, (T - 1, bodies, 6), as `BEFORE`.
        after : Array
            Positions, angles and velocities at all samples, (T, bodies, 6), the start first: no
            step led there, so that its forces are NaN.
        time_s : Array
            The instants of the samples, (T,).
        """
        ends = time_s[1:]
        couples = self._couples(before, after[1:])
        pulled = by_name(self._pulled[: len(ends)])
        gains = {
            name: self._gain(name, before, after[1:], ends, couples, pulled)
            for name in self._model.bodies
        }
        pushes = joint_pushes(self._scene, [*self._model.hinges], gains, driven=self._driven)
        on_blocks = by_name(self._on_blocks[: len(ends)])
        friction = couples | by_name(self._rubbed[: len(ends)])
        forces = forces_by_body(self._scene, pushes, on_blocks, friction, ends)
        forces = forces.each_series(_with_start).stretch(slice(0, len(time_s)))
        scene = self._scene
        rolling = scene.cams or any(gear.carrier != GROUND for gear in scene.gears.values())
        if not len(ends) or pushes.spare or rolling:  # which press on pins (`sim.pymunk.rolling`)
            return replace(forces, time_s=time_s)
        turn = float(np.nanmax(np.abs(after[:, :, 5]))) * self._dt if self._bent else 0.0
        against = tuple(self._contradictions(pushes, ends, SAME + turn**2))
        return replace(forces, time_s=time_s, contradictions=against)

    def _couples(self, before: Array, after: Array) -> dict[str, Array]:
        """Return the friction of pins, by joint, (T,)."""
        couples = {}
        for k, one in enumerate(self._model.rubs):
            first, second = (self._rows.get(name) for name in (one.first, one.second))
            impulse = np.array([row[k] for row in self._braked[: len(after)]])
            turning = _turning(before[:, :, 2], first, second)
            left = _turning(after[:, :, 5], first, second)
            couples[one.joint] = one.couple(impulse, turning, left, self._dt)
        return couples

    def _gain(
        self,
        name: str,
        before: Array,
        after: Array,
        time_s: Array,
        couples: Mapping[str, Array],
        pulled: Mapping[str, Array],
    ) -> MomentumGain:
        """Return the action of joints and drive on a body, without friction and springs."""
        body, centre = self._model.bodies[name], self._model.centre[name]
        start, end = before[:, self._rows[name]], after[:, self._rows[name]]
        if moves_freely(body):
            given = self._change(body, start, end) - start[:, 3:6]
        else:
            given = self._told(name, end[:, 2], time_s) - start[:, 3:6]
        if self._model.springs:
            given = given - pulled[name]
        for one in self._model.rubs:
            given[:, 2] -= couples[one.joint] * ((name == one.second) - float(name == one.first))
        return MomentumGain(centre, end[:, 0:2], end[:, 2], given[:, 0:2], given[:, 2])

    def _change(self, body: pymunk.Body, start: Array, end: Array) -> Array:
        """Return the momentum that a free body gained in a second, less weight and damping: force
        and moment, (T, 3)."""
        kept = self._model.space.damping**self._dt
        gain = (end[:, 3:6] - kept * start[:, 0:3]) / self._dt
        gain[:, 0:2] -= np.array(self._model.space.gravity)
        inertia = 0.0 if math.isinf(body.moment) else body.moment
        return np.asarray(gain * np.array([body.mass, body.mass, inertia]))

    def _told(self, name: str, theta: Array, time_s: Array) -> Array:
        """Return the same for the kinematic crank, or slider, which has no mass in pymunk: with the
        scene's mass, about its pivot or its centre of mass, in the motion of its law."""
        mass, inertia = mass_of(self._scene, name)
        arm = arms(theta, self._model.from_centre(name, centre_of(self._scene, name)))
        _, omega, alpha = (each[:, None] for each in self._scene.driver.law.at(time_s))
        if self._scene.driver.slider is not None:
            u = turned((1.0, 0.0), self._scene.sliders[self._scene.driver.slider].direction_rad)
            pull = mass * (alpha * np.array(u) - np.array(self._scene.gravity_m_s2))
            return np.column_stack([pull, np.zeros(len(time_s))])
        left = across(arm)
        force = mass * (alpha * left - omega**2 * arm - np.array(self._scene.gravity_m_s2))
        moment = inertia * alpha[:, 0] + np.sum(left * force, axis=1)
        return np.column_stack([force, moment])

    def _contradictions(self, pushes: JointPushes, time_s: Array, same: float) -> Iterator[str]:
        """Yield joints whose impulse differs from the momentum balance by more than ``same``."""
        held = [hinge for hinge, joint in self._model.hinges.items() if joint is not None]
        found = {
            f"pin {each.point} of {each.first} and {each.other}": np.hypot(*pushes.hinges[each].T)
            for each in held
        }
        found |= {f"line of {name}": np.abs(pushes.normals[name]) for name in self._model.lines}
        moments = {f"gear of {name}": np.abs(pushes.moments[name]) for name in self._model.gears}
        if self._model.motor is not None:
            moments["motor"] = np.abs(pushes.torque)
        told = (np.array(self._impulses[: len(time_s)]) / self._dt).T
        size = max(float(np.nanmax(one, initial=0.0)) for one in found.values())
        for own, (name, one) in zip(told, (found | moments).items(), strict=True):
            largest = size * self._scene.longest_m if name in moments else size
            off = np.nan_to_num(np.abs(own - one))
            worst = int(np.argmax(off))
            if off[worst] > same * largest:
                yield (
                    f"at {time_s[worst]:.6g} s pymunk's impulse on the {name} is "
                    f"{own[worst]:.6g} over the step, and {one[worst]:.6g} by the momentum of "
                    "the bodies: the forces may be wrong"
                )


def _turning(omega: Array, first: int | None, second: int | None) -> Array:
    """Return the rate of a body against another, (T,), by their rows; None is the ground."""
    one, other = (0.0 if row is None else omega[:, row] for row in (first, second))
    return np.asarray(other - one)


def _with_start(series: Array) -> Array:
    """Return the series with an unknown sample before it."""
    return np.concatenate([np.full((1, *series.shape[1:]), np.nan), series])
