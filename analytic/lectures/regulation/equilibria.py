"""Positions of rest of a mechanism under weights, springs and loads, in all its circuits.

Over s, with the driver's angle theta(s), J s'' + J' s'^2 / 2 = Q(s): it rests where Q is 0, and
stays there, if Q falls with s. On a branch between limits of the driver theta = m -+ h cos(pi s):
there Q and J are smooth over limit positions too, as the mechanism itself is.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.free.free_motion import loosened
from analytic.free.machine import Machine, Wound
from analytic.lectures.circuits.arcs import Arc, Signs
from analytic.lectures.circuits.circuits import Circuits, circuits_of
from analytic.lectures.circuits.rotatability import plain_angles
from analytic.lectures.regulation.angle_cells import crossings
from analytic.structure.mobility import refuse_elastic
from models.array import Array, Mask
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.characteristics import Constant

LOOKS, EDGE, NEAR = 2880, 1e-6, 1e-4
"""Samples of a branch; the distance from a limit, and the step for a slope, in s."""
NOTHING, JUMP = 1e-12, 1e-6
"""Q over the weights, below which nothing acts; over the largest Q, above which it jumps past 0."""


@dataclass(frozen=True)
class Equilibrium:
    """Position of rest in a ``circuit``, from 0 on, by driver angle [rad] and signs of the dyads,
    with the angles of all links [rad] and the potential energy of weights and springs [J].
    ``stiffness`` is -Q' / J [1/s^2]: above 0 it is stable, and the square of the angular frequency
    of small undamped oscillations."""

    circuit: int
    signs: Signs
    driver_rad: float
    angles_rad: Mapping[str, float]
    potential_j: float
    stiffness: float


@dataclass(frozen=True)
class Equilibria:
    """Positions of rest of a mechanism; ``beyond`` are circuits, other than its own, in which its
    loads are not given everywhere."""

    circuits: Circuits
    found: Sequence[Equilibrium]
    beyond: Sequence[int]


def equilibria(scene: Scene) -> Equilibria:
    """Find the positions of rest of a scene, released if it is driven, circuit by circuit. Raises
    StructureError as `circuits_of`; CrankcheckError for loads over time, elastic links, friction
    that follows the reactions, or a circuit in which nothing acts."""
    refuse_elastic(scene, "positions of rest")
    for load in scene.loads.values():
        if load.over == "time" and not isinstance(load.characteristic, Constant):
            raise CrankcheckError(
                f"{scene.name}: loads.{load.name} follows time, and nothing rests under it; "
                "leave it out, or give it a constant size"
            )
    free = loosened(scene)
    circuits, start = circuits_of(free), free.driver.law.at(np.zeros(1))[0]
    wound = {name: float(q[0]) for name, q in Machine(free).lengths(start).items()}
    found, beyond = list[Equilibrium](), list[int]()
    for number, circuit in enumerate(circuits.circuits):
        left = list(circuit)
        try:
            while left:
                legs = circuits.loop(left[0])
                left = [arc for arc in left if all(arc is not each for each, _ in legs)]
                scenes = (circuits.signed.with_signs(arc.signs) for arc, _ in legs)
                found += _CircuitMachine(legs, [Machine(each) for each in scenes], wound).rests(
                    number
                )
        except CrankcheckError:
            if number == circuits.own[0]:
                raise
            beyond.append(number)
    return Equilibria(circuits, found, beyond)


@dataclass(frozen=True, eq=False)
class _CircuitMachine:
    """Branches that follow each other, one over each unit of s, with a machine each."""

    legs: Sequence[tuple[Arc, bool]]
    machines: Sequence[Machine]
    wound: Wound

    def rests(self, number: int) -> Iterator[Equilibrium]:
        looks = (np.arange(LOOKS * len(self.legs) + 1) + 0.5) / LOOKS
        sizes, scene = np.abs(self._acting(looks)[0]), self.machines[0].scene
        if not np.isfinite(sizes).any():
            return  # folded flat: pins that coincide leave a link free
        masses = sum(link.mass_kg for link in scene.links.values())
        masses += sum(slider.mass_kg for slider in scene.sliders.values())
        largest = float(np.nanmax(sizes))
        if largest <= NOTHING * masses * math.hypot(*scene.gravity_m_s2) * scene.longest_m:
            raise CrankcheckError(
                f"{scene.name}: nothing acts on it, or all is in balance everywhere, so that it "
                "rests anywhere; give gravity_m_s2, a spring or a load"
            )
        for s in crossings(lambda s: self._acting(s)[0], looks, [0.0]).tolist():
            push, inertia = self._acting(s + NEAR * np.arange(-1.0, 2.0))
            if not (abs(push[1]) <= JUMP * largest and np.isfinite(push).all()):
                continue
            ((leg, _, theta, _),) = self._places(np.array([s]))
            machine = self.machines[leg]
            angles = plain_angles(machine.scene, theta).items()
            yield Equilibrium(
                number,
                self.legs[leg][0].signs,
                math.remainder(float(theta[0]), math.tau),
                {name: float(angle[0]) for name, angle in angles},
                float(machine.potential(theta, self.wound)[0]),
                float((push[0] - push[2]) / (NEAR * (inertia[0] + inertia[2]))),
            )

    def _acting(self, s: Array) -> tuple[Array, Array]:
        """Return Q and J at s (T,); NaN in singular positions."""
        push, inertia = np.empty_like(s), np.empty_like(s)
        for leg, at, theta, slope in self._places(s):
            machine, still = self.machines[leg], np.zeros_like(theta)
            with np.errstate(all="ignore"):
                push[at] = slope * machine.push(still, theta, still, self.wound)
                inertia[at] = slope**2 * machine.inertia(theta)[0]
        return push, np.maximum(inertia, np.finfo(float).tiny)  # of massless bodies

    def _places(self, s: Array) -> Iterator[tuple[int, Mask, Array, Array]]:
        """Yield the legs on which s (T,) lie, their samples, driver angles and d theta/ds there."""
        leg = np.floor(s % len(self.legs)).astype(int)
        for k in np.unique(leg).tolist():
            (arc, rises), at = self.legs[k], leg == k
            (low, high), share = arc.range_rad, s[at] % 1.0
            if arc.low is None:
                yield k, at, low + share * (high - low), np.full_like(share, high - low)
                continue
            phase = math.pi * np.clip(share, EDGE, 1.0 - EDGE)
            half = 0.5 * (high - low) * (1.0 if rises else -1.0)
            yield k, at, 0.5 * (low + high) - half * np.cos(phase), math.pi * half * np.sin(phase)
