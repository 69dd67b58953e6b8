"""Types that travel: the motion of a mechanism over time, and its state at one instant."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.scene import Point


@dataclass(frozen=True)
class SliderForces:
    """Reaction of a slider's guide on the sliding body: ``normal`` [N], the force along the line's
    direction turned by +90 deg, at the slider's point; ``moment`` [N m] about that point; (T,)."""

    normal: Array
    moment: Array


@dataclass(frozen=True)
class ForceBound:
    """Bounds on the errors of forces: the same keys, arrays of shape (T,), never negative.

    For pins the bound holds for the length of the error vector. Infinite where rounding leaves
    nothing certain.
    """

    pins: Mapping[str, Mapping[str, Array]]
    sliders: Mapping[str, SliderForces]
    torque: Array
    friction: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class FrictionSolution:
    """Solution of Coulomb's friction, which depends on the reactions that it changes; (T,) each.

    ``solutions`` is 1 where there is one, 2 where there are two or more (the one with the least
    friction is given), and 0 where there is none: no finite torque keeps the mechanism moving.
    ``iterations`` were taken; ``change`` is the last change or, where there may be several
    solutions, the uncertainty of the given one, over the largest friction.
    """

    solutions: Array
    iterations: Array
    change: Array


@dataclass(frozen=True)
class Forces:
    """Reactions and driving torque, sampled at ``time_s`` (T,).

    ``pins`` holds, by point and body, the force of the pin on the body [N], (T, 2), in the ground's
    frame. Bodies are in the order of the pin, the ground first, then links, then slider blocks:
    where two meet, the force on the second is exerted by the first. All forces of a pin add up to
    0. ``torque``, (T,), is the drive's action on the driver, in ``drive_unit``: N m, or N along the
    line of a slider; "" in free motion, where nothing drives. ``undetermined`` says why there are
    no reactions where the equations of statics leave them open. Values that a producer does not
    give are NaN. ``friction`` holds the friction by joint: in a pin the couple [N m] of its first
    body on its second, in a slider the force [N] of the guide on the sliding body, along the line;
    ``friction_solution`` is the solution of Coulomb's friction. ``contradictions`` are conflicts
    between an engine's forces and its other numbers.
    """

    time_s: Array
    pins: Mapping[str, Mapping[str, Array]]
    sliders: Mapping[str, SliderForces]
    torque: Array
    bound: ForceBound | None = None
    undetermined: str = ""
    friction: Mapping[str, Array] = field(default_factory=dict)
    friction_solution: FrictionSolution | None = None
    contradictions: tuple[str, ...] = ()
    drive_unit: str = "N m"

    def has_equilibria(self, number: int) -> NDArray[np.bool_]:
        """Mask (T,) of the samples at which Coulomb's friction has so many equilibria: 0 where it
        locks the mechanism, 2 where that may jam."""
        if self.friction_solution is None:
            return np.zeros(self.time_s.size, np.bool_)
        return np.asarray(self.friction_solution.solutions == number)

    def each_series(self, change: Callable[..., Array], *others: Forces | ForceBound) -> Forces:
        """Return the forces without bound, every series changed, by those of ``others`` as further
        arguments; the instants stay."""
        every = (self, *others)
        series = {
            name: each_array(change, *(getattr(one, name) for one in every))
            for name in ("pins", "sliders", "torque", "friction")
        }
        return replace(self, **series, bound=None, friction_solution=None)

    def stretch(self, kept: slice | NDArray[np.intp]) -> Forces:
        """Return some samples, a slice or by index, without bound."""
        return replace(self.each_series(lambda series: series[kept]), time_s=self.time_s[kept])

    @staticmethod
    def joined(parts: Sequence[Forces]) -> Forces:
        """Join stretches of samples one after the other."""
        first, *others = parts
        if not others:
            return first
        return replace(
            first.each_series(_one_after_the_other, *others),
            time_s=_joined(parts, "time_s"),
            contradictions=tuple(text for part in parts for text in part.contradictions),
        )


Order = Literal[0, 1, 2]
"""Order of a derivative: a position, its rate, or its second rate."""


@dataclass(frozen=True)
class LinkMotion:
    """Angle ``theta`` [rad], ``omega`` [rad/s], ``alpha`` [rad/s^2]. The angle is continuous with
    the driver's, its whole turns counted from time 0, for any instants in any order."""

    theta: Array
    omega: Array
    alpha: Array


@dataclass(frozen=True)
class PointMotion:
    """Position [m], velocity [m/s], acceleration [m/s^2], each of shape (T, 2)."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class SliderMotion:
    """Displacement along the line [m], speed [m/s], acceleration [m/s^2] against the guide."""

    displacement: Array
    speed: Array
    acceleration: Array


@dataclass(frozen=True)
class ElasticMotion:
    """Deformation of an elastic link, each (T,) [m]: ``middle`` is the distance of its middle from
    the line between its pins, positive to the left of the way from the first to the second, and
    ``extension`` the increase of their distance over that at rest."""

    middle: Array
    extension: Array


@dataclass(frozen=True)
class Bound:
    """Bounds on the errors of a motion: the same keys, arrays of shape (T,), never negative.

    For points the bound holds for the length of the error vector. Infinite where rounding leaves
    nothing certain (velocities at a singular position).
    """

    links: Mapping[str, LinkMotion]
    points: Mapping[str, PointMotion]
    sliders: Mapping[str, SliderMotion]


@dataclass(frozen=True)
class Crossing:
    """A change point that a motion passes through on the smooth branch. ``dyad`` is named by its
    inner joint, as in the conditioning; ``driver_rad`` is the driver's angle [rad], 0 to 2 pi."""

    dyad: str
    driver_rad: float


