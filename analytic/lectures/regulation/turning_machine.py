"""Machine over the angle that its driver has turned: reduced moment of inertia, and torques.

The angle u counts along the motion, and so do torques: positive ones drive::

    d/du (J w^2 / 2) = M(u, w)          theta = start + way u,   way = 1 or -1
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.forces import force_elements
from analytic.forces.bounded import Bounded
from analytic.forces.virtual_power import inertia_and_slope, loaded_bodies, torque_by_power
from analytic.kinematics import driven_chunk, reach, repeats_after, unit_chunk
from analytic.structure.mobility import analyse, refuse_elastic, refuse_other_than_cranked
from models.array import Array
from models.errors import CrankcheckError, few
from models.scene import Scene
from models.scene.characteristics import Constant
from models.scene.laws import ConstantSpeed
from models.scene.loads import Load
from models.scene.tabulated import Tabulated

MOST_TURNS = 12
"""Most turns of the mechanism's own cycle, within which the loads have to repeat."""
MOST_PERIODS = 2000
"""Most periods of a load in a cycle; all of them are computed."""
CLOSE = 1e-9
"""Deviation of a period from a whole part of the cycle, over it."""


def cycle_angle(scene: Scene) -> float:
    """Return the angle of the driver after which the machine repeats [rad]: a turn, two for a
    four-stroke engine. Raises CrankcheckError for a driver that does not turn round, or speeds up
    by its law; friction that follows the reactions; a load over time, or over the angle without a
    period; a spring that winds up."""
    _check_turns(scene)
    if scene.coulomb_joints:
        raise CrankcheckError(
            f"{scene.name}: friction.{scene.coulomb_joints[0]}: Coulomb's friction follows from "
            "the reactions, and no torque over angle and speed represents it; give torque_n_m "
            "or force_n in its place"
        )
    own = repeats_after(scene)
    periods = [p for load in scene.loads.values() if (p := _period(scene, load)) is not None]
    for turns in range(1, MOST_TURNS + 1):
        whole = turns * own
        if all(abs(whole / p - round(whole / p)) <= CLOSE * max(1.0, whole / p) for p in periods):
            _check_springs(scene, whole)
            _check_periods(scene, whole)
            return whole
    told = few([f"{math.degrees(p):.6g} deg" for p in periods], 6)
    raise CrankcheckError(
        f"{scene.name}: loads over the angle repeat after {told}, the mechanism after "
        f"{math.degrees(own):.6g} deg; they have no common multiple within {MOST_TURNS} times "
        "that, so there is no cycle; give periods that have one"
    )


def _check_turns(scene: Scene) -> None:
    refuse_other_than_cranked(scene, "a cycle of speed")
    if not (scene.is_free or isinstance(scene.driver.law, ConstantSpeed)):
        raise CrankcheckError(
            f"{scene.name}: its driver swings or speeds up by its law, and a cycle of speed "
            'needs a driver that keeps turning; give it law = "constant", or "free"'
        )
    ranges = reach(scene)
    if ranges != [(-math.pi, math.pi)]:
        spans = [f"{math.degrees(a):.6g} to {math.degrees(b):.6g} deg" for a, b in ranges]
        raise CrankcheckError(
            f"{scene.name}: {scene.driver.link} does not turn round, and so has no cycle of speed: "
            f"it can stand at {' and '.join(spans) or 'no angle'}; drive a link that turns"
        )


def _period(scene: Scene, load: Load) -> float | None:
    """Return the driver's angle after which a load repeats; None if it follows no angle."""
    own = load.characteristic
    if isinstance(own, Constant):
        return None
    if load.over == "time":
        raise CrankcheckError(
            f"{scene.name}: loads.{load.name} follows time, which no cycle of the machine repeats; "
            "give it over the angle"
        )
    if load.over != "angle":
        return None
    if own.repeats_after is None:
        key = "period_deg" if isinstance(own, Tabulated) else "a table or a sum of waves"
        raise CrankcheckError(
            f"{scene.name}: loads.{load.name} follows the angle and never repeats; give {key}"
        )
    return own.repeats_after


def _check_periods(scene: Scene, whole_rad: float) -> None:
    for load in scene.loads.values():
        period = _period(scene, load)
        if period is not None and whole_rad / period > MOST_PERIODS:
            raise CrankcheckError(
                f"{scene.name}: loads.{load.name} repeats after {math.degrees(period):.6g} deg, "
                f"{whole_rad / period:.6g} times in a cycle of {math.degrees(whole_rad):.6g} "
                f"deg; at most {MOST_PERIODS} are computed: give a longer period, or its mean"
            )


def _check_springs(scene: Scene, whole_rad: float) -> None:
    start = float(scene.driver.law.at(np.zeros(1))[0][0])
    chunk = unit_chunk(scene, start + np.array([0.0, whole_rad]), bound=False)
    for spring, q, _ in force_elements.spring_lengths(scene, chunk, counted=True):
        if spring.rate and abs(q[1] - q[0]) > 1.0:  # a turn or more: lengths come back
            raise CrankcheckError(
                f"{scene.name}: springs.{spring.name} is wound up by "
                f"{math.degrees(q[1] - q[0]):.4g} deg in every cycle, so that none is like the "
                "next; leave it out"
            )


@dataclass(frozen=True, eq=False)
class TurningMachine:
    """Scene whose driver turns from ``start_rad`` by ``cycle_rad`` in a cycle, to the side
    ``way``."""

    scene: Scene
    way: float
    start_rad: float
    cycle_rad: float

    @cached_property
    def _steady(self) -> Scene:
        """Scene with the forces that do not follow the speed."""
        slow = {n: load for n, load in self.scene.loads.items() if not follows_speed(load)}
        springs = {n: replace(s, damping=0.0) for n, s in self.scene.springs.items() if s.rate}
        return replace(self.scene, loads=slow, springs=springs)

    @cached_property
    def _rated(self) -> Scene:
        """Scene with the forces that follow the speed."""
        fast = {n: load for n, load in self.scene.loads.items() if follows_speed(load)}
        dampers = {n: replace(s, rate=0.0) for n, s in self.scene.springs.items() if s.damping}
        bare = replace(self.scene, friction={}, gravity_m_s2=(0.0, 0.0))
        return replace(bare, loads=fast, springs=dampers)

    @staticmethod
    def of(scene: Scene) -> TurningMachine:
        """Make the machine of a scene; to the side of its driver's start, and left-handed from
        rest. Raises CrankcheckError as `cycle_angle`, and for elastic links."""
        refuse_elastic(scene, "the steady cycle of a machine, and its flywheel,")
        whole = cycle_angle(scene)
        theta, omega, _ = scene.driver.law.at(np.zeros(1))
        return TurningMachine(scene, math.copysign(1.0, omega[0]), float(theta[0]), whole)

    @property
    def is_rated(self) -> bool:
        """True if any torque follows the speed."""
        return bool(self._rated.loads or self._rated.springs)

    def theta(self, u: Array) -> Array:
        """Return the driver's angle [rad]."""
        return self.start_rad + self.way * u

    def inertia(self, u: Array) -> tuple[Array, Array]:
        """Return J and dJ/du [kg m^2]. Raises CrankcheckError where J has no bound."""
        pair = inertia_and_slope(self.scene, self.mechanism(u.ravel()))
        inertia, slope = (each.reshape(u.shape) for each in pair)
        if (off := ~(np.isfinite(inertia) & np.isfinite(slope))).any():
            where = math.degrees(self.theta(u)[off].ravel()[0]) % 360.0
            raise CrankcheckError(
                f"{self.scene.name}: the driver stands in a dead point at {where:.6g} deg, where "
                "its moment of inertia grows without bound; drive another link"
            )
        return inertia, self.way * slope

    def mechanism(self, u: Array) -> Chunk:
        """Return the positions (T,), with rates and accelerations per unit of the driver's rate."""
        return unit_chunk(self.scene, self.theta(u), bound=False)

    def steady_torque(self, u: Array) -> Array:
        """Return the torque of all forces that do not follow the speed [N m]."""
        return self._torque(self._steady, u, 1.0)

    def rated_torque(self, u: Array, speed: Array) -> Array:
        """Return the torque of all forces that follow the speed, at speeds [rad/s] of the driver,
        above 0. Raises CrankcheckError for a table that does not reach as far."""
        if not self.is_rated:
            return np.zeros_like(u)
        return self._torque(self._rated, u, speed)

    def torque(self, u: Array, speed: Array) -> Array:
        """Return M [N m]."""
        return self.steady_torque(u) + self.rated_torque(u, speed)

    def torques_by_source(self, u: Array, speed: Array) -> dict[str, Array]:
        """Return the torque of weights and each load, spring and friction, by key in the file."""
        scene = self.scene
        bare = replace(scene, loads={}, springs={}, friction={}, gravity_m_s2=(0.0, 0.0))
        parts = {f"loads.{n}": replace(bare, loads={n: x}) for n, x in scene.loads.items()}
        parts |= {f"springs.{n}": replace(bare, springs={n: x}) for n, x in scene.springs.items()}
        parts |= {
            f"friction.{n}": replace(bare, friction={n: x}) for n, x in scene.friction.items()
        }
        if any(scene.gravity_m_s2):
            parts["weights"] = replace(bare, gravity_m_s2=scene.gravity_m_s2)
        return {name: self._torque(part, u, speed) for name, part in parts.items()}

    def _torque(self, part: Scene, u: Array, speed: Array | float) -> Array:
        """Return the torque of ``part``, the same mechanism with some of its forces."""
        flat = u.ravel()
        rate = self.way * np.broadcast_to(speed, u.shape).ravel()
        chunk = driven_chunk(self.scene, self.theta(flat), rate)
        free = loaded_bodies(part, chunk, np.zeros_like(flat))
        force_elements.apply_springs(part, chunk, free)
        if part.friction:
            displaced = {name: Bounded(one.s, None) for name, one in chunk.sliders.items()}
            joints = force_elements.rubbing_joints(
                part, analyse(self.scene), chunk, free, displaced
            )
            force_elements.put_constant_friction(joints, free)
        found = -self.way * np.asarray(torque_by_power(free, self.mechanism(flat), chunk).value)
        return np.broadcast_to(found, flat.shape).reshape(u.shape)


def follows_speed(load: Load) -> bool:
    """True if a load depends on a speed of the machine."""
    return load.over in ("speed", "omega") and not isinstance(load.characteristic, Constant)