@dataclass(frozen=True)
class Motion:
    """The motion of a mechanism, sampled at ``time_s`` (T,).

    Values that a producer does not give are NaN (an engine without accelerations). ``conditioning``
    holds, per dyad of the reference (named by its inner joint), the sine of the transmission angle
    or its like: 1 is best, 0 is singular. ``bound`` is the reference's own error, ``forces`` are as
    many samples at instants of their own: both only if requested. ``crossings`` are the change
    points on the way from time 0 through the samples.
    """

    time_s: Array
    links: Mapping[str, LinkMotion]
    points: Mapping[str, PointMotion]
    sliders: Mapping[str, SliderMotion]
    conditioning: Mapping[str, Array] = field(default_factory=dict)
    bound: Bound | None = None
    crossings: tuple[Crossing, ...] = ()
    forces: Forces | None = None
    elastic: Mapping[str, ElasticMotion] = field(default_factory=dict)

    def each_series(self, change: Callable[..., Array], *others: Motion) -> Motion:
        """Return the motion with every series of its bodies changed, by those of ``others`` as
        further arguments; its instants stay."""
        every = (self, *others)
        series = {
            name: each_array(change, *(getattr(one, name) for one in every))
            for name in ("links", "points", "sliders", "elastic")
        }
        acting = [one.forces for one in every if one.forces]
        forces = acting[0].each_series(change, *acting[1:]) if len(acting) == len(every) else None
        return replace(self, **series, forces=forces)

    @staticmethod
    def joined(parts: Sequence[Motion]) -> Motion:
        """Join motions one after the other; series that one of them lacks are left out."""
        if len(parts) == 1:
            return parts[0]
        forces = [part.forces for part in parts if part.forces]
        return Motion(
            _joined(parts, "time_s"),
            _joined(parts, "links"),
            _joined(parts, "points"),
            _joined(parts, "sliders"),
            _joined(parts, "conditioning"),
            _joined(parts, "bound") if all(part.bound for part in parts) else None,
            tuple(dict.fromkeys(one for part in parts for one in part.crossings)),
            Forces.joined(forces) if len(forces) == len(parts) else None,
            _joined(parts, "elastic"),
        )

    def state(self, index: int = 0) -> State:
        """The sample ``index`` as a state."""
        return State(
            time_s=float(self.time_s[index]),
            theta={n: float(m.theta[index]) for n, m in self.links.items()},
            omega={n: float(m.omega[index]) for n, m in self.links.items()},
            alpha={n: float(m.alpha[index]) for n, m in self.links.items()},
            position={n: _pair(m.position[index]) for n, m in self.points.items()},
            velocity={n: _pair(m.velocity[index]) for n, m in self.points.items()},
            acceleration={n: _pair(m.acceleration[index]) for n, m in self.points.items()},
            displacement={n: float(m.displacement[index]) for n, m in self.sliders.items()},
            speed={n: float(m.speed[index]) for n, m in self.sliders.items()},
        )


def each_array(change: Callable[..., Array], *series: Any) -> Any:
    """Return the series, mappings or dataclasses of arrays in any depth, each array changed; of
    several the arrays in the same place, which all of them have, are the arguments."""
    first = series[0]
    if isinstance(first, np.ndarray):
        return change(*series)
    if isinstance(first, Mapping):
        shared = (key for key in first if all(key in one for one in series))
        return {key: each_array(change, *(one[key] for one in series)) for key in shared}
    return type(first)(**each_array(change, *map(vars, series)))


def _joined(parts: Sequence[Forces] | Sequence[Motion], name: str) -> Any:
    return each_array(_one_after_the_other, *(getattr(part, name) for part in parts))


def _one_after_the_other(*parts: Array) -> Array:
    return np.concatenate(parts)


@dataclass(frozen=True)
class State:
    """A mechanism at one instant: links by name [rad, rad/s, rad/s^2], points [m, m/s, m/s^2],
    sliders [m, m/s]; strain of the nodes of stretching beams, and its rate [1/s]."""

    time_s: float
    theta: Mapping[str, float]
    omega: Mapping[str, float]
    alpha: Mapping[str, float]
    position: Mapping[str, Point]
    velocity: Mapping[str, Point]
    acceleration: Mapping[str, Point]
    displacement: Mapping[str, float]
    speed: Mapping[str, float]
    strain: Mapping[str, float] = field(default_factory=dict)
    strain_rate: Mapping[str, float] = field(default_factory=dict)


def _pair(row: Array) -> Point:
    return float(row[0]), float(row[1])
